// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/stored_map.hpp"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/store/pack.hpp"
#include "perception/map/block_hash.hpp"

namespace adit::perception {
namespace {

constexpr int kStoredLevel = 3;
constexpr double kFarthest = 1e6;  // m
constexpr std::int32_t kFarthestBlock = 1'000'000'000;

std::vector<std::uint8_t> packed_for_disk(const store::Packer& content) {
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

void write_pose(store::Packer& to, const Pose3& pose) {
  for (int axis = 0; axis < 3; ++axis) to.put(pose.position[axis]);
  const Eigen::Quaterniond& q = pose.orientation;
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) to.put(part);
}

bool read_pose(store::Unpacker& from, Pose3& pose) {
  for (int axis = 0; axis < 3; ++axis) pose.position[axis] = from.number();
  const double w = from.number(), x = from.number(), y = from.number(), z = from.number();
  const Eigen::Quaterniond q(w, x, y, z);
  if (!pose.position.allFinite() || pose.position.cwiseAbs().maxCoeff() > kFarthest ||
      !q.coeffs().allFinite() || std::abs(q.norm() - 1.0) > 1e-3)
    return false;
  pose.orientation = q.normalized();
  return true;
}

void write_submap_key(store::Packer& to, const SubmapKey& key) {
  to.text<std::uint8_t>(std::string_view(key.robot).substr(0, kMaxRobotName)).put(key.start).put(key.index);
}

bool read_submap_key(store::Unpacker& from, SubmapKey& key) {
  key.robot = from.text<std::uint8_t>(kMaxRobotName);
  key.start = from.get<std::uint64_t>();
  key.index = from.get<std::uint32_t>();
  return !key.robot.empty();
}

bool read_index(store::Unpacker& from, BlockIndex& last, bool bounded) {
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

void write_index(store::Packer& to, const BlockIndex& index, const BlockIndex& last) {
  to.zigzag(std::int64_t{index.x} - last.x);
  to.zigzag(std::int64_t{index.y} - last.y);
  to.zigzag(std::int64_t{index.z} - last.z);
}

Error wrong(const char* what) { return {Reason::malformed, std::string("its ") + what + " makes no sense"}; }

}  // namespace

std::vector<std::uint8_t> encode_stored(const StoredSubmap& submap) {
  store::Packer out;
  write_submap_key(out, submap.key);
  write_pose(out, submap.T_map_submap);
  out.flag(submap.placed).put(submap.pose_revision).put(submap.odom_epoch);
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
  for (std::size_t i = 0; i < count; ++i) out.put(submap.blocks[i].block.known);
  for (std::size_t i = 0; i < count; ++i) out.put(submap.blocks[i].block.occupied);
  return packed_for_disk(out);
}

Result<StoredSubmap> decode_stored_submap(std::span<const std::uint8_t> bytes) {
  const auto content = unpacked_from_disk(bytes);
  if (!content) return content.error();
  store::Unpacker from(*content);
  StoredSubmap out;
  if (!read_submap_key(from, out.key)) return wrong("name");
  if (!read_pose(from, out.T_map_submap)) return wrong("pose");
  const auto placed = from.get<std::uint8_t>();
  out.placed = placed == 1;
  out.pose_revision = from.get<std::uint32_t>();
  out.odom_epoch = from.get<std::uint32_t>();
  if (placed > 1 || !read_index(from, out.offset, false)) return wrong("place");
  for (const std::int32_t part : {out.offset.x, out.offset.y, out.offset.z})
    if (part > kFarthestBlock || part < -kFarthestBlock) return wrong("place");
  const std::uint64_t count = from.varint();
  // Each block takes at least 20 bytes, so that a count that is too large allocates nothing.
  if (!from.good() || count > kMaxStoredBlocks || count * 20 > content->size()) return wrong("length");
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
  for (BlockUpdate& update : out.blocks) update.block.known = from.get<std::uint64_t>();
  for (BlockUpdate& update : out.blocks) {
    update.block.occupied = from.get<std::uint64_t>();
    if ((update.block.occupied & ~update.block.known) != 0) return wrong("list of voxels");
  }
  if (!from.done()) return wrong("length");
  return out;
}

std::vector<std::uint8_t> encode_stored(const StoredPlaces& places) {
  store::Packer out;
  const std::size_t count = std::min(places.poses.size(), kMaxStoredSubmaps);
  out.varint(count);
  for (std::size_t i = 0; i < count; ++i) {
    write_submap_key(out, places.poses[i].key);
    write_pose(out, places.poses[i].T_map_submap);
    out.put(places.poses[i].revision);
  }
  const std::size_t peers = std::min(places.peers.size(), kMaxStoredPeers);
  out.varint(peers);
  for (std::size_t i = 0; i < peers; ++i) {
    const StoredPlaces::Peer& peer = places.peers[i];
    out.put(peer.id).put(peer.start).varint(peer.has.size());
    for (const std::uint32_t position : peer.has) out.varint(position);
  }
  return packed_for_disk(out);
}

Result<StoredPlaces> decode_stored_places(std::span<const std::uint8_t> bytes) {
  const auto content = unpacked_from_disk(bytes);
  if (!content) return content.error();
  store::Unpacker from(*content);
  StoredPlaces out;
  const std::uint64_t count = from.varint();
  if (count > kMaxStoredSubmaps) return wrong("length");
  for (std::uint64_t i = 0; i < count; ++i) {
    SubmapPose pose;
    if (!read_submap_key(from, pose.key) || !read_pose(from, pose.T_map_submap))
      return wrong("list of poses");
    pose.revision = from.get<std::uint32_t>();
    out.poses.push_back(std::move(pose));
  }
  const std::uint64_t peers = from.varint();
  if (peers > kMaxStoredPeers) return wrong("list of stations");
  for (std::uint64_t i = 0; i < peers; ++i) {
    StoredPlaces::Peer peer;
    peer.id = from.array<16>();
    peer.start = from.get<std::uint32_t>();
    const std::uint64_t has = from.varint();
    if (!from.good() || has > count) return wrong("list of stations");
    for (std::uint64_t n = 0; n < has; ++n) {
      const std::uint64_t position = from.varint();
      if (position >= count) return wrong("list of stations");
      peer.has.push_back(static_cast<std::uint32_t>(position));
    }
    out.peers.push_back(std::move(peer));
  }
  if (!from.done()) return wrong("length");
  return out;
}

}  // namespace adit::perception
