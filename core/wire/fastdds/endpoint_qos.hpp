#pragma once
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "core/wire/participant.hpp"

namespace adit::wire {

/// Flow controllers of a participant on a link: for `bulk` and for `video`.
inline constexpr const char* kBulkFlow = "adit_bulk";
inline constexpr const char* kVideoFlow = "adit_video";

/// The QoS class of a topic in Fast DDS's terms, all limits set together.
/// `on_link`: its participant has the flow controllers of a link.
eprosima::fastdds::dds::DataWriterQos dds_writer_qos(const TopicInfo& topic, bool on_link);
eprosima::fastdds::dds::DataReaderQos dds_reader_qos(const TopicInfo& topic);

}  // namespace adit::wire
