#pragma once
#include <functional>
#include <istream>
#include <string>

#include "core/record/mcap.hpp"
#include "core/result/result.hpp"

namespace adit::record {

/// Who is told what a recording holds, in the order of the file. Empty functions are not called.
struct Visitor {
  std::function<void(const Schema&)> schema{};
  std::function<void(const Channel&)> channel{};
  /// Only messages whose channel (and its schema, when it names one) was read.
  std::function<void(const Channel&, const Message&)> message{};
  std::function<void(const std::string& name, const Text&)> metadata{};
};

/// How well a recording could be read.
struct ReadReport {
  bool complete{};        ///< read to its footer, and nothing was wrong
  std::uint64_t bytes{};  ///< up to where it was read
  std::string trouble{};  ///< the first that was wrong, with its offset; empty: nothing
  std::uint64_t messages{}, chunks{};
  std::uint64_t bad_chunks{};        ///< left out: CRC, compression or content wrong
  std::uint64_t unknown_messages{};  ///< left out: of a channel that is not in the file
  std::uint64_t schemas{}, channels{};
  std::uint64_t first{}, last{};  ///< times of messages, ns
};

/// Reads a recording from its beginning, chunk by chunk. One that was torn off, or whose end is damaged, is
/// read up to there; a chunk that is damaged is left out. Memory: one record, never more than the file has
/// bytes, and one uncompressed chunk (at most 64 MB). Error syntax: it does not begin as an MCAP file.
Result<ReadReport> read_mcap(std::istream& in, const Visitor& visitor);

}  // namespace adit::record
