// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core/record/bytes.hpp"

/// The part of the MCAP container format, version 0 (mcap.dev/spec), that recordings use.
namespace adit::record {

inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

/// Kinds of MCAP records.
enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Opcode and length precede every record.
inline constexpr std::size_t kRecordHead = 9;

/// Type of a channel's messages, as its IDL text.
struct Schema {
  std::uint16_t id{};      ///< Never 0 in a file.
  std::string name{};      ///< Name of the message's type, "adit::radio::Command".
  std::string encoding{};  ///< Always "omgidl".
  std::string text{};      ///< The type and all types that it needs.
};

/// A topic of a recording.
struct Channel {
  std::uint16_t id{};
  std::uint16_t schema{};  ///< 0: none.
  std::string topic{};
  std::string encoding{};  ///< Encoding of the messages: "cdr".
  Text metadata{};
};

/// One recorded message.
struct Message {
  std::uint16_t channel{};
  std::uint32_t sequence{};  ///< Sequence number within the channel.
  std::uint64_t time{};      ///< Time of recording, ns.
  ByteSpan data{};           ///< Valid only during the reader's call.
};

}  // namespace adit::record
