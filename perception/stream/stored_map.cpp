// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/stored_map.hpp"

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>

#include "perception/map/block_hash.hpp"
#include "perception/stream/byte_stream.hpp"

namespace adit::perception {
namespace {

constexpr int kStoredLevel = 3;
constexpr double kFarthest = 1e6;  // m
constexpr std::int32_t kFarthestBlock = 1'000'000'000;

std::vector<std::uint8_t> packed_for_disk(const ByteWriter& content) {
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  std::vector<std::uint8_t> out(ZSTD_compressBound(content.bytes().size()));
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kStoredLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t size =
      ZSTD_compress2(context.get(), out.data(), out.size(), content.bytes().data(), content.bytes().size());
  out.resize(ZSTD_isError(size) != 0 ? 0 : size);
  return out;
}

Result<std::vector<std::uint8_t>> unpacked_from_disk(std::span<const std::uint8_t> bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > kMaxStoredBytes)
    return {Reason::malformed, "it is damaged"};
  std::vector<std::uint8_t> content(static_cast<std::size_t>(size));
  const std::size_t got = ZSTD_decompress(content.data(), content.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0 || got != content.size()) return {Reason::malformed, "it is damaged"};
  return content;
}

void write_number(ByteWriter& to, double value) { to.u64(std::bit_cast<std::uint64_t>(value)); }
double read_number(ByteReader& from) { return std::bit_cast<double>(from.u64()); }

void write_pose(ByteWriter& to, const Pose3& pose) {
  for (int axis = 0; axis < 3; ++axis) write_number(to, pose.position[axis]);
  const Eigen::Quaterniond& q = pose.orientation;
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) write_number(to, part);
}

bool read_pose(ByteReader& from, Pose3& pose) {
  for (int axis = 0; axis < 3; ++axis) pose.position[axis] = read_number(from);
  const double w = read_number(from), x = read_number(from), y = read_number(from), z = read_number(from);
  const Eigen::Quaterniond q(w, x, y, z);
  if (!pose.position.allFinite() || pose.position.cwiseAbs().maxCoeff() > kFarthest ||
      !q.coeffs().allFinite() || std::abs(q.norm() - 1.0) > 1e-3)
    return false;
  pose.orientation = q.normalized();
  return true;
}

void write_submap_key(ByteWriter& to, const SubmapKey& key) {
  to.text(std::string_view(key.robot).substr(0, kMaxRobotName));
  to.u64(key.start);
  to.u32(key.index);
}

bool read_submap_key(ByteReader& from, SubmapKey& key) {
  key.robot = from.text();
  key.start = from.u64();
  key.index = from.u32();
  return !key.robot.empty() && key.robot.size() <= kMaxRobotName;
}

bool read_index(ByteReader& from, BlockIndex& last, bool bounded) {
  std::array<std::int64_t, 3> part{last.x, last.y, last.z};
  for (std::int64_t& value : part) {
    const std::int64_t step = from.zigzag();
    if (step > INT32_MAX || step < INT32_MIN) return false;
    value += step;
    if (value > INT32_MAX || value < INT32_MIN) return false;
  }
  last = {static_cast<std::int32_t>(part[0]), static_cast<std::int32_t>(part[1]),
          static_cast<std::int32_t>(part[2])};
  return !bounded || is_within_limit(last);
}

void write_index(ByteWriter& to, const BlockIndex& index, const BlockIndex& last) {
  to.zigzag(std::int64_t{index.x} - last.x);
  to.zigzag(std::int64_t{index.y} - last.y);
  to.zigzag(std::int64_t{index.z} - last.z);
}

Error wrong(const char* what) { return {Reason::malformed, std::string("its ") + what + " makes no sense"}; }

}  // namespace

std::vector<std::uint8_t> encode_stored(const StoredSubmap& submap) {
  ByteWriter out;
  write_submap_key(out, submap.key);
  write_pose(out, submap.T_map_submap);
  out.u8(submap.placed ? 1 : 0);
  out.u32(submap.pose_revision);
  out.u32(submap.odom_epoch);
  write_index(out, submap.offset, {});
  const std::size_t count = std::min(submap.blocks.size(), kMaxStoredBlocks);
  out.varint(count);
  BlockIndex last{};
  std::int64_t revision = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const BlockUpdate& update = submap.blocks[i];
    write_index(out, update.block.index, last);
    out.zigzag(std::int64_t{update.revision} - revision);
    last = update.block.index;
    revision = update.revision;
  }
  for (std::size_t i = 0; i < count; ++i) out.u64(submap.blocks[i].block.known);
  for (std::size_t i = 0; i < count; ++i) out.u64(submap.blocks[i].block.occupied);
  return packed_for_disk(out);
}

Result<StoredSubmap> decode_stored_submap(std::span<const std::uint8_t> bytes) {
  const auto content = unpacked_from_disk(bytes);
  if (!content) return content.error();
  ByteReader from(*content);
  StoredSubmap out;
  if (!read_submap_key(from, out.key)) return wrong("name");
  if (!read_pose(from, out.T_map_submap)) return wrong("pose");
  const std::uint8_t placed = from.u8();
  out.placed = placed == 1;
  out.pose_revision = from.u32();
  out.odom_epoch = from.u32();
  if (placed > 1 || !read_index(from, out.offset, false)) return wrong("place");
  for (const std::int32_t part : {out.offset.x, out.offset.y, out.offset.z})
    if (part > kFarthestBlock || part < -kFarthestBlock) return wrong("place");
  const std::uint64_t count = from.varint();
  // Each block takes at least 20 bytes, so that a count that is too large allocates nothing.
  if (from.failed() || count > kMaxStoredBlocks || count * 20 > content->size()) return wrong("length");
  out.blocks.resize(static_cast<std::size_t>(count));
  BlockIndex last{};
  std::int64_t revision = 0;
  for (BlockUpdate& update : out.blocks) {
    const BlockIndex before = last;
    const bool first = &update == &out.blocks.front();
    if (!read_index(from, last, true) || (!first && !(before < last))) return wrong("list of blocks");
    const std::int64_t step = from.zigzag();
    if (step > UINT32_MAX || step < -std::int64_t{UINT32_MAX}) return wrong("list of blocks");
    revision += step;
    if (revision < 0 || revision > UINT32_MAX) return wrong("list of blocks");
    update.block.index = last;
    update.revision = static_cast<std::uint32_t>(revision);
  }
  for (BlockUpdate& update : out.blocks) update.block.known = from.u64();
  for (BlockUpdate& update : out.blocks) {
    update.block.occupied = from.u64();
    if ((update.block.occupied & ~update.block.known) != 0) return wrong("list of voxels");
  }
  if (from.failed() || !from.at_end()) return wrong("length");
  return out;
}

std::vector<std::uint8_t> encode_stored(const StoredPlaces& places) {
  ByteWriter out;
  const std::size_t count = std::min(places.poses.size(), kMaxStoredSubmaps);
  out.varint(count);
  for (std::size_t i = 0; i < count; ++i) {
    write_submap_key(out, places.poses[i].key);
    write_pose(out, places.poses[i].T_map_submap);
    out.u32(places.poses[i].revision);
  }
  const std::size_t peers = std::min(places.peers.size(), kMaxStoredPeers);
  out.varint(peers);
  for (std::size_t i = 0; i < peers; ++i) {
    const StoredPlaces::Peer& peer = places.peers[i];
    for (const std::uint8_t byte : peer.id) out.u8(byte);
    out.u32(peer.start);
    out.varint(peer.has.size());
    for (const std::uint32_t position : peer.has) out.varint(position);
  }
  return packed_for_disk(out);
}

Result<StoredPlaces> decode_stored_places(std::span<const std::uint8_t> bytes) {
  const auto content = unpacked_from_disk(bytes);
  if (!content) return content.error();
  ByteReader from(*content);
  StoredPlaces out;
  const std::uint64_t count = from.varint();
  if (count > kMaxStoredSubmaps) return wrong("length");
  for (std::uint64_t i = 0; i < count; ++i) {
    SubmapPose pose;
    if (!read_submap_key(from, pose.key) || !read_pose(from, pose.T_map_submap))
      return wrong("list of poses");
    pose.revision = from.u32();
    out.poses.push_back(std::move(pose));
  }
  const std::uint64_t peers = from.varint();
  if (peers > kMaxStoredPeers) return wrong("list of stations");
  for (std::uint64_t i = 0; i < peers; ++i) {
    StoredPlaces::Peer peer;
    for (std::uint8_t& byte : peer.id) byte = from.u8();
    peer.start = from.u32();
    const std::uint64_t has = from.varint();
    if (from.failed() || has > count) return wrong("list of stations");
    for (std::uint64_t n = 0; n < has; ++n) {
      const std::uint64_t position = from.varint();
      if (position >= count) return wrong("list of stations");
      peer.has.push_back(static_cast<std::uint32_t>(position));
    }
    out.peers.push_back(std::move(peer));
  }
  if (from.failed() || !from.at_end()) return wrong("length");
  return out;
}

}  // namespace adit::perception
