// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/digest.hpp"

#include <bit>
#include <cstdio>
#include <cstring>

namespace adit::sim {

void Digest::add(std::uint64_t word) {
  a_ = (a_ ^ word) * 0xbf58476d1ce4e5b9ULL;
  a_ ^= a_ >> 29;
  b_ = (std::rotl(b_, 23) ^ word) * 0x94d049bb133111ebULL;
}

void Digest::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void Digest::add(std::string_view text) {
  add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void Digest::add(std::span<const std::uint8_t> bytes) {
  add(static_cast<std::uint64_t>(bytes.size()));
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    add(word);
  }
  if (i == bytes.size()) return;
  std::uint64_t rest = 0;
  std::memcpy(&rest, bytes.data() + i, bytes.size() - i);
  add(rest);
}

std::string Digest::text() const {
  const auto finish = [](std::uint64_t h) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    return h ^ (h >> 31);
  };
  char out[33];
  std::snprintf(out, sizeof out, "%016llx%016llx", static_cast<unsigned long long>(finish(a_ ^ (b_ >> 32))),
                static_cast<unsigned long long>(finish(b_ + a_)));
  return out;
}

}  // namespace adit::sim
