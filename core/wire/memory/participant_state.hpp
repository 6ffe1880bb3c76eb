#pragma once
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/wire/cost.hpp"
#include "core/wire/known_topics.hpp"
#include "core/wire/mailbox.hpp"
#include "core/wire/memory/radio.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/qos.hpp"

/// How the in-memory wire behaves inside: RTPS in miniature. Everything here runs on the scheduler's thread.
namespace adit::wire {

using Payload = std::shared_ptr<const std::vector<std::uint8_t>>;

/// A participant's endpoint, as everybody names it.
struct EndpointId {
  int node{};
  int entity{};
  auto operator<=>(const EndpointId&) const = default;
};

/// What a topic is, with the strings its constant may not outlive.
struct TopicOf {
  std::string name{}, type{}, partition{};
  QosClass qos_class{};
  Qos qos{};
  std::size_t depth{1};
  bool keyed{};
  std::uint32_t max_bytes{};
};

struct Sample {
  std::uint64_t sequence{};
  std::string key{};
  Payload bytes{};
  int endpoint{-1};  ///< discovery: the entity this sample announces
  std::uint16_t frames{1};
  std::uint32_t wire_bytes{};
};

struct Missing {
  std::uint64_t sequence{};
  std::uint16_t frames{};  ///< of it that did not arrive; 0: all
};

struct ParticipantState;

struct WriterState : std::enable_shared_from_this<WriterState> {
  /// One matched reader.
  struct Proxy {
    bool reliable{};
    std::uint64_t start{};         ///< first sequence that concerns it
    std::uint64_t acknowledged{};  ///< all up to here
  };
  static constexpr std::size_t kMaxSamples = 1024;  ///< of a history, all keys together

  /// What the flow controller holds back: for one reader (a repair) or for all.
  struct Pending {
    std::uint64_t sequence{};
    std::uint16_t frames{};  ///< 0: all
    EndpointId reader{-1, -1};
  };

  Result<void> write(std::span<const std::uint8_t> cdr);
  Error refused(Reason reason, const std::string& why);
  void add(Sample sample);
  void match(EndpointId reader, bool reader_reliable);
  void send(EndpointId reader, const Sample& sample, std::uint16_t frames);
  /// Discovery: as many endpoints in a frame as fit.
  void send_endpoints(EndpointId reader, const std::vector<Sample>& samples);
  /// `bulk`: hands on what waits as the air takes it, so that what is replaced meanwhile is never sent.
  void pump();
  void repair(Pending entry);
  void arm_heartbeat();
  void heartbeat();
  void on_acknack(EndpointId reader, std::uint64_t base, const std::vector<Missing>& missing);

  ParticipantState* owner{};
  int entity{};
  TopicOf topic{};
  bool discovery{};
  std::uint64_t next{1};
  std::deque<Sample> history{};
  std::set<std::string> keys{};  ///< written so far
  std::map<EndpointId, Proxy> readers{};
  bool heartbeat_armed{};
  std::deque<Pending> pending{};
  std::uint64_t sent{};  ///< the newest one handed on
  bool pump_armed{};
};

struct ReaderState : std::enable_shared_from_this<ReaderState> {
  using Box = Mailbox<Payload>;
  /// A sample that waits for those before it, or for its own missing frames. No bytes: never coming.
  struct Held {
    Sample sample{};
    std::uint16_t missing{};
  };
  /// One matched writer.
  struct Proxy {
    bool reliable{};
    std::uint64_t next{};  ///< the sequence to deliver next; 0: nothing heard of it yet
    std::map<std::uint64_t, Held> held{};
  };

  void on_data(EndpointId writer, std::uint64_t start, const Sample& sample, std::uint16_t frames);
  void on_heartbeat(EndpointId writer, std::uint64_t start, std::uint64_t first, std::uint64_t last);
  void on_gap(EndpointId writer, const std::vector<std::uint64_t>& sequences);
  void drain(EndpointId writer, Proxy& proxy);
  void deliver(EndpointId writer, const Sample& sample);
  /// Notes the key of a sample. False: there are too many, all of writers that are still there.
  bool take_key(EndpointId writer, const std::string& key);
  /// Has the strand handle what is in the mailbox; one task of it is under way at a time.
  void post();
  void handle();

  ParticipantState* owner{};
  int entity{};
  TopicOf topic{};
  bool discovery{};
  Executor* strand{};  ///< null: the reader is gone
  RawHandler handler{};
  std::map<std::string, std::set<EndpointId>> keys{};  ///< with those that wrote them
  Box mailbox{1, 0};
  bool posted{};
  std::map<EndpointId, Proxy> writers{};
};

struct ParticipantState : std::enable_shared_from_this<ParticipantState> {
  struct Peer {
    Duration heard{};
    bool knows_us{};  ///< it sent something to us alone
    int tells{};      ///< announcements to it that are left, while it does not know us
    bool telling{};
    std::map<int, TopicOf> writers{}, readers{};  ///< as announced, by entity
    std::string incompatible{};                   ///< as in ParticipantEvent
  };

  void start();
  void announce();
  void check_leases();
  void on_announcement(int from);
  /// Announces itself to a peer until that shows that it heard.
  void announce_again(int peer);
  void announce_to(int peer);
  void on_endpoint(int from, int entity);
  void drop(int peer);
  void stop(bool goodbye);

  void add_writer(const std::shared_ptr<WriterState>& writer);
  void add_reader(const std::shared_ptr<ReaderState>& reader);
  void remove_writer(int entity);
  void remove_reader(int entity);
  /// Tells all peers of an endpoint that came or went.
  void publish_endpoint(int entity);

  /// Sends to one peer; `arrive` runs there with the frames that arrived, when it is still in the network.
  void send(int to, Datagram datagram, std::function<void(ParticipantState&, std::uint16_t)> arrive,
            bool discovery);
  ParticipantState* peer_participant(int peer_node) const;
  void notify(int peer, bool present, const std::string& incompatible = {});
  TopicCount& count(const std::string& topic, const ParticipantId& peer);

  SimulatedNetwork::State* core{};
  int node{};
  ParticipantId id{};
  std::uint32_t domain{};
  std::string machine{};
  bool stopped{};
  int announced{};
  KnownTopics known_topics{};
  int next_entity{3};  ///< 1 and 2 are discovery's own writer and reader
  std::map<int, Peer> peers{};
  std::map<int, std::shared_ptr<WriterState>> writers{};
  std::map<int, std::shared_ptr<ReaderState>> readers{};
  std::shared_ptr<WriterState> discovery_writer{};
  std::shared_ptr<ReaderState> discovery_reader{};
  Executor* event_strand{};
  std::shared_ptr<std::function<void(const ParticipantEvent&)>> event_handler{};
  std::map<std::pair<std::string, ParticipantId>, TopicCount> counts{};
  std::map<int, PeerState> carried{};  ///< by node; those in `peers` and some that were not yet or no more
  WireCounters totals{};
};

/// What all wires of a simulated network share.
struct SimulatedNetwork::State : std::enable_shared_from_this<SimulatedNetwork::State> {
  State(VirtualScheduler& s, SimulatedNetworkParams p);
  ParticipantId new_id();
  void after(Duration delay, Task task);
  void show(SampleEvent::Kind kind, const ParticipantState& from, const ParticipantState* to,
            const TopicOf& topic, const Payload& bytes);

  VirtualScheduler& scheduler;
  SimulatedNetworkParams params;
  std::shared_ptr<Radio> radio;
  std::vector<std::shared_ptr<ParticipantState>> participants{};  ///< by node, those that left included
  std::function<void(const SampleEvent&)> tap{};
  Random ids;
  bool closed{};
};

}  // namespace adit::wire
