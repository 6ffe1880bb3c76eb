// SPDX-License-Identifier: Apache-2.0
#include "core/record/mcap_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/record/compress.hpp"

namespace adit::record {
namespace {

constexpr std::uint64_t kLongestChunk = 64 << 20;

class Reading {
 public:
  Reading(std::istream& in, const Visitor& visitor) : in_(in), visitor_(visitor) {
    in_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(in_.tellg(), 0));
    in_.seekg(0);
  }

  Result<ReadReport> go() {
    std::vector<std::uint8_t> magic;
    if (!fetch(kMcapMagic.size(), magic) || !std::ranges::equal(magic, kMcapMagic))
      return Error{Reason::syntax, "this is no MCAP recording: it does not begin as one"};
    crc_ = crc32(magic);
    while (!ended_ && step()) report_.bytes = at_;
    report_.complete = ended_ && report_.trouble.empty();
    report_.schemas = schemas_.size();
    report_.channels = channels_.size();
    return report_;
  }

 private:
  /// Reads one record of the file; returns false when there is nothing more to read.
  bool step() {
    const std::uint64_t start = at_;
    if (!fetch(kRecordHead, head_)) return wrong(start, "torn off");
    McapUnpacker head(head_);
    const auto opcode = static_cast<Opcode>(head.get<std::uint8_t>());
    const auto length = head.get<std::uint64_t>();
    if (static_cast<std::uint8_t>(opcode) == 0) return wrong(start, "no record");
    if (length > size_ - at_) return wrong(start, "torn off");
    if (!fetch(length, record_)) return wrong(start, "cannot be read");
    switch (opcode) {
      case Opcode::data_end:
        return data_end(start);
      case Opcode::footer:
        return footer(start);
      case Opcode::chunk:
        chunk(start);
        break;
      default:
        plain(opcode, record_, start);
    }
    crc_ = crc32(record_, crc32(head_, crc_));
    if (in_summary_) summary_crc_ = crc32(record_, crc32(head_, summary_crc_));
    return true;
  }

  void plain(Opcode opcode, ByteSpan content, std::uint64_t start) {
    McapUnpacker unpack(content);
    if (opcode == Opcode::schema) {
      Schema s;
      s.id = unpack.get<std::uint16_t>();
      s.name = unpack.text();
      s.encoding = unpack.text();
      s.text = unpack.text();
      if (!unpack.ok() || s.id == 0) return (void)wrong(start, "broken schema");
      if (schemas_.insert(s.id).second && visitor_.schema) visitor_.schema(s);
    } else if (opcode == Opcode::channel) {
      Channel c;
      c.id = unpack.get<std::uint16_t>();
      c.schema = unpack.get<std::uint16_t>();
      c.topic = unpack.text();
      c.encoding = unpack.text();
      c.metadata = unpack.map();
      if (!unpack.ok()) return (void)wrong(start, "broken channel");
      const auto [it, fresh] = channels_.try_emplace(c.id, c);
      if (fresh && visitor_.channel) visitor_.channel(it->second);
    } else if (opcode == Opcode::message) {
      message(unpack, start);
    } else if (opcode == Opcode::metadata) {
      const std::string name = unpack.text();
      const Text entries = unpack.map();
      if (!unpack.ok()) return (void)wrong(start, "broken metadata");
      if (visitor_.metadata) visitor_.metadata(name, entries);
    }
    // Indexes, statistics and records of later versions are not needed for sequential reading.
  }

  void message(McapUnpacker& unpack, std::uint64_t start) {
    Message m;
    m.channel = unpack.get<std::uint16_t>();
    m.sequence = unpack.get<std::uint32_t>();
    m.time = unpack.get<std::uint64_t>();
    unpack.get<std::uint64_t>();  // Skips the publish time.
    if (!unpack.ok()) return (void)wrong(start, "broken message");
    m.data = unpack.take(unpack.left());
    const auto channel = channels_.find(m.channel);
    if (channel == channels_.end() ||
        (channel->second.schema != 0 && !schemas_.contains(channel->second.schema))) {
      ++report_.unknown_messages;
      return;
    }
    report_.first = report_.messages == 0 ? m.time : std::min(report_.first, m.time);
    report_.last = std::max(report_.last, m.time);
    ++report_.messages;
    if (visitor_.message) visitor_.message(channel->second, m);
  }

  void chunk(std::uint64_t start) {
    ++report_.chunks;
    const auto records = unpacked();
    if (!records || !is_complete(*records)) {
      ++report_.bad_chunks;
      wrong(start, "damaged chunk, left out");
      return;
    }
    each(*records, [&](Opcode opcode, ByteSpan content) { plain(opcode, content, start); });
  }

  std::optional<ByteSpan> unpacked() {
    McapUnpacker unpack(record_);
    unpack.take(16);  // Skips the times.
    const auto size = unpack.get<std::uint64_t>();
    const auto crc = unpack.get<std::uint32_t>();
    const std::string compression = unpack.text();
    const ByteSpan data = unpack.take(unpack.get<std::uint64_t>());
    if (!unpack.ok() || size > kLongestChunk) return std::nullopt;
    ByteSpan out = data;
    if (compression == "zstd") {
      if (!decompress(data, static_cast<std::size_t>(size), chunk_)) return std::nullopt;
      out = chunk_;
    } else if (!compression.empty()) {
      return std::nullopt;
    }
    if (out.size() != size || (crc != 0 && crc32(out) != crc)) return std::nullopt;
    return out;
  }

  /// Whether the bytes consist of complete records.
  static bool is_complete(ByteSpan records) {
    return each(records, [](Opcode, ByteSpan) {});
  }
  template <class F>
  static bool each(ByteSpan records, F&& visit) {
    McapUnpacker unpack(records);
    while (unpack.left() > 0) {
      const auto opcode = static_cast<Opcode>(unpack.get<std::uint8_t>());
      const ByteSpan content = unpack.take(unpack.get<std::uint64_t>());
      if (!unpack.ok()) return false;
      visit(opcode, content);
    }
    return true;
  }

  bool data_end(std::uint64_t start) {
    const auto crc = McapUnpacker(record_).get<std::uint32_t>();
    if (crc != 0 && crc != crc_) wrong(start, "the data's CRC does not fit");
    in_summary_ = true;
    return true;
  }

  bool footer(std::uint64_t start) {
    McapUnpacker unpack(record_);
    unpack.take(16);
    const auto crc = unpack.get<std::uint32_t>();
    if (!unpack.ok()) return wrong(start, "broken footer");
    const std::uint32_t own = crc32(ByteSpan(record_).first(16), crc32(head_, summary_crc_));
    if (crc != 0 && crc != own) wrong(start, "the summary's CRC does not fit");
    std::vector<std::uint8_t> magic;
    if (!fetch(kMcapMagic.size(), magic) || !std::ranges::equal(magic, kMcapMagic))
      return wrong(start, "torn off behind the footer");
    ended_ = true;
    return true;
  }

  bool fetch(std::uint64_t size, std::vector<std::uint8_t>& out) {
    if (size > size_ - at_) return false;
    out.resize(static_cast<std::size_t>(size));
    in_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
    if (!in_) return false;
    at_ += size;
    return true;
  }

  bool wrong(std::uint64_t where, const std::string& what) {
    if (report_.trouble.empty()) report_.trouble = what + ", at byte " + std::to_string(where);
    return false;
  }

  std::istream& in_;
  const Visitor& visitor_;
  ReadReport report_{};
  std::uint64_t size_{}, at_{};
  std::uint32_t crc_{}, summary_crc_{};
  bool in_summary_{}, ended_{};
  std::set<std::uint16_t> schemas_{};
  std::map<std::uint16_t, Channel> channels_{};
  std::vector<std::uint8_t> head_{}, record_{}, chunk_{};
};

}  // namespace

Result<ReadReport> read_mcap(std::istream& in, const Visitor& visitor) { return Reading(in, visitor).go(); }

}  // namespace adit::record
