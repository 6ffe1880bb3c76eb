// SPDX-License-Identifier: Apache-2.0
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

/// The wire: one participant on one domain, behind one interface with two adapters (Fast DDS, in-memory).
namespace adit::wire {

std::string to_string(const ParticipantId& id);

/// Purpose of a topic, which sets its QoS; docs/architecture.md has the table.
enum class QosClass : std::uint8_t { urgent, stream, state, status, bulk, video, sensor, pieces };

/// Description of a topic without its type, as both adapters need it.
struct TopicInfo {
  const char* name;  ///< DDS topic name.
  const char* type;  ///< DDS type name.
  QosClass qos;
  std::uint16_t depth;      ///< History depth, samples (per key where keyed).
  bool keyed;               ///< The key is the type's first member, a string.
  std::uint32_t max_bytes;  ///< Largest serialised size of a sample; longer ones are dropped and counted.
};

/// One constant that ties a topic's name, type and QoS class (core/wire/topics.hpp).
template <class T>
struct Topic : TopicInfo {};

/// Metadata of a received sample, independent of its content.
struct SampleInfo {
  ParticipantId sender{};  ///< The participant that wrote it.
  /// When it arrived, by the receiver's clock; time in the queue afterwards does not count.
  Time received{};
};

/// Writes one topic; never blocks. An error says why the sample could not be queued; it is also counted.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  virtual Result<void> write(std::span<const std::uint8_t> cdr) = 0;
  /// Number of readers that are matched now.
  virtual std::size_t matched() const = 0;
};

/// Reads one topic while it exists; its handler is called on the strand it was created with.
class RawReader {
 public:
  virtual ~RawReader() = default;
};

/// Handler of a serialised sample with its encapsulation header and its sender. It returns false when the
/// bytes could not be decoded: the wire counts the sample as malformed, by sender.
using RawHandler = std::function<bool(std::span<const std::uint8_t> cdr, const SampleInfo&)>;

/// A participant that appeared, left or changed.
struct ParticipantEvent {
  ParticipantId id{};
  bool present{};  ///< False: it left, or its lease expired.
  /// Not empty: it is present, but of a release whose radio contract differs from ours. The text names the
  /// release.
  std::string incompatible{};
};

/// A writer or reader of another participant, whether or not it fits ours.
struct RemoteEndpoint {
  ParticipantId participant{};
  std::string type{};  ///< DDS type name.
  bool writes{};       ///< A writer; otherwise a reader.
};

/// Traffic of one topic between us and one peer since the start. Bytes are those on the network: payload,
/// RTPS, UDP and IP headers.
struct TopicCount {
  std::string topic{};
  ParticipantId peer{};  ///< All zero: all matched readers (writers), or unknown.
  std::uint64_t samples_out{}, bytes_out{}, samples_in{}, bytes_in{};
  std::uint64_t failed_writes{}, malformed{}, lost{};
  std::uint64_t overwritten{};  ///< Samples replaced by a newer one before the reader's strand took them.
};

/// Why a datagram was refused before anything of it was processed (core/wire/fastdds/rtps_guard.hpp).
enum class Refusal : std::uint8_t {
  malformed,    ///< Lengths, kinds or fields that do not fit.
  number_jump,  ///< A sequence number far from the ones before.
  sample_size,  ///< A sample larger than any topic of the receiver allows.
  forged,       ///< In the name of a participant that sends from another socket.
  foreign,      ///< Discovery data about another participant, or with addresses of others alone.
  too_many,     ///< More participants, endpoints or writers than are stored.
  rationed,     ///< Not sent, as the participant has never answered.
};
inline constexpr std::size_t kRefusals = 7;
using RefusalCounts = std::array<std::uint64_t, kRefusals>;
/// Name of a refusal for people.
inline const char* to_string(Refusal refusal) {
  constexpr std::array<const char*, kRefusals> names{"malformed", "number jump", "sample size", "forged",
                                                     "foreign",   "too many",    "rationed"};
  return names[static_cast<std::size_t>(refusal)];
}

/// Traffic of a participant since its start.
struct WireCounters {
  std::vector<TopicCount> topics{};               ///< Sorted by topic, then peer.
  std::uint64_t discovery_out{}, discovery_in{};  ///< Bytes of discovery and liveliness traffic.
  std::uint64_t total_out{}, total_in{};          ///< Bytes of all traffic.
  RefusalCounts refused{};                        ///< Datagrams, by Refusal.
  Duration receiving{};  ///< For how long the longest datagram in work has been processed; mostly 0.
};

/// One participant on one domain: creates writers and readers, reports other participants, and counts
/// traffic. Its destructor says goodbye to the others. Errors are bad_argument (also: a writer or reader of
/// ours uses a topic of that name with another type, key or bound) and wire_failed. Calls are safe from any
/// thread.
class Participant {
 public:
  virtual ~Participant() = default;
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  virtual ParticipantId id() const = 0;
  /// An empty `partition` means the default one. Writers and readers must not outlive the participant.
  virtual Result<std::unique_ptr<RawWriter>> make_writer(const TopicInfo& topic,
                                                         const std::string& partition) = 0;
  virtual Result<std::unique_ptr<RawReader>> make_reader(const TopicInfo& topic, const std::string& partition,
                                                         Executor& strand, RawHandler handler) = 0;
  /// Calls `handler` on `strand` for every other participant that appears or leaves; those already present
  /// are reported at once. A participant that turns out to be of another release is reported once more. There
  /// is one handler per participant; an empty one ends the reports, and `strand` may then be destroyed.
  virtual void on_participant(Executor& strand, std::function<void(const ParticipantEvent&)> handler) = 0;
  /// The endpoints of other participants on a topic, of any type, as far as they are known now.
  virtual std::vector<RemoteEndpoint> endpoints(const std::string& topic) const = 0;
  /// Counts since this participant was created.
  virtual WireCounters counters() const = 0;
  /// State of the send queue. The call is cheap and allocates nothing.
  virtual SenderState sender() const = 0;
  /// Statistics of the link to each other participant, by id; those that left a while ago may be missing.
  virtual std::vector<PeerState> peers() const = 0;
  /// Sets the position of a participant in the map (our own id: our position), for links with a range or that
  /// fade. A rehearsal uses the simulated true positions instead.
  virtual void set_place(const ParticipantId& who, const Position& at) = 0;
};

}  // namespace adit::wire
