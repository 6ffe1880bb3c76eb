#pragma once
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adit::wire {

/// What the type below carries. Writers fill `out`, readers find `in`.
struct SerializedSample {
  std::span<const std::uint8_t> out{};
  std::vector<std::uint8_t> in{};
  std::uint32_t max_bytes{UINT32_MAX};  ///< readers: a longer sample is not copied, and too_long is set
  bool too_long{};
};

/// A type of any name whose samples are bytes that were serialised already. Fast DDS never decodes
/// anything, so nothing that a peer sends makes it throw. The key is the first member, a string.
class BytesType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  /// `max_bytes`: of a sample, for the library's own bookkeeping.
  BytesType(const std::string& name, bool keyed, std::uint32_t max_bytes);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new SerializedSample(); }
  void deleteData(void* data) override { delete static_cast<SerializedSample*>(data); }
  /// Always succeeds: samples without a readable key share one instance, so that a reader gets and counts
  /// them instead of the library dropping them in silence.
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
};

}  // namespace adit::wire
