// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo_file.hpp"

#include <algorithm>
#include <charconv>

#include "core/findings/photo.hpp"
#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::findings {
namespace {

constexpr store::StateFormat kPhotoFormat{{'P', 'H', 'O', 'T'}, 1, kMaxPhotoFile};
constexpr std::string_view kPhotoPrefix = "photo-", kPartSuffix = ".part";
constexpr std::size_t kDigits = 16;
enum class Record : std::uint8_t { head = 1, thumbnail = 2, picture = 3 };

store::Bytes sealed(store::Packer& out) {
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

bool is_ref(const PhotoRef& ref) { return valid(ref) && ref.thumbnail > 0; }

void append_blocks(store::Bytes& out, PhotoPart part, const BlockBuffer& buffer) {
  for (std::size_t i = 0; i < buffer.blocks(); ++i) {
    const auto block = buffer.block(i);
    if (!buffer.has(i, block.size())) continue;
    const store::Bytes record = photo_block_record(part, i, block);
    out.insert(out.end(), record.begin(), record.end());
  }
}

bool read_block(store::Unpacker& in, BlockBuffer& buffer) {
  const auto first = in.get<std::uint16_t>();
  const auto data = in.bytes(kPhotoBlock);
  return in.good() && buffer.add(first, data);
}

}  // namespace

bool BlockBuffer::add(std::size_t first, std::span<const std::uint8_t> data) {
  const std::size_t begin = first * kPhotoBlock, end = begin + data.size();
  const bool whole_blocks = data.size() % kPhotoBlock == 0 || end == bytes_.size();
  if (data.empty() || begin >= bytes_.size() || end > bytes_.size() || !whole_blocks) return false;
  for (std::size_t i = 0; i < blocks_of(data.size()); ++i) {
    if (has_[first + i]) continue;
    const auto block = data.subspan(i * kPhotoBlock, std::min(kPhotoBlock, data.size() - i * kPhotoBlock));
    std::ranges::copy(block, bytes_.begin() + static_cast<std::ptrdiff_t>((first + i) * kPhotoBlock));
    has_[first + i] = true;
    --left_;
  }
  return true;
}

bool BlockBuffer::has(std::size_t first, std::size_t bytes) const {
  const std::size_t end = first + blocks_of(bytes);
  if (end > has_.size()) return false;
  for (std::size_t i = first; i < end; ++i)
    if (!has_[i]) return false;
  return true;
}

std::span<const std::uint8_t> BlockBuffer::block(std::size_t index) const {
  const std::size_t begin = index * kPhotoBlock;
  if (begin >= bytes_.size()) return {};
  return std::span(bytes_).subspan(begin, std::min(kPhotoBlock, bytes_.size() - begin));
}

store::Bytes to_photo_file(const StoredPhoto& photo, std::uint64_t order) {
  store::Packer out;
  out.put(photo.ref.content).put(photo.importance);
  for (const BlockBuffer* part : {&photo.thumbnail, &photo.picture})
    out.put(static_cast<std::uint32_t>(part->bytes().size())).raw(part->bytes());
  return store::encode_envelope(kPhotoFormat, order, out.bytes());
}

store::LoadStatus read_photo_file(std::span<const std::uint8_t> bytes, StoredPhoto& photo,
                                  std::uint64_t& order) {
  const store::State state = store::decode_envelope(kPhotoFormat, bytes);
  if (state.found != store::LoadStatus::good) return state.found;
  store::Unpacker in(state.payload);
  photo.ref.content = in.get<std::uint64_t>();
  photo.importance = in.get<std::uint8_t>();
  photo.ref.thumbnail = static_cast<std::uint16_t>(
      std::min<std::uint32_t>(in.get<std::uint32_t>(), PhotoRef::kMaxThumbnail + 1U));
  if (!in.good() || in.rest().size() < photo.ref.thumbnail) return store::LoadStatus::corrupt;
  const auto thumbnail = in.rest().first(photo.ref.thumbnail);
  store::Unpacker behind(in.rest().subspan(photo.ref.thumbnail));
  photo.ref.bytes = behind.get<std::uint32_t>();
  const auto picture = behind.rest();
  if (!behind.good() || !is_ref(photo.ref) || picture.size() != photo.ref.bytes ||
      photo_hash(picture) != photo.ref.content)
    return store::LoadStatus::corrupt;
  photo.thumbnail = BlockBuffer(store::Bytes(thumbnail.begin(), thumbnail.end()));
  photo.picture = BlockBuffer(store::Bytes(picture.begin(), picture.end()));
  order = state.generation;
  return store::LoadStatus::good;
}

store::Bytes photo_head_record(const StoredPhoto& photo) {
  store::Packer out;
  out.put(static_cast<std::uint8_t>(Record::head)).put(photo.ref.content).put(photo.ref.bytes);
  out.put(photo.ref.thumbnail).put(photo.importance);
  return sealed(out);
}

store::Bytes photo_block_record(PhotoPart part, std::size_t first, std::span<const std::uint8_t> data) {
  store::Bytes out;
  for (std::size_t at = 0; at < data.size(); at += kPhotoBlock, ++first) {
    const auto block = data.subspan(at, std::min(kPhotoBlock, data.size() - at));
    store::Packer record;
    record.put(static_cast<std::uint8_t>(part == PhotoPart::picture ? Record::picture : Record::thumbnail));
    record.put(static_cast<std::uint16_t>(first)).put(static_cast<std::uint16_t>(block.size())).raw(block);
    const store::Bytes bytes = sealed(record);
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  return out;
}

store::Bytes photo_records(const StoredPhoto& photo) {
  store::Bytes out = photo_head_record(photo);
  append_blocks(out, PhotoPart::thumbnail, photo.thumbnail);
  append_blocks(out, PhotoPart::picture, photo.picture);
  return out;
}

bool read_photo_records(std::span<const std::uint8_t> bytes, StoredPhoto& photo, bool& all) {
  bool headed = false;
  all = true;
  while (!bytes.empty()) {
    store::Unpacker in(bytes);
    const auto kind = static_cast<Record>(in.get<std::uint8_t>());
    StoredPhoto head;
    bool good = false;
    if (kind == Record::head && !headed) {
      head.ref = {in.get<std::uint64_t>(), in.get<std::uint32_t>(), in.get<std::uint16_t>()};
      head.importance = in.get<std::uint8_t>();
      good = in.good() && is_ref(head.ref);
    } else if (headed && (kind == Record::thumbnail || kind == Record::picture)) {
      (void)in.get<std::uint16_t>();
      (void)in.bytes(kPhotoBlock);
      good = in.good();
    }
    const std::size_t size = bytes.size() - in.rest().size();
    const auto content = bytes.first(good ? size : 0);
    if (!good || in.get<std::uint32_t>() != crc32c(content) || !in.good()) {
      all = false;
      return headed;
    }
    if (kind == Record::head) {
      head.thumbnail = BlockBuffer(head.ref.thumbnail);
      photo = std::move(head);
      headed = true;
    } else {
      store::Unpacker again(content.subspan(1));
      if (kind == Record::picture && photo.picture.blocks() == 0)
        photo.picture = BlockBuffer(photo.ref.bytes);
      if (!read_block(again, kind == Record::picture ? photo.picture : photo.thumbnail)) all = false;
    }
    bytes = bytes.subspan(size + sizeof(std::uint32_t));
  }
  return headed;
}

std::string photo_file_name(std::uint64_t content, bool complete) {
  return std::string(kPhotoPrefix) + id_text(content) + (complete ? "" : std::string(kPartSuffix));
}

bool is_photo_file(std::string_view name, std::uint64_t& content, bool& complete) {
  if (!name.starts_with(kPhotoPrefix)) return false;
  name.remove_prefix(kPhotoPrefix.size());
  complete = !name.ends_with(kPartSuffix);
  if (!complete) name.remove_suffix(kPartSuffix.size());
  if (name.size() != kDigits) return false;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), content, 16);
  return error == std::errc() && end == name.data() + name.size();
}

}  // namespace adit::findings
