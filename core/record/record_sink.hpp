// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "core/record/bytes.hpp"

namespace adit::record {

/// A channel of a recording: messages of one type, in one direction, with one peer.
struct ChannelInfo {
  std::string topic{};     ///< Name for users: "out/adit/command".
  std::string dds_type{};  ///< Looked up in idl/; an unknown type is recorded without a schema.
  Text metadata{};         ///< Sender and receiver.
  auto operator<=>(const ChannelInfo&) const = default;
};

using ChannelId = std::uint32_t;

/// Receiver of messages to record; never blocks: messages that do not fit are dropped and counted. Safe to
/// call from any thread.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// Returns the id of a channel. The same info gives the same id; each call needs its own release().
  virtual ChannelId channel(const ChannelInfo& info) = 0;
  /// Ends the use of a channel; its queued messages are still written.
  virtual void release(ChannelId channel) = 0;
  /// Records a serialised sample with its encapsulation header, at the current time.
  virtual void record(ChannelId channel, ByteSpan cdr) = 0;
};

/// DDS type of log lines: Foxglove's, which its log panel shows.
inline constexpr const char* kLogType = "foxglove::Log";

/// Message encoding for bytes that are no valid sample of their topic's type.
inline constexpr const char* kMalformedKey = "malformed";

}  // namespace adit::record
