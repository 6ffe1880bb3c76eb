// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <sstream>

#include "core/record/mcap_reader.hpp"
#include "core/record/mcap_writer.hpp"

namespace adit::record {

/// What a recording gave, as text: "1:/a 5 abc" for a message of schema id 1.
struct Heard {
  ReadReport report{};
  std::vector<std::string> messages{};
  std::map<std::string, Text> metadata{};
  std::map<std::uint16_t, Schema> schemas{};
  std::vector<Channel> channels{};
};

inline Result<Heard> hear(ByteSpan bytes) {
  Heard heard;
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  Visitor visitor;
  visitor.schema = [&](const Schema& s) { heard.schemas[s.id] = s; };
  visitor.channel = [&](const Channel& c) { heard.channels.push_back(c); };
  visitor.metadata = [&](const std::string& name, const Text& entries) { heard.metadata[name] = entries; };
  visitor.message = [&](const Channel& c, const Message& m) {
    heard.messages.push_back(std::to_string(c.schema) + ":" + c.topic + " " + std::to_string(m.time) + " " +
                             std::string(m.data.begin(), m.data.end()));
  };
  auto report = read_mcap(in, visitor);
  if (!report) return report.error();
  heard.report = *report;
  return heard;
}

inline ByteSpan bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Three chunks of two messages each, on two channels.
inline std::vector<std::uint8_t> small_file(bool compress, bool closed = true) {
  MemoryOutput out;
  McapWriter writer(out, {1 << 20, compress, "test"});
  (void)writer.add_metadata("about", {{"robot", "r1"}});
  const auto schema = writer.add_schema("x::Y", "omgidl", "module x { struct Y { long z; }; };");
  const auto a = writer.add_channel(schema, "/a", "cdr", {{"from", "r1"}});
  for (std::uint64_t i = 0; i < 2; ++i) {
    (void)writer.write(a, 10 * i, bytes_of("first " + std::string(40, 'x')));
    (void)writer.write(a, 10 * i + 1, bytes_of("second"));
    (void)writer.flush();
  }
  const auto b = writer.add_channel(0, "/b", "raw", {});
  (void)writer.write(b, 30, bytes_of("third"));
  (void)writer.write(a, 25, bytes_of(""));
  if (closed)
    (void)writer.close();
  else
    (void)writer.flush();
  return out.bytes;
}

}  // namespace adit::record
