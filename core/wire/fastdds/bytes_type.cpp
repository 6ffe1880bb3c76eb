// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/bytes_type.hpp"

#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/SerializedPayload.h>
#include <fastrtps/utils/md5.h>

#include <algorithm>
#include <cstring>

#include "core/wire/cdr_key.hpp"

namespace adit::wire {
namespace rtps = eprosima::fastrtps::rtps;

BytesType::BytesType(const std::string& name, bool keyed, std::uint32_t max_bytes) {
  setName(name.c_str());
  m_typeSize = max_bytes;
  m_isGetKeyDefined = keyed;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool BytesType::serialize(void* data, rtps::SerializedPayload_t* payload) {
  const auto& out = static_cast<const SerializedSample*>(data)->out;
  if (out.size() < 4 || out.size() > payload->max_size) return false;
  std::memcpy(payload->data, out.data(), out.size());
  payload->length = static_cast<std::uint32_t>(out.size());
  payload->encapsulation = out[1] == 0 ? CDR_BE : CDR_LE;
  return true;
}

bool BytesType::deserialize(rtps::SerializedPayload_t* payload, void* data) {
  auto& bytes = *static_cast<SerializedSample*>(data);
  bytes.too_long = payload->length > bytes.max_bytes;
  if (bytes.too_long) {
    bytes.in.clear();
  } else {
    bytes.in.assign(payload->data, payload->data + payload->length);
  }
  return true;
}

std::function<std::uint32_t()> BytesType::getSerializedSizeProvider(void* data) {
  return [bytes = static_cast<const SerializedSample*>(data)] {
    return static_cast<std::uint32_t>(bytes->out.size());
  };
}

bool BytesType::getKey(void* data, rtps::InstanceHandle_t* handle, bool) {
  if (!m_isGetKeyDefined) return false;
  const auto& bytes = *static_cast<const SerializedSample*>(data);
  const auto key = first_string(bytes.out.empty() ? std::span<const std::uint8_t>(bytes.in) : bytes.out);
  if (!key) {
    for (int i = 0; i < 16; ++i) handle->value[i] = 0xff;
    return true;
  }
  // RTPS defines the key hash as the MD5 of the key in big-endian CDR: the length with terminator, then the
  // text.
  const auto length = static_cast<std::uint32_t>(key->size() + 1);
  const unsigned char prefix[4] = {
      static_cast<unsigned char>(length >> 24), static_cast<unsigned char>(length >> 16),
      static_cast<unsigned char>(length >> 8), static_cast<unsigned char>(length)};
  MD5 md5;
  md5.init();
  md5.update(prefix, 4);
  md5.update(key->data(), static_cast<MD5::size_type>(key->size()));
  md5.update("", 1);
  md5.finalize();
  for (int i = 0; i < 16; ++i) handle->value[i] = md5.digest[i];
  return true;
}

}  // namespace adit::wire
