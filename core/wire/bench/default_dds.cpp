// SPDX-License-Identifier: Apache-2.0
#include "core/wire/bench/default_dds.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <map>

#include "core/wire/fastdds/bytes_type.hpp"
#include "core/wire/fastdds/filtering_transport.hpp"
#include "core/wire/qos.hpp"

namespace adit::bench {
namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

struct DefaultDds::Impl : dds::DataReaderListener {
  void on_data_available(dds::DataReader* from) override {
    wire::SerializedSample bytes;
    dds::SampleInfo info;
    while (from->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
    }
  }
  dds::Topic* topic_of(const wire::TopicInfo& topic) {
    auto*& known = topics[topic.name];
    if (known != nullptr) return known;
    dds::TypeSupport type(new wire::BytesType(topic.type, topic.keyed, topic.max_bytes));
    type.register_type(participant);
    return known = participant->create_topic(topic.name, topic.type, dds::TOPIC_QOS_DEFAULT);
  }

  std::shared_ptr<wire::TransportContext> context{std::make_shared<wire::TransportContext>()};
  dds::DomainParticipant* participant{};
  std::map<std::string, dds::Topic*> topics{};
  std::map<std::string, dds::Publisher*> publishers{};
  std::map<std::string, dds::Subscriber*> subscribers{};
  std::map<std::pair<std::string, std::string>, dds::DataWriter*> writers{};
};

DefaultDds::DefaultDds(unsigned domain, const std::string& name) : impl_(std::make_unique<Impl>()) {
  dds::DomainParticipantQos qos;
  qos.name(name);
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().user_transports.push_back(
      std::make_shared<wire::FilteringTransportDescriptor>(udp, impl_->context));
  impl_->context->discovery_gate.open();
  impl_->participant = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

DefaultDds::~DefaultDds() {
  impl_->participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

void DefaultDds::write(const wire::TopicInfo& topic, const std::string& partition,
                       std::span<const std::uint8_t> sample) {
  auto*& writer = impl_->writers[{topic.name, partition}];
  if (writer == nullptr) {
    auto*& publisher = impl_->publishers[partition];
    if (publisher == nullptr) {
      dds::PublisherQos qos;
      if (!partition.empty()) qos.partition().push_back(partition.c_str());
      publisher = impl_->participant->create_publisher(qos);
    }
    writer = publisher->create_datawriter(impl_->topic_of(topic), dds::DATAWRITER_QOS_DEFAULT);
  }
  wire::SerializedSample bytes;
  bytes.out = sample;
  if (!sample.empty()) writer->write(&bytes);
}

void DefaultDds::read(const wire::TopicInfo& topic, const std::string& partition) {
  auto*& subscriber = impl_->subscribers[partition];
  if (subscriber == nullptr) {
    dds::SubscriberQos qos;
    if (!partition.empty()) qos.partition().push_back(partition.c_str());
    subscriber = impl_->participant->create_subscriber(qos);
  }
  dds::DataReaderQos qos;
  if (wire::qos_of(topic.qos).reliable) qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  subscriber->create_datareader(impl_->topic_of(topic), qos, impl_.get());
}

wire::WireCounters DefaultDds::counters() const {
  wire::WireCounters result;
  result.discovery_out = impl_->context->discovery_out;
  result.discovery_in = impl_->context->discovery_in;
  result.total_out = impl_->context->total_out;
  result.total_in = impl_->context->total_in;
  return result;
}

}  // namespace adit::bench
