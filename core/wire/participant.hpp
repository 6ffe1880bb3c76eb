#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/result/result.hpp"
#include "core/wire/link_state.hpp"

/// The wire: one participant on one domain, behind one face with two adapters (Fast DDS, in-memory).
namespace adit::wire {

std::string to_string(const ParticipantId& id);

/// What a topic is for; docs/architecture.md has the table of what each gets.
enum class QosClass : std::uint8_t { urgent, stream, state, status, bulk, video, sensor };

/// A topic without its type: what both adapters need.
struct TopicInfo {
  const char* name;  ///< DDS topic name
  const char* type;  ///< DDS type name
  QosClass qos;
  std::uint16_t depth;      ///< history: samples kept (per key where keyed)
  bool keyed;               ///< the key is the type's first member, a string
  std::uint32_t max_bytes;  ///< of one serialised sample; longer ones are dropped and counted
};

/// A topic: one constant that ties name, type and QoS class (core/wire/topics.hpp).
template <class T>
struct Topic : TopicInfo {};

/// What the wire knows of a sample beside its bytes, whatever they say.
struct SampleInfo {
  ParticipantId sender{};  ///< who really wrote it
  Time received{};         ///< when it arrived, by the receiver's clock, however long it waited since
};

/// Writes one topic; never blocks. An error says why the sample could not be queued; it is counted, too.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  virtual Result<void> write(std::span<const std::uint8_t> cdr) = 0;
  /// Readers matched now.
  virtual std::size_t matched() const = 0;
};

/// Reads one topic while it lives; its handler is called on the strand it was made for.
class RawReader {
 public:
  virtual ~RawReader() = default;
};

/// Serialised sample with its encapsulation header, and who sent it. Returns false when the bytes could
/// not be decoded: the wire counts it as malformed, by sender.
using RawHandler = std::function<bool(std::span<const std::uint8_t> cdr, const SampleInfo&)>;

struct ParticipantEvent {
  ParticipantId id{};
  bool present{};  ///< false: left, or its lease ran out
  /// Not empty: it is present, but of a release whose radio contract differs from ours. Says which, for
  /// people.
  std::string incompatible{};
};

/// What passed on one topic between us and one peer since the start. Bytes are what the network
/// carries: payload, RTPS, UDP and IP headers.
struct TopicCount {
  std::string topic{};
  ParticipantId peer{};  ///< all zero: to whoever is matched (writers), or not known
  std::uint64_t samples_out{}, bytes_out{}, samples_in{}, bytes_in{};
  std::uint64_t failed_writes{}, malformed{}, lost{};
  std::uint64_t overwritten{};  ///< samples that a newer one replaced before the reader's strand took them
};

struct WireCounters {
  std::vector<TopicCount> topics{};               ///< sorted by topic, then peer
  std::uint64_t discovery_out{}, discovery_in{};  ///< bytes of discovery and liveliness traffic
  std::uint64_t total_out{}, total_in{};          ///< bytes of everything
};

/// One participant on one domain: makes the writers and readers of its topics, tells who else is there, and
/// counts. Goodbye is said when it is destroyed. Errors are bad_argument (also: another type, key or bound
/// than a topic of that name has here already) and wire_failed. Calls are safe from any thread.
class Participant {
 public:
  virtual ~Participant() = default;
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  virtual ParticipantId id() const = 0;
  /// `partition` empty: the default one. Writers and readers must not outlive the wire.
  virtual Result<std::unique_ptr<RawWriter>> make_writer(const TopicInfo& topic,
                                                         const std::string& partition) = 0;
  virtual Result<std::unique_ptr<RawReader>> make_reader(const TopicInfo& topic, const std::string& partition,
                                                         Executor& strand, RawHandler handler) = 0;
  /// Calls `handler` on `strand` for every other participant that comes or goes; those present already
  /// are reported at once. One that turns out to be of another release is reported once more. One handler per
  /// wire; an empty one ends it, and `strand` may go.
  virtual void on_participant(Executor& strand, std::function<void(const ParticipantEvent&)> handler) = 0;
  /// Since this participant was made.
  virtual WireCounters counters() const = 0;
  /// What waits here to be sent. Cheap, and allocates nothing.
  virtual SenderState sender() const = 0;
  /// What the link to each other participant carried, by id; those that left a while ago may be missing.
  virtual std::vector<PeerState> peers() const = 0;
  /// Where a participant is in the map (our own id: where we are), for links with a range or that fade. In a
  /// rehearsal the simulated truth counts instead.
  virtual void set_place(const ParticipantId& who, const Position& at) = 0;
};

}  // namespace adit::wire
