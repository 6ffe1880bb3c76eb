// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

namespace adit::wire {

/// Returns the first member of a serialised sample (plain CDR, encapsulation header first) when that member
/// is a string; it is the key of every keyed topic. Returns nothing when the bytes are too short or hold
/// another type.
inline std::optional<std::string_view> first_string(std::span<const std::uint8_t> cdr) {
  if (cdr.size() < 8 || cdr[0] != 0 || cdr[1] > 1) return std::nullopt;
  std::uint32_t length{};
  if (cdr[1] == 1) {
    length = cdr[4] | cdr[5] << 8 | cdr[6] << 16 | static_cast<std::uint32_t>(cdr[7]) << 24;
  } else {
    length = cdr[7] | cdr[6] << 8 | cdr[5] << 16 | static_cast<std::uint32_t>(cdr[4]) << 24;
  }
  if (length > cdr.size() - 8) return std::nullopt;
  const char* text = reinterpret_cast<const char*>(cdr.data()) + 8;
  if (length > 0 && text[length - 1] == '\0') --length;  // The terminator is part of the serialised string.
  return std::string_view(text, length);
}

/// Hash of a key (FNV-1a); equal keys have equal hashes.
inline std::uint64_t key_number(std::string_view key) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : key) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace adit::wire
