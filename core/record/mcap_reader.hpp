// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <istream>
#include <string>

#include "core/record/mcap.hpp"
#include "core/result/result.hpp"

namespace adit::record {

/// Callbacks for the content of a recording, in the order of the file. Empty functions are not called.
struct Visitor {
  std::function<void(const Schema&)> schema{};
  std::function<void(const Channel&)> channel{};
  /// Called only for messages whose channel (and its schema, when it names one) was read.
  std::function<void(const Channel&, const Message&)> message{};
  std::function<void(const std::string& name, const Text&)> metadata{};
};

/// Result of reading a recording.
struct ReadReport {
  bool complete{};        ///< Read to its footer without an error.
  std::uint64_t bytes{};  ///< Bytes up to the end of what was read.
  std::string trouble{};  ///< The first error with its offset; empty: none.
  std::uint64_t messages{}, chunks{};
  std::uint64_t bad_chunks{};        ///< Skipped: CRC, compression or content wrong.
  std::uint64_t unknown_messages{};  ///< Skipped: their channel is not in the file.
  std::uint64_t schemas{}, channels{};
  std::uint64_t first{}, last{};  ///< Times of messages, ns.
};

/// Reads a recording from its beginning, chunk by chunk. A truncated file, or one whose end is damaged, is
/// read up to there; a damaged chunk is skipped. Memory: one record, never more than the size of the file,
/// and one uncompressed chunk (at most 64 MB). Error syntax: it does not begin as an MCAP file.
Result<ReadReport> read_mcap(std::istream& in, const Visitor& visitor);

}  // namespace adit::record
