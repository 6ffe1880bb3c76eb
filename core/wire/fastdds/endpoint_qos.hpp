// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "core/wire/participant.hpp"

namespace adit::wire {

/// Name of the flow controller of a participant with a link, for the class `bulk`.
inline constexpr const char* kBulkFlow = "adit_bulk";

/// Returns a topic's QoS class in terms of Fast DDS, with all resource limits. `on_link`: the participant has
/// the flow controller of a link.
eprosima::fastdds::dds::DataWriterQos dds_writer_qos(const TopicInfo& topic, bool on_link);
eprosima::fastdds::dds::DataReaderQos dds_reader_qos(const TopicInfo& topic);

}  // namespace adit::wire
