// SPDX-License-Identifier: Apache-2.0
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

/// Implementation of the in-memory wire, a reduced RTPS. Everything here runs on the scheduler's thread.
namespace adit::wire {

using Payload = std::shared_ptr<const std::vector<std::uint8_t>>;

/// Identifies an endpoint of a participant in the network.
struct EndpointId {
  int node{};
  int entity{};
  auto operator<=>(const EndpointId&) const = default;
};

/// Copy of a TopicInfo that owns its strings, as it may outlive the topic's constant.
struct TopicOf {
  std::string name{}, type{}, partition{};
  QosClass qos_class{};
  Qos qos{};
  std::size_t depth{1};
  bool keyed{};
  std::uint32_t max_bytes{};
};

/// A written sample.
struct Sample {
  std::uint64_t sequence{};
  std::string key{};
  Payload bytes{};
  int endpoint{-1};  ///< Discovery: the entity that this sample announces.
  std::uint16_t frames{1};
  std::uint32_t wire_bytes{};
};

struct Missing {
  std::uint64_t sequence{};
  std::uint16_t frames{};  ///< Frames that did not arrive; 0: all.
};

struct ParticipantState;

/// A writer of the simulated network.
struct WriterState : std::enable_shared_from_this<WriterState> {
  /// One matched reader.
  struct Proxy {
    bool reliable{};
    std::uint64_t start{};         ///< First sequence that concerns it.
    std::uint64_t acknowledged{};  ///< Highest sequence up to which all are acknowledged.
  };
  static constexpr std::size_t kMaxSamples = 1024;  ///< Samples of a history, all keys together.

  /// A message that the flow controller holds: for one reader (a repair) or for all.
  struct Pending {
    std::uint64_t sequence{};
    std::uint16_t frames{};  ///< 0: all.
    EndpointId reader{-1, -1};
  };

  Result<void> write(std::span<const std::uint8_t> cdr);
  Error refused(Reason reason, const std::string& why);
  void add(Sample sample);
  void match(EndpointId reader, const Qos& reader_qos);
  void send(EndpointId reader, const Sample& sample, std::uint16_t frames);
  /// Sends discovery samples, as many endpoints in a frame as fit.
  void send_endpoints(EndpointId reader, const std::vector<Sample>& samples);
  /// For `bulk`: passes queued samples on at the rate of the radio, so that a sample replaced meanwhile is
  /// never sent.
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
  std::set<std::string> keys{};  ///< Keys written so far.
  std::map<EndpointId, Proxy> readers{};
  bool heartbeat_armed{};
  std::deque<Pending> pending{};
  std::uint64_t sent{};  ///< The newest sequence passed to the radio.
  bool pump_armed{};
};

/// A reader of the simulated network.
struct ReaderState : std::enable_shared_from_this<ReaderState> {
  using Box = Mailbox<Payload>;
  /// A sample that waits for earlier ones, or for its own missing frames. Without bytes: it will never
  /// arrive.
  struct Held {
    Sample sample{};
    std::uint16_t missing{};
  };
  /// One matched writer.
  struct Proxy {
    bool reliable{};
    std::uint64_t next{};  ///< Next sequence to deliver; 0: nothing received from it yet.
    std::map<std::uint64_t, Held> held{};
  };

  void on_data(EndpointId writer, std::uint64_t start, const Sample& sample, std::uint16_t frames);
  void on_heartbeat(EndpointId writer, std::uint64_t start, std::uint64_t first, std::uint64_t last);
  void on_gap(EndpointId writer, const std::vector<std::uint64_t>& sequences);
  void drain(EndpointId writer, Proxy& proxy);
  void deliver(EndpointId writer, const Sample& sample);
  /// Records the key of a sample. Returns false when there are too many keys, all of writers that are still
  /// present.
  bool take_key(EndpointId writer, const std::string& key);
  /// Posts a task that handles the samples in the mailbox; at most one such task is queued at a time.
  void post();
  void handle();

  ParticipantState* owner{};
  int entity{};
  TopicOf topic{};
  bool discovery{};
  Executor* strand{};  ///< Null: the reader is gone.
  RawHandler handler{};
  std::map<std::string, std::set<EndpointId>> keys{};  ///< Keys with their writers.
  Box mailbox{1, 0};
  bool posted{};
  std::map<EndpointId, Proxy> writers{};
};

/// A participant of the simulated network.
struct ParticipantState : std::enable_shared_from_this<ParticipantState> {
  struct Peer {
    Duration heard{};
    bool knows_us{};           ///< It sent something to us by unicast.
    int announcements_left{};  ///< Announcements left to send to it while it does not know us.
    bool announcing{};
    std::string machine{};
    std::map<int, TopicOf> writers{}, readers{};  ///< As announced, by entity.
    std::string incompatible{};                   ///< As in ParticipantEvent.
  };

  void start();
  void announce();
  void check_leases();
  /// Announces us to peers that fell silent, as DiscoveryAssist does live.
  void search(Duration now);
  void on_announcement(int from);
  /// Repeats our announcement to a peer until it shows that it received one.
  void announce_again(int peer);
  void announce_to(int peer);
  void on_endpoint(int from, int entity);
  void drop(int peer);
  void stop(bool goodbye);

  /// Adds a topic for an endpoint. Errors: those of KnownTopics, while an endpoint uses the other one.
  Result<void> use(const TopicInfo& topic);
  std::vector<RemoteEndpoint> endpoints(const std::string& topic) const;
  void add_writer(const std::shared_ptr<WriterState>& writer);
  void add_reader(const std::shared_ptr<ReaderState>& reader);
  void remove_writer(int entity);
  void remove_reader(int entity);
  /// Announces to all peers an endpoint that was created or destroyed.
  void publish_endpoint(int entity);

  /// Sends to one peer; `arrive` runs at the peer, if it is still in the network, with the number of frames
  /// that arrived.
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
  int next_entity{3};  ///< 1 and 2 are discovery's own writer and reader.
  std::map<int, Peer> peers{};
  /// A peer whose lease ended without a goodbye, as DiscoveryAssist searches it live.
  struct Silent {
    std::string machine{};
    Duration since{}, announced{};
  };
  std::map<int, Silent> silent{};  ///< By node; at most 64.
  std::map<int, std::shared_ptr<WriterState>> writers{};
  std::map<int, std::shared_ptr<ReaderState>> readers{};
  std::shared_ptr<WriterState> discovery_writer{};
  std::shared_ptr<ReaderState> discovery_reader{};
  Executor* event_strand{};
  std::shared_ptr<std::function<void(const ParticipantEvent&)>> event_handler{};
  std::map<std::pair<std::string, ParticipantId>, TopicCount> counts{};
  /// By node; those in `peers`, and some that are not yet or no longer there.
  std::map<int, PeerState> carried{};
  WireCounters totals{};
};

/// State that all participants of a simulated network share.
struct SimulatedNetwork::State : std::enable_shared_from_this<SimulatedNetwork::State> {
  State(VirtualScheduler& s, SimulatedNetworkParams p);
  ParticipantId new_id();
  void after(Duration delay, Task task);
  void show(SampleEvent::Kind kind, const ParticipantState& from, const ParticipantState* to,
            const TopicOf& topic, const Payload& bytes);

  VirtualScheduler& scheduler;
  SimulatedNetworkParams params;
  std::shared_ptr<Radio> radio;
  std::vector<std::shared_ptr<ParticipantState>> participants{};  ///< By node, including those that left.
  std::function<void(const SampleEvent&)> tap{};
  Random ids;
  bool closed{};
};

}  // namespace adit::wire
