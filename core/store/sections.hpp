// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/store/disk.hpp"

namespace adit::store {

/// Names one kind of section, for example {'S', 'T', 'O', 'P'}.
using SectionTag = std::array<char, 4>;

/// A tagged part of a file, with a checksum of its own.
struct Section {
  SectionTag tag{};
  std::uint16_t version{1};  ///< Version of the payload's layout.
  Bytes payload{};
  bool operator==(const Section&) const = default;
};

/// Result of reading a packed list of sections.
struct SectionList {
  bool readable{};                 ///< False: both directories are damaged, nothing is known of the content.
  std::vector<Section> good{};     ///< In the order in which they were packed.
  std::vector<Section> damaged{};  ///< Listed in the directory, but their bytes do not match: payload empty
};

/// Bounds the number of sections in one list.
inline constexpr std::size_t kMaxSections = 64;

/// Packs sections so that damage to some bytes loses only the sections that contain them.
///
/// Layout, little endian: directory | the same directory again | each payload followed by its checksum.
/// Directory: u16 1 (layout), u16 count, count times {tag, u16 version, u32 bytes}, u32 CRC-32C. The checksum
/// of a payload covers its position, tag and version, too. Sections beyond `kMaxSections` are left out.
Bytes pack_sections(std::span<const Section> sections);

/// Unpacks sections; errors appear only in the result. Allocates at most the length of its input.
SectionList unpack_sections(std::span<const std::uint8_t> bytes);

/// Returns the tag as text, with '?' for characters that are not printable.
std::string tag_text(const SectionTag& tag);

}  // namespace adit::store
