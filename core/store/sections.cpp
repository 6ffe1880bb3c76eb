// SPDX-License-Identifier: Apache-2.0
#include "core/store/sections.hpp"

#include <algorithm>
#include <optional>

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::store {
namespace {

constexpr std::uint16_t kLayout = 1;
constexpr std::size_t kDirectoryHeader = 4, kEntry = 10, kSectionChecksum = 4;

struct Entry {
  SectionTag tag{};
  std::uint16_t version{};
  std::uint32_t size{};
};

void put(Packer& out, const SectionTag& tag) {
  for (const char c : tag) out.put(static_cast<std::uint8_t>(c));
}

std::uint32_t checksum(std::size_t position, const SectionTag& tag, std::uint16_t version,
                       std::span<const std::uint8_t> payload) {
  Packer covered;
  covered.put(static_cast<std::uint16_t>(position));
  put(covered, tag);
  covered.put(version).raw(payload);
  return crc32c(covered.bytes());
}

Bytes directory(std::span<const Section> sections) {
  Packer out;
  out.put(kLayout).put(static_cast<std::uint16_t>(sections.size()));
  for (const Section& section : sections) {
    put(out, section.tag);
    out.put(section.version).put(static_cast<std::uint32_t>(section.payload.size()));
  }
  const std::uint32_t sum = crc32c(out.bytes());
  out.put(sum);
  return out.bytes();
}

/// Reads a directory of `count` entries at the front of `bytes`; returns nothing when it is damaged.
std::optional<std::vector<Entry>> read_directory(std::span<const std::uint8_t> bytes, std::size_t count) {
  const std::size_t size = kDirectoryHeader + count * kEntry;
  if (bytes.size() < size + kSectionChecksum) return std::nullopt;
  if (Unpacker(bytes.subspan(size)).get<std::uint32_t>() != crc32c(bytes.first(size))) return std::nullopt;
  Unpacker in(bytes.first(size));
  if (in.get<std::uint16_t>() != kLayout || in.get<std::uint16_t>() != count) return std::nullopt;
  std::vector<Entry> entries(count);
  for (Entry& entry : entries) {
    for (char& c : entry.tag) c = static_cast<char>(in.get<std::uint8_t>());
    entry.version = in.get<std::uint16_t>();
    entry.size = in.get<std::uint32_t>();
  }
  return entries;
}

/// Returns the first directory, else the second. When the stored count is wrong, each possible count is
/// tried, as the position of the second directory depends on it.
std::optional<std::vector<Entry>> find_directory(std::span<const std::uint8_t> bytes) {
  Unpacker in(bytes);
  (void)in.get<std::uint16_t>();
  const std::size_t written = in.get<std::uint16_t>();
  if (written <= kMaxSections)
    if (auto entries = read_directory(bytes, written)) return entries;
  for (std::size_t count = 0; count <= kMaxSections; ++count) {
    const std::size_t size = kDirectoryHeader + count * kEntry + kSectionChecksum;
    if (bytes.size() < size) break;
    if (auto entries = read_directory(bytes.subspan(size), count)) return entries;
  }
  return std::nullopt;
}

}  // namespace

Bytes pack_sections(std::span<const Section> sections) {
  sections = sections.first(std::min(sections.size(), kMaxSections));
  const Bytes list = directory(sections);
  Packer out;
  out.raw(list).raw(list);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Section& section = sections[i];
    out.raw(section.payload).put(checksum(i, section.tag, section.version, section.payload));
  }
  return out.bytes();
}

SectionList unpack_sections(std::span<const std::uint8_t> bytes) {
  const auto entries = find_directory(bytes);
  if (!entries) return {};
  SectionList list{true, {}, {}};
  bytes = bytes.subspan(
      std::min(bytes.size(), 2 * (kDirectoryHeader + entries->size() * kEntry + kSectionChecksum)));
  for (std::size_t i = 0; i < entries->size(); ++i) {
    const Entry& entry = (*entries)[i];
    Section section{entry.tag, entry.version, {}};
    const std::size_t length = std::size_t{entry.size} + kSectionChecksum;
    const auto part = bytes.first(std::min(bytes.size(), length));
    bytes = bytes.subspan(part.size());
    const bool good =
        part.size() == length && Unpacker(part.last(kSectionChecksum)).get<std::uint32_t>() ==
                                     checksum(i, entry.tag, entry.version, part.first(entry.size));
    if (good) section.payload.assign(part.begin(), part.end() - kSectionChecksum);
    (good ? list.good : list.damaged).push_back(std::move(section));
  }
  return list;
}

std::string tag_text(const SectionTag& tag) {
  std::string text(tag.begin(), tag.end());
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

}  // namespace adit::store
