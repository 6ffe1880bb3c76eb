#pragma once
#include <cstdint>
#include <string>

#include "core/record/bytes.hpp"

namespace adit::record {

/// One row of a recording: messages of one type, of one direction, with one peer.
struct ChannelInfo {
  std::string topic{};     ///< as people look for it: "out/adit/command"
  std::string dds_type{};  ///< looked up in idl/; a type that is not there is kept without a schema
  Text metadata{};         ///< who to whom
  auto operator<=>(const ChannelInfo&) const = default;
};

using ChannelId = std::uint32_t;

/// Takes messages and never blocks: what does not fit is dropped and counted. From any thread.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// The same info gives the same id; each call wants its own release().
  virtual ChannelId channel(const ChannelInfo& info) = 0;
  /// Nothing more comes for this one; what waits for it is written yet.
  virtual void release(ChannelId channel) = 0;
  /// A serialised sample with its encapsulation header, as of now.
  virtual void record(ChannelId channel, ByteSpan cdr) = 0;
};

/// DDS type of log lines: Foxglove's, so that its log panel shows them.
inline constexpr const char* kLogType = "foxglove::Log";

/// The message encoding for bytes that are no sample of their topic's type.
inline constexpr const char* kMalformedKey = "malformed";

}  // namespace adit::record
