// SPDX-License-Identifier: Apache-2.0
#include "core/record/mcap_writer.hpp"

#include <algorithm>

#include "core/record/compress.hpp"

namespace adit::record {
namespace {

void put_schema(McapPacker& pack, const Schema& schema) {
  pack.put(schema.id);
  pack.text(schema.name);
  pack.text(schema.encoding);
  pack.text(schema.text);
}

void put_channel(McapPacker& pack, const Channel& channel) {
  pack.put(channel.id);
  pack.put(channel.schema);
  pack.text(channel.topic);
  pack.text(channel.encoding);
  pack.map(channel.metadata);
}

/// Writes a record in place: opcode, then the length once it is known.
template <class Content>
void add_record(std::vector<std::uint8_t>& out, Opcode opcode, Content content) {
  McapPacker pack(out);
  pack.put(static_cast<std::uint8_t>(opcode));
  const std::size_t length_at = out.size();
  pack.put(std::uint64_t{0});
  content(pack);
  pack.overwrite(length_at, static_cast<std::uint64_t>(out.size() - length_at - 8));
}

}  // namespace

McapWriter::McapWriter(Output& out, McapWriterParams params) : out_(out), params_(std::move(params)) {
  (void)emit(kMcapMagic);  // An error is stored in state_.
  scratch_.clear();
  add_record(scratch_, Opcode::header, [&](McapPacker& pack) {
    pack.text("");  // Empty profile: the schemas describe everything.
    pack.text(params_.library);
  });
  (void)emit(scratch_);  // An error is stored in state_.
}

Result<void> McapWriter::emit(ByteSpan data) {
  if (!state_) return state_;
  state_ = out_.append(data);
  if (state_) {
    written_ += data.size();
    crc_ = crc32(data, crc_);
  }
  return state_;
}

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                     const std::string& text) {
  schemas_.push_back({static_cast<std::uint16_t>(schemas_.size() + 1), name, encoding, text});
  scratch_.clear();
  add_record(scratch_, Opcode::schema, [&](McapPacker& pack) { put_schema(pack, schemas_.back()); });
  (void)emit(scratch_);  // An error is stored in state_.
  return schemas_.back().id;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema, const std::string& topic,
                                      const std::string& encoding, const Text& metadata) {
  OwnChannel channel{
      {static_cast<std::uint16_t>(channels_.size()), schema, topic, encoding, metadata}, 0, {}};
  scratch_.clear();
  add_record(scratch_, Opcode::channel, [&](McapPacker& pack) { put_channel(pack, channel.info); });
  (void)emit(scratch_);  // An error is stored in state_.
  channels_.push_back(std::move(channel));
  return channels_.back().info.id;
}

Result<void> McapWriter::write(std::uint16_t channel, std::uint64_t time, ByteSpan data) {
  if (!state_) return state_;
  if (channel >= channels_.size())
    return {Reason::out_of_range, "no channel " + std::to_string(channel) + " in this recording"};
  OwnChannel& own = channels_[channel];
  if (chunk_.empty()) chunk_first_ = chunk_last_ = time;
  if (messages_ == 0) first_ = last_ = time;
  chunk_first_ = std::min(chunk_first_, time);
  chunk_last_ = std::max(chunk_last_, time);
  first_ = std::min(first_, time);
  last_ = std::max(last_, time);
  own.index.emplace_back(time, chunk_.size());
  add_record(chunk_, Opcode::message, [&](McapPacker& pack) {
    pack.put(channel);
    pack.put(static_cast<std::uint32_t>(own.messages));
    pack.put(time);  // Log time.
    pack.put(time);  // Publish time: ours, as clocks of other machines are not comparable.
    pack.bytes(data);
  });
  ++own.messages;
  ++messages_;
  return chunk_.size() >= params_.chunk_bytes ? flush() : state_;
}

Result<void> McapWriter::add_metadata(const std::string& name, const Text& entries) {
  scratch_.clear();
  add_record(scratch_, Opcode::metadata, [&](McapPacker& pack) {
    pack.text(name);
    pack.map(entries);
  });
  metadata_.push_back({name, written_, scratch_.size()});
  return emit(scratch_);
}

Result<void> McapWriter::flush() {
  if (!state_ || chunk_.empty()) return state_;
  ChunkIndex index;
  index.first = chunk_first_;
  index.last = chunk_last_;
  index.start = written_;
  index.uncompressed = chunk_.size();
  const bool packed = params_.compress && compress(chunk_, packed_);
  const ByteSpan records = packed ? ByteSpan(packed_) : ByteSpan(chunk_);
  index.compressed = records.size();
  index.compression = packed ? "zstd" : "";
  scratch_.clear();
  add_record(scratch_, Opcode::chunk, [&](McapPacker& pack) {
    pack.put(index.first);
    pack.put(index.last);
    pack.put(index.uncompressed);
    pack.put(crc32(chunk_));
    pack.text(index.compression);
    pack.put(index.compressed);
    pack.bytes(records);
  });
  index.length = scratch_.size();
  for (OwnChannel& channel : channels_) {
    if (channel.index.empty()) continue;
    index.indexes[channel.info.id] = index.start + scratch_.size();
    add_record(scratch_, Opcode::message_index, [&](McapPacker& pack) {
      pack.put(channel.info.id);
      pack.put(static_cast<std::uint32_t>(channel.index.size() * 16));
      for (const auto& [time, offset] : channel.index) pack.put(time), pack.put(offset);
    });
    channel.index.clear();
  }
  index.index_length = scratch_.size() - index.length;
  chunk_.clear();
  chunks_.push_back(std::move(index));
  return emit(scratch_);
}

std::vector<std::uint8_t> McapWriter::summary_records(std::uint64_t start,
                                                      std::uint64_t& offsets_start) const {
  std::vector<std::uint8_t> out;
  struct Group {
    Opcode opcode{};
    std::uint64_t start{}, length{};
  };
  std::vector<Group> groups;
  const auto group = [&](Opcode opcode, const auto& records) {
    const std::size_t before = out.size();
    records();
    if (out.size() > before) groups.push_back({opcode, start + before, out.size() - before});
  };
  group(Opcode::schema, [&] {
    for (const Schema& s : schemas_)
      add_record(out, Opcode::schema, [&](McapPacker& p) { put_schema(p, s); });
  });
  group(Opcode::channel, [&] {
    for (const OwnChannel& c : channels_)
      add_record(out, Opcode::channel, [&](McapPacker& p) { put_channel(p, c.info); });
  });
  group(Opcode::statistics, [&] {
    add_record(out, Opcode::statistics, [&](McapPacker& pack) {
      pack.put(messages_);
      pack.put(static_cast<std::uint16_t>(schemas_.size()));
      pack.put(static_cast<std::uint32_t>(channels_.size()));
      pack.put(std::uint32_t{0});  // Number of attachments.
      pack.put(static_cast<std::uint32_t>(metadata_.size()));
      pack.put(static_cast<std::uint32_t>(chunks_.size()));
      pack.put(first_);
      pack.put(last_);
      pack.put(static_cast<std::uint32_t>(channels_.size() * 10));
      for (const OwnChannel& c : channels_) pack.put(c.info.id), pack.put(c.messages);
    });
  });
  group(Opcode::chunk_index, [&] {
    for (const ChunkIndex& c : chunks_)
      add_record(out, Opcode::chunk_index, [&](McapPacker& pack) {
        for (const std::uint64_t value : {c.first, c.last, c.start, c.length}) pack.put(value);
        pack.put(static_cast<std::uint32_t>(c.indexes.size() * 10));
        for (const auto& [channel, offset] : c.indexes) pack.put(channel), pack.put(offset);
        pack.put(c.index_length);
        pack.text(c.compression);
        pack.put(c.compressed);
        pack.put(c.uncompressed);
      });
  });
  group(Opcode::metadata_index, [&] {
    for (const MetadataIndex& m : metadata_)
      add_record(out, Opcode::metadata_index, [&](McapPacker& pack) {
        pack.put(m.start);
        pack.put(m.length);
        pack.text(m.name);
      });
  });
  offsets_start = start + out.size();
  for (const Group& g : groups)
    add_record(out, Opcode::summary_offset, [&](McapPacker& pack) {
      pack.put(static_cast<std::uint8_t>(g.opcode));
      pack.put(g.start);
      pack.put(g.length);
    });
  return out;
}

Result<void> McapWriter::close() {
  if (closed_) return state_;
  closed_ = true;
  if (const auto flushed = flush(); !flushed) return flushed;
  std::vector<std::uint8_t> end;
  add_record(end, Opcode::data_end, [&](McapPacker& pack) { pack.put(crc_); });
  if (const auto ended = emit(end); !ended) return ended;
  const std::uint64_t start = written_;
  std::uint64_t offsets_start = 0;
  std::vector<std::uint8_t> tail = summary_records(start, offsets_start);
  McapPacker pack(tail);
  pack.put(static_cast<std::uint8_t>(Opcode::footer));
  pack.put(std::uint64_t{8 + 8 + 4});
  pack.put(start);
  pack.put(offsets_start);
  pack.put(crc32(tail));  // CRC of the summary and the footer up to here.
  pack.bytes(kMcapMagic);
  return emit(tail);
}

}  // namespace adit::record
