// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "core/record/mcap_writer.hpp"
#include "core/record/record_sink.hpp"

namespace adit::record {

/// The channels of one file and their schemas, added with their first message.
class Channels {
 public:
  explicit Channels(McapWriter& writer) : writer_(writer) {}
  /// Returns the id in the file of the caller's channel `id`; `info` is used when the channel is new.
  std::uint16_t get(ChannelId id, const ChannelInfo& info);

 private:
  McapWriter& writer_;
  std::map<std::string, std::uint16_t> schemas_{};  ///< By DDS type; 0: none.
  std::map<ChannelId, std::uint16_t> channels_{};
};

}  // namespace adit::record
