// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/fastdds_participant.hpp"

#include <arpa/inet.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "core/wire/contract.hpp"
#include "core/wire/fastdds/endpoints.hpp"
#include "core/wire/fastdds/filtering_transport.hpp"
#include "core/wire/fastdds/link_shaper.hpp"
#include "core/wire/fastdds/participant_qos.hpp"
#include "core/wire/fastdds/remote_endpoints.hpp"
#include "core/wire/fastdds/subnets.hpp"
#include "core/wire/fastdds/udp_sender.hpp"
#include "core/wire/known_topics.hpp"

namespace adit::wire {
namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;
namespace {

ParticipantId id_of(const rtps::GuidPrefix_t& prefix) {
  ParticipantId id{};
  std::copy(std::begin(prefix.value), std::end(prefix.value), id.begin());
  return id;
}

/// Removes the environment variables of a ROS 2 robot that Fast DDS reads: they would make our participants
/// clients of a discovery server or load profiles, and no peer would be heard any more.
void ignore_environment() {
  for (const char* name : {"ROS_DISCOVERY_SERVER", "FASTRTPS_DEFAULT_PROFILES_FILE",
                           "FASTDDS_ENVIRONMENT_FILE", "FASTDDS_STATISTICS"}) {
    if (std::getenv(name) != nullptr) ::unsetenv(name);
  }
  // Skips DEFAULT_FASTRTPS_PROFILES.xml in this folder.
  constexpr const char* skip = "SKIP_DEFAULT_XML_FILE";
  const char* skipped = std::getenv(skip);
  if (skipped == nullptr || std::string_view(skipped) != "1") ::setenv(skip, "1", 1);
}

/// Reports the participants on the domain to one handler on its strand.
class DiscoveryListener final : public dds::DomainParticipantListener {
 public:
  explicit DiscoveryListener(std::shared_ptr<TransportContext> context) : context_(std::move(context)) {}
  void watch(Executor& strand, std::function<void(const ParticipantEvent&)> handler) {
    const std::lock_guard lock(mutex_);
    if (target_) target_->close();
    target_.reset();
    if (!handler) return;
    target_ = std::make_shared<Target>();
    target_->handler = std::move(handler);
    strand_ = &strand;
    for (const auto& [id, peer] : present_) {
      notify({id, true, {}});
      if (!peer.incompatible.empty()) notify({id, true, peer.incompatible});
    }
  }
  /// On return the handler is not running and will not run again.
  void close() {
    const std::lock_guard lock(mutex_);
    if (target_) target_->close();
    target_.reset();
  }
  const RemoteEndpoints& endpoints() const { return endpoints_; }

 private:
  struct Peer {
    std::string name{};          ///< The name it announces.
    std::string incompatible{};  ///< As in ParticipantEvent.
  };
  struct Target {
    std::recursive_mutex mutex{};
    std::function<void(const ParticipantEvent&)> handler{};
    bool closed{};
    void close() {
      const std::lock_guard lock(mutex);
      closed = true;
    }
  };

  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) override {
    const ParticipantId id = id_of(info.info.m_guid.guidPrefix);
    const bool gone = info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
                      info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT;
    if (gone) {
      context_->assist.dropped(id, std::chrono::steady_clock::now().time_since_epoch());
      if (context_->repeats) context_->repeats->wake();
      endpoints_.lost_all(id);
    }
    const std::lock_guard lock(mutex_);
    const bool changed =
        gone ? present_.erase(id) > 0
             : present_.try_emplace(id, Peer{info.info.m_participantName.to_string(), {}}).second;
    if (changed) notify({id, !gone, {}});
  }
  void on_publisher_discovery(dds::DomainParticipant* own, rtps::WriterDiscoveryInfo&& info) override {
    note(*own, info.info, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER, true);
  }
  void on_subscriber_discovery(dds::DomainParticipant* own, rtps::ReaderDiscoveryInfo&& info) override {
    note(*own, info.info, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER, false);
  }
  template <class Proxy>
  void note(const dds::DomainParticipant& own, const Proxy& proxy, bool removed, bool writes) {
    const std::string type = proxy.typeName().to_string();
    look(proxy.guid().guidPrefix, type);
    if (removed)
      endpoints_.lost(proxy.guid());
    else if (proxy.guid().guidPrefix != own.guid().guidPrefix)
      endpoints_.found(proxy.guid(), proxy.topicName().to_string(), type, writes);
  }
  /// Checks the type of an endpoint of a peer for another contract version.
  void look(const rtps::GuidPrefix_t& prefix, const std::string& type) {
    const std::string version = other_release(type);
    if (version.empty()) return;
    const std::lock_guard lock(mutex_);
    const auto peer = present_.find(id_of(prefix));
    if (peer == present_.end() || !peer->second.incompatible.empty()) return;
    peer->second.incompatible = describe_release(peer->second.name, version);
    notify({peer->first, true, peer->second.incompatible});
  }

  void notify(ParticipantEvent event) {
    if (!target_) return;
    strand_->post_control([target = target_, event = std::move(event)] {
      const std::lock_guard lock(target->mutex);
      if (!target->closed) target->handler(event);
    });
  }

  std::shared_ptr<TransportContext> context_;
  std::mutex mutex_{};
  std::map<ParticipantId, Peer> present_{};
  RemoteEndpoints endpoints_{};
  Executor* strand_{};
  std::shared_ptr<Target> target_{};
};

class FastDdsParticipant final : public Participant {
 public:
  FastDdsParticipant() = default;
  ~FastDdsParticipant() override {
    listener_.close();
    if (participant_ != nullptr) {
      participant_->set_listener(nullptr);
      participant_->delete_contained_entities();
      dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    context_->repeats.reset();
    if (context_->link) context_->link->close();
  }

  Result<void> open(const FastDdsParams& params) {
    ignore_environment();
    // All datagrams pass our transports and are counted there. Delivery within a process would bypass them.
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
    auto qos = dds_participant_qos(params, context_);
    if (!qos) return qos.error();
    const std::vector<std::string> loopback{"127.0.0.1"};
    const auto& interfaces = params.interfaces.empty() ? loopback : params.interfaces;
    for (const std::string& address : interfaces) context_->own_addresses.insert(inet_addr(address.c_str()));
    const auto networks = std::make_shared<const Subnets>(interfaces, params.peers);
    const auto reachable = [networks](in_addr_t address) { return networks->contains(address); };
    context_->assist.set_reachable(reachable);
    if (!params.large_samples) {
      context_->udp_sender = std::make_shared<UdpSender>(interfaces);
      const auto radio = std::make_shared<const UdpSender>(interfaces);
      context_->guard.set({true, reachable,
                           [networks](in_addr_t a, in_addr_t b) { return networks->share(a, b); },
                           [context = context_.get(), ours = radio->port(),
                            to_us = context_->udp_sender->port()](auto source) {
                             return (source.port == ours || source.port == to_us) &&
                                    context->own_addresses.contains(source.address);
                           }});
      context_->link = std::make_shared<LinkShaper>(
          params.link, params.link_seed,
          [radio](auto message, in_addr_t address, std::uint16_t port) {
            return radio->send(message, address, port);
          },
          LinkShaper::Outputs{
              [context = context_.get()](auto message, in_addr_t address, std::uint16_t port) {
                context->sent(message, address, port);
              },
              [context = context_.get()](in_addr_t address, std::uint16_t port) {
                return context->peers.path(address, port);
              }});
    }
    if (context_->link) {
      context_->repeats = std::make_unique<DiscoveryAssistThread>(
          context_->assist, [link = context_->link.get()] { return link->sender().waiting(1) < 100ms; },
          [link = context_->link.get()](auto message, in_addr_t address, std::uint16_t port) {
            link->send(message, address, port);
          });
    }
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        params.domain, *qos, &listener_, dds::StatusMask::none());
    context_->discovery_gate.open();
    if (participant_ == nullptr) {
      return Error{Reason::wire_failed,
                   "no DDS participant on domain " + std::to_string(params.domain) +
                       ": check that the configured interfaces are addresses of this machine"};
    }
    return {};
  }

  ParticipantId id() const override { return id_of(participant_->guid().guidPrefix); }

  Result<std::unique_ptr<RawWriter>> make_writer(const TopicInfo& topic,
                                                 const std::string& partition) override {
    const std::lock_guard lock(mutex_);
    auto dds_topic = topic_of(topic);
    if (!dds_topic) return dds_topic.error();
    dds::Publisher*& publisher = publishers_[partition];
    if (publisher == nullptr) {
      dds::PublisherQos qos;
      if (!partition.empty()) qos.partition().push_back(partition.c_str());
      publisher = participant_->create_publisher(qos);
      if (publisher == nullptr)
        return Error{Reason::wire_failed, "Fast DDS refused the partition " + partition};
    }
    return FastDdsWriter::make(*publisher, **dds_topic, topic, counts_, context_);
  }

  Result<std::unique_ptr<RawReader>> make_reader(const TopicInfo& topic, const std::string& partition,
                                                 Executor& strand, RawHandler handler) override {
    const std::lock_guard lock(mutex_);
    auto dds_topic = topic_of(topic);
    if (!dds_topic) return dds_topic.error();
    dds::Subscriber*& subscriber = subscribers_[partition];
    if (subscriber == nullptr) {
      dds::SubscriberQos qos;
      if (!partition.empty()) qos.partition().push_back(partition.c_str());
      subscriber = participant_->create_subscriber(qos);
      if (subscriber == nullptr)
        return Error{Reason::wire_failed, "Fast DDS refused the partition " + partition};
    }
    return FastDdsReader::make(*subscriber, **dds_topic, topic, counts_, strand, std::move(handler));
  }

  void on_participant(Executor& strand, std::function<void(const ParticipantEvent&)> handler) override {
    listener_.watch(strand, std::move(handler));
  }

  std::vector<RemoteEndpoint> endpoints(const std::string& topic) const override {
    return listener_.endpoints().of(topic);
  }

  WireCounters counters() const override {
    WireCounters result;
    result.topics = counts_->all();
    result.discovery_out = context_->discovery_out;
    result.discovery_in = context_->discovery_in;
    result.total_out = context_->total_out;
    result.total_in = context_->total_in;
    result.refused = context_->guard.refused();
    result.receiving = context_->receive_watch.longest(std::chrono::steady_clock::now().time_since_epoch());
    return result;
  }

  SenderState sender() const override { return context_->link ? context_->link->sender() : SenderState{}; }
  std::vector<PeerState> peers() const override {
    return context_->peers.all(id(), context_->link ? context_->link->profile() : nullptr);
  }
  void set_place(const ParticipantId& who, const Position& at) override {
    if (who == id())
      context_->peers.set_own_place(at);
    else
      context_->peers.set_place(who, at);
  }

 private:
  Result<dds::Topic*> topic_of(const TopicInfo& topic) {
    dds::Topic*& known = topics_[topic.name];
    // A topic that no endpoint uses any more may get another type; while one does, the library keeps it.
    if (known_.contradicts(topic) && known != nullptr &&
        participant_->delete_topic(known) == ReturnCode_t::RETCODE_OK) {
      known = nullptr;
      known_.forget(topic.name);
    }
    if (const auto allowed = known_.add(topic); !allowed) return allowed.error();
    context_->guard.admit_samples(topic.max_bytes);
    if (known != nullptr) return known;
    dds::TypeSupport type(new BytesType(topic.type, topic.keyed, topic.max_bytes));
    if (participant_->find_type(topic.type).empty() &&
        type.register_type(participant_) != ReturnCode_t::RETCODE_OK) {
      return Error{Reason::wire_failed, std::string("Fast DDS refused the type ") + topic.type};
    }
    known = participant_->create_topic(topic.name, topic.type, dds::TOPIC_QOS_DEFAULT);
    if (known == nullptr)
      return Error{Reason::wire_failed, std::string("Fast DDS refused the topic ") + topic.name};
    return known;
  }

  std::shared_ptr<TransportContext> context_{std::make_shared<TransportContext>()};
  DiscoveryListener listener_{context_};
  std::shared_ptr<SharedCounts> counts_{std::make_shared<SharedCounts>()};
  dds::DomainParticipant* participant_{};
  std::mutex mutex_{};
  KnownTopics known_{};
  std::map<std::string, dds::Topic*> topics_{};
  std::map<std::string, dds::Publisher*> publishers_{};
  std::map<std::string, dds::Subscriber*> subscribers_{};
};

}  // namespace

Result<std::unique_ptr<Participant>> open_fastdds(const FastDdsParams& params) {
  auto wire = std::make_unique<FastDdsParticipant>();
  if (auto opened = wire->open(params); !opened) return opened.error();
  return std::unique_ptr<Participant>(std::move(wire));
}

}  // namespace adit::wire
