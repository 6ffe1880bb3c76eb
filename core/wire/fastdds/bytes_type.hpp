// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// A serialised sample as BytesType passes it to and from Fast DDS. Writers set `out`; readers find the bytes
/// in `in`.
struct SerializedSample {
  std::span<const std::uint8_t> out{};
  std::vector<std::uint8_t> in{};
  std::uint32_t max_bytes{UINT32_MAX};  ///< Readers: a longer sample is not copied, and `too_long` is set.
  bool too_long{};
};

/// A DDS type of any name whose samples are bytes that are already serialised. Fast DDS never decodes them,
/// so no bytes from a peer can make it throw. The key is the first member, a string.
class BytesType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  /// `max_bytes`: largest size of a sample; Fast DDS sizes its buffers with it.
  BytesType(const std::string& name, bool keyed, std::uint32_t max_bytes);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new SerializedSample(); }
  void deleteData(void* data) override { delete static_cast<SerializedSample*>(data); }
  /// Always succeeds: all samples without a readable key share one instance. A reader thus receives and
  /// counts them, whereas Fast DDS would drop them without a report.
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
};

}  // namespace adit::wire
