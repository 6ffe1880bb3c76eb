#pragma once
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "core/wire/wire.hpp"

namespace adit::wire {

/// The QoS class of a topic in Fast DDS's terms, all limits set together.
eprosima::fastdds::dds::DataWriterQos dds_writer_qos(const TopicInfo& topic);
eprosima::fastdds::dds::DataReaderQos dds_reader_qos(const TopicInfo& topic);

}  // namespace adit::wire
