// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/endpoint_qos.hpp"

#include <algorithm>

#include "core/wire/qos.hpp"

namespace adit::wire {
namespace dds = eprosima::fastdds::dds;
namespace {

constexpr int kReaderDepth = 64;  // Unkeyed: samples of all writers until they are taken, which is immediate.

eprosima::fastrtps::Duration_t duration(Duration d) {
  return {static_cast<std::int32_t>(d / 1s), static_cast<std::uint32_t>((d % 1s).count())};
}

template <class EndpointQos>
void common(const TopicInfo& topic, const Qos& qos, int depth, EndpointQos& out) {
  out.reliability().kind = qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  // Writing never blocks; the newest samples stay in the history.
  out.reliability().max_blocking_time = duration(0ms);
  out.durability().kind =
      qos.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  out.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  out.history().depth = depth;
  const int keys = topic.keyed ? static_cast<int>(kMaxKeys) : 1;
  out.resource_limits().max_instances = keys;
  out.resource_limits().max_samples_per_instance = depth;
  out.resource_limits().max_samples = keys * depth;
  out.resource_limits().allocated_samples = std::min(16, keys * depth);
  out.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  out.data_sharing().off();
}

}  // namespace

dds::DataWriterQos dds_writer_qos(const TopicInfo& topic, bool on_link) {
  const Qos qos = writer_qos(topic);
  dds::DataWriterQos out;
  common(topic, qos, std::max<int>(1, topic.depth), out);
  out.writer_data_lifecycle().autodispose_unregistered_instances = false;
  if (qos.reliable) out.reliable_writer_qos().times.heartbeatPeriod = duration(qos.heartbeat);
  // By default the caller's thread sends, which has the lowest latency. Large samples that can be deferred go
  // through a flow controller, so that they do not hold that thread up.
  const bool wait = topic.qos == QosClass::bulk;
  out.publish_mode().kind = wait ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
  // Its readers would otherwise acknowledge each fragment.
  if (topic.qos == QosClass::bulk) out.reliable_writer_qos().disable_heartbeat_piggyback = true;
  if (on_link && wait) out.publish_mode().flow_controller_name = kBulkFlow;
  return out;
}

dds::DataReaderQos dds_reader_qos(const TopicInfo& topic) {
  const Qos qos = reader_qos(topic);
  dds::DataReaderQos out;
  common(topic, qos, topic.keyed ? std::max<int>(4, topic.depth) : kReaderDepth, out);
  return out;
}

}  // namespace adit::wire
