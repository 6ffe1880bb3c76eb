#pragma once
#include <map>
#include <string>

#include "core/record/mcap_writer.hpp"
#include "core/record/record_sink.hpp"

namespace adit::record {

/// Channels of one file, with the schemas they need, added when their first message comes.
class Channels {
 public:
  explicit Channels(McapWriter& writer) : writer_(writer) {}
  /// The id in the file of what is `id` to the caller; `info` is looked at when it is new.
  std::uint16_t get(ChannelId id, const ChannelInfo& info);

 private:
  McapWriter& writer_;
  std::map<std::string, std::uint16_t> schemas_{};  ///< by DDS type; 0: none
  std::map<ChannelId, std::uint16_t> channels_{};
};

}  // namespace adit::record
