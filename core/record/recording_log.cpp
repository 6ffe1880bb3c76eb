// SPDX-License-Identifier: Apache-2.0
#include "core/record/recording_log.hpp"

#include <algorithm>

namespace adit::record {
namespace {

constexpr std::size_t kLongestText = 4096;

std::int32_t foxglove_level(LogLevel level) {
  switch (level) {
    case LogLevel::trace:
    case LogLevel::debug:
      return 1;
    case LogLevel::info:
      return 2;
    case LogLevel::warn:
      return 3;
    case LogLevel::error:
      return 4;
    case LogLevel::off:
      break;
  }
  return 0;
}

/// CDR encoder with alignment to four bytes after the encapsulation header, which suffices for every member
/// here.
class Cdr {
 public:
  Cdr() { McapPacker(out).bytes(std::array<std::uint8_t, 4>{0, 1, 0, 0}); }
  template <class Integer>
  void put(Integer value) {
    McapPacker(out).put(value);
  }
  void text(std::string_view value) {
    McapPacker pack(out);
    pack.put(static_cast<std::uint32_t>(value.size() + 1));
    pack.bytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
    do out.push_back(0);  // The terminator of the string, and padding up to the next member.
    while (out.size() % 4 != 0);
  }
  std::vector<std::uint8_t> out{};
};

}  // namespace

RecordingLog::RecordingLog(std::shared_ptr<LogSink> inner, RecordSink& sink)
    : LogSink(inner->level()),
      inner_(std::move(inner)),
      sink_(sink),
      channel_(sink.channel({"log", kLogType, {{"direction", "own"}}})) {}

void RecordingLog::write(const LogLine& line) {
  inner_->write(line);
  const auto ns = line.has_time ? line.time.time_since_epoch().count() : 0;
  Cdr cdr;
  cdr.put(static_cast<std::uint32_t>(ns / 1'000'000'000));
  cdr.put(static_cast<std::uint32_t>(ns % 1'000'000'000));
  cdr.put(foxglove_level(line.level));
  cdr.text(line.text.substr(0, kLongestText));
  cdr.text(line.component.substr(0, kLongestText));
  cdr.text("");
  cdr.put(std::uint32_t{0});
  sink_.record(channel_, cdr.out);
}

}  // namespace adit::record
