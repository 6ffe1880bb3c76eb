// SPDX-License-Identifier: Apache-2.0
#include "core/record/channels.hpp"

#include "core/record/idl_schema.hpp"

namespace adit::record {
namespace {

constexpr const char* kLogIdl = R"idl(module foxglove {
struct Time { unsigned long sec; unsigned long nsec; };
enum LogLevel { UNKNOWN, DEBUG, INFO, WARNING, ERROR, FATAL };
@final struct Log {
  Time timestamp;
  LogLevel level;
  string message;
  string name;
  string file;
  unsigned long line;
};
};
)idl";

}  // namespace

std::uint16_t Channels::get(ChannelId id, const ChannelInfo& info) {
  if (const auto known = channels_.find(id); known != channels_.end()) return known->second;
  const bool malformed = info.metadata.contains(kMalformedKey);
  std::uint16_t schema = 0;
  if (const auto known = schemas_.find(info.dds_type); known != schemas_.end()) {
    schema = known->second;
  } else if (!malformed) {
    if (info.dds_type == kLogType)
      schema = writer_.add_schema(kLogType, "omgidl", kLogIdl);
    else if (const auto idl = idl_schema(info.dds_type))
      schema = writer_.add_schema(idl->name, "omgidl", idl->text);
    schemas_[info.dds_type] = schema;
  }
  if (malformed) schema = 0;
  const std::uint16_t own = writer_.add_channel(
      schema, info.topic, schema != 0 ? "cdr" : "application/octet-stream", info.metadata);
  channels_[id] = own;
  return own;
}

}  // namespace adit::record
