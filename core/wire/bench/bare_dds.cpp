// SPDX-License-Identifier: Apache-2.0
#include "core/wire/bench/bare_dds.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <atomic>

#include "core/wire/fastdds/bytes_type.hpp"

namespace adit::bench {
namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

struct BareDds::Impl : dds::DataReaderListener, dds::DataWriterListener {
  void on_data_available(dds::DataReader* from) override {
    dds::SampleInfo info;
    while (from->take_next_sample(&received, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) handler(received.in);
    }
  }
  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    readers = status.current_count;
  }
  void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) override {
    writers = status.current_count;
  }

  Handler handler{};
  wire::SerializedSample received{};
  std::atomic<int> readers{0}, writers{0};
  dds::DomainParticipant* participant{};
  dds::DataWriter* writer{};
};

BareDds::BareDds(unsigned domain, const std::string& writes, const std::string& reads, Handler handler)
    : impl_(std::make_unique<Impl>()) {
  impl_->handler = std::move(handler);
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  dds::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().user_transports.push_back(udp);
  impl_->participant = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  dds::TypeSupport type(new wire::BytesType("Bytes", false, 1 << 16));
  type.register_type(impl_->participant);
  dds::DataReaderQos reader_qos;
  reader_qos.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
  dds::DataWriterQos writer_qos;
  writer_qos.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
  writer_qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  writer_qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  auto* out = impl_->participant->create_topic(writes, "Bytes", dds::TOPIC_QOS_DEFAULT);
  auto* in = impl_->participant->create_topic(reads, "Bytes", dds::TOPIC_QOS_DEFAULT);
  impl_->participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)
      ->create_datareader(in, reader_qos, impl_.get());
  impl_->writer = impl_->participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT)
                      ->create_datawriter(out, writer_qos, impl_.get());
}

BareDds::~BareDds() {
  impl_->participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

void BareDds::write(std::span<const std::uint8_t> bytes) {
  wire::SerializedSample sample;
  sample.out = bytes;
  impl_->writer->write(&sample);
}

bool BareDds::matched() const { return impl_->readers > 0 && impl_->writers > 0; }

}  // namespace adit::bench
