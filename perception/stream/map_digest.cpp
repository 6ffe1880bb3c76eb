// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/map_digest.hpp"

namespace adit::perception {
namespace {

constexpr int kColumnBits = 3;  // A column is 8 x 8 blocks wide.

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014): each bit depends on all bits before.
std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31U);
}

std::uint64_t combined(std::uint64_t state, std::uint64_t value) {
  return mixed(state + 0x9e3779b97f4a7c15ULL + value);
}

std::uint64_t pair(std::int32_t high, std::int32_t low) {
  return std::uint64_t{static_cast<std::uint32_t>(high)} << 32U | static_cast<std::uint32_t>(low);
}

std::uint64_t hash_of(const SubmapKey& key) { return combined(combined(1, key.start), key.index); }

}  // namespace

std::size_t MapDigest::part_of(const BlockIndex& index) {
  return mixed(pair(index.x >> kColumnBits, index.y >> kColumnBits)) % kPoses;
}

std::uint32_t MapDigest::hash(const SubmapKey& key, const CoarseBlock& block) {
  std::uint64_t out = combined(hash_of(key), pair(block.index.x, block.index.y));
  out = combined(out, static_cast<std::uint32_t>(block.index.z));
  return static_cast<std::uint32_t>(combined(combined(out, block.known), block.occupied));
}

std::uint32_t MapDigest::hash(const SubmapKey& key, std::uint32_t pose_revision) {
  return static_cast<std::uint32_t>(combined(hash_of(key), pose_revision));
}

}  // namespace adit::perception
