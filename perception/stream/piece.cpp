// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/piece.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <tuple>

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"
#include "perception/map/block_hash.hpp"
#include "perception/stream/block_coder.hpp"
#include "perception/stream/block_context.hpp"

namespace adit::perception {
namespace {

constexpr std::uint8_t kVersion = 5;
constexpr std::uint8_t kBlocks = 1, kPoses = 2;
constexpr std::size_t kHeader = 2;  ///< Version, and kind with the version of the coder's tables above it.
constexpr std::size_t kBlocksHeader = 6;  ///< The same, and the checksum.
constexpr std::uint8_t kBlocksKind = kBlocks | ContextTrees::kVersion << 4;
constexpr int kLevel = 3;       ///< Higher levels of Zstandard gain less than 1 % on a piece.
constexpr int kVoxelLevel = 2;  // Of the voxels of 0.2 m.
constexpr double kPositionUnit = 1e-3, kQuaternionUnit = 1e-5;
constexpr double kMaxPosition = 1e5;  ///< m

void write_key(store::Packer& to, const SubmapKey& key) {
  to.text<std::uint8_t>(std::string_view(key.robot).substr(0, kMaxRobotName)).put(key.start);
}

bool read_name(store::Unpacker& from, SubmapKey& key) {
  key.robot = from.text<std::uint8_t>(kMaxRobotName);
  key.start = from.get<std::uint64_t>();
  return !key.robot.empty();
}

std::vector<std::uint8_t> compress(std::uint8_t kind, std::span<const std::uint8_t> content) {
  thread_local const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(),
                                                                                     ZSTD_freeCCtx);
  std::vector<std::uint8_t> out(kHeader + ZSTD_compressBound(content.size()));
  out[0] = kVersion;
  out[1] = kind;
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t size = ZSTD_compress2(context.get(), out.data() + kHeader, out.size() - kHeader,
                                          content.data(), content.size());
  out.resize(ZSTD_isError(size) != 0 ? 0 : kHeader + size);
  return out;
}

Result<std::vector<std::uint8_t>> unpack(std::uint8_t kind, std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= kHeader) return {Reason::malformed, "a piece of the map is too short"};
  if (bytes[0] != kVersion) return {Reason::wrong_protocol, "a piece of the map has another version"};
  if (bytes[1] != kind || bytes.size() > kMaxPieceContent)
    return {Reason::malformed, "a piece of the map is of another kind, or too long"};
  std::vector<std::uint8_t> content(kMaxPieceContent);
  const std::size_t size =
      ZSTD_decompress(content.data(), content.size(), bytes.data() + kHeader, bytes.size() - kHeader);
  if (ZSTD_isError(size) != 0) return {Reason::malformed, "a piece of the map is damaged"};
  content.resize(size);
  return content;
}

Error malformed(const char* what) { return {Reason::malformed, std::string("a piece of the map: ") + what}; }

/// CRC-32C of a piece, the checksum itself left out.
std::uint32_t checksum(std::span<const std::uint8_t> piece) {
  return crc32c(piece.subspan(kBlocksHeader), crc32c(piece.first(kHeader)));
}

/// Any number of 32 bits, after its length.
void write_wide(RangeEncoder& to, std::uint32_t value) {
  const int width = std::bit_width(value);
  to.bits(static_cast<std::uint32_t>(width), 6);
  to.bits(value, width);
}
std::uint32_t read_wide(RangeDecoder& from) {
  const auto width = static_cast<int>(from.bits(6));
  return from.bits(std::min(width, 32));
}

/// `bits`: if given, gets what each block took.
std::vector<std::uint8_t> encode_blocks(const SubmapKey& key, std::span<const BlockUpdate> blocks,
                                        const FindBase& find_base, std::vector<std::uint32_t>* bits) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (is_within_limit(blocks[i].block.index)) order.push_back(i);
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::tuple(blocks[a].block.index, blocks[b].revision) <
           std::tuple(blocks[b].block.index, blocks[a].revision);
  };
  std::sort(order.begin(), order.end(), less);
  // Of a block that is there twice, the newer state.
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::size_t a, std::size_t b) {
                            return blocks[a].block.index == blocks[b].block.index;
                          }),
              order.end());
  std::vector<CoarseBlock> sorted;
  std::vector<bool> coarse;
  std::uint32_t newest = 0, oldest = 0xffffffffu;
  for (const std::size_t i : order) {
    sorted.push_back(blocks[i].coarse ? in_large_voxels(blocks[i].block) : blocks[i].block);
    coarse.push_back(blocks[i].coarse);
    newest = std::max(newest, blocks[i].revision);
    oldest = std::min(oldest, blocks[i].revision);
  }
  RangeEncoder encoder;
  write_wide(encoder, key.index);
  write_wide(encoder, newest);
  const int width = order.empty() ? 0 : std::bit_width(newest - oldest);
  encoder.bits(static_cast<std::uint32_t>(width), 6);
  std::vector<std::uint32_t> taken;
  BlockSet set = block_set(std::span<const CoarseBlock>(sorted));
  set.coarse = std::move(coarse);
  write_blocks(encoder, set, find_base, bits != nullptr ? &taken : nullptr);
  for (const std::size_t i : order) encoder.bits(newest - blocks[i].revision, width);
  if (bits != nullptr) {
    bits->assign(blocks.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i)
      (*bits)[order[i]] = taken[i] + static_cast<std::uint32_t>(width);
  }
  store::Packer out;
  out.put(kVersion).put(kBlocksKind).put(std::uint32_t{0});
  write_key(out, key);
  std::vector<std::uint8_t> bytes = out.bytes();
  const std::vector<std::uint8_t> coded = encoder.finish();
  bytes.insert(bytes.end(), coded.begin(), coded.end());
  const std::uint32_t sum = checksum(bytes);
  for (int i = 0; i < 4; ++i)
    bytes[kHeader + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(sum >> 8 * i);
  return bytes;
}

constexpr int kPackAttempts = 4;

}  // namespace

std::vector<std::uint8_t> encode(const MapPiece& piece, const FindBase& find_base) {
  const std::span<const BlockUpdate> blocks(piece.blocks);
  return encode_blocks(piece.key, blocks.first(std::min(blocks.size(), kMaxPieceBlocks)), find_base, nullptr);
}

Result<MapPiece> decode(std::span<const std::uint8_t> bytes, const FindStored& find_stored) {
  if (bytes.size() <= kBlocksHeader) return {Reason::malformed, "a piece of the map is too short"};
  if (bytes[0] != kVersion) return {Reason::wrong_protocol, "a piece of the map has another version"};
  if ((bytes[1] & 0xf) != kBlocks || bytes.size() > kMaxPieceContent)
    return {Reason::malformed, "a piece of the map is of another kind, or too long"};
  if (bytes[1] != kBlocksKind)
    return {Reason::wrong_protocol, "a piece of the map was coded with other tables"};
  store::Unpacker from(bytes.subspan(kHeader));
  const auto sum = from.get<std::uint32_t>();
  if (sum != checksum(bytes)) return malformed("damaged");
  MapPiece piece;
  if (!read_name(from, piece.key) || !from.good()) return malformed("the robot's name");
  RangeDecoder decoder(from.rest());
  piece.key.index = read_wide(decoder);
  const std::uint32_t newest = read_wide(decoder);
  const int width = static_cast<int>(decoder.bits(6));
  if (width > 32) return malformed("its revisions");
  const auto find_base = [&](const BlockIndex& index) { return find_stored(piece.key, index); };
  const auto set = read_blocks(decoder, kVoxelLevel, find_stored ? FindBase(find_base) : FindBase());
  if (!set && set.reason() == Reason::out_of_range) return set.error();
  if (!set || set->level != kVoxelLevel) return malformed("its blocks");
  for (const CoarseBlock& block : coarse_blocks(*set)) {
    const std::uint32_t older = decoder.bits(width);
    if (older > newest) return malformed("a block's revision");
    const bool coarse = !set->coarse.empty() && set->coarse[piece.blocks.size()];
    piece.blocks.push_back({block, newest - older, coarse});
  }
  return piece;
}

PackedPiece pack(const SubmapKey& key, std::span<const BlockUpdate> blocks, std::size_t max_bytes,
                 const FindBase& find_base) {
  blocks = blocks.first(std::min(blocks.size(), kMaxPieceBlocks));
  PackedPiece best{};
  std::size_t too_many = blocks.size() + 1;
  // A block takes one to four bytes, rarely more.
  std::size_t count = std::min(blocks.size(), std::max<std::size_t>(1, max_bytes / 4));
  for (int attempt = 0; count > best.count && count < too_many; ++attempt) {
    std::vector<std::uint32_t> bits;
    std::vector<std::uint8_t> bytes = encode_blocks(key, blocks.first(count), find_base, &bits);
    const std::size_t size = bytes.size();
    if (size <= max_bytes) {
      best = {std::move(bytes), count};
      if (size * 20 >= max_bytes * 19 || attempt >= kPackAttempts) break;
      count = std::min(too_many - 1, count + std::max<std::size_t>(1, count * (max_bytes - size) / size));
    } else {
      too_many = count;
      if (attempt >= kPackAttempts) {
        if (best.count > 0) break;
        count /= 2;
        continue;
      }
      // What the blocks at the end took is to go, in proportion for what is no block's own.
      std::size_t all = 0;
      for (const std::uint32_t own : bits) all += own;
      const std::size_t goal = all * max_bytes / size * 63 / 64;
      while (count > 1 && all > goal) all -= bits[--count];
      count = std::max(count, best.count + 1);
    }
  }
  return best;
}

std::vector<std::uint8_t> encode(const SubmapPoses& poses) {
  const std::span<const SubmapPose> sent =
      std::span(poses.poses).first(std::min(poses.poses.size(), kMaxPiecePoses));
  store::Packer out;
  out.put(static_cast<std::uint8_t>(sent.size()));
  const SubmapPose* before = nullptr;
  for (const SubmapPose& pose : sent) {
    const bool same =
        before != nullptr && before->key.robot == pose.key.robot && before->key.start == pose.key.start;
    out.flag(same);
    if (!same) write_key(out, pose.key);
    before = &pose;
    out.varint(pose.key.index).varint(pose.revision);
    for (int axis = 0; axis < 3; ++axis)
      out.zigzag(std::llround(std::clamp(pose.T_map_submap.position[axis], -kMaxPosition, kMaxPosition) /
                              kPositionUnit));
    Eigen::Quaterniond q = pose.T_map_submap.orientation.normalized();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    for (const double part : {q.x(), q.y(), q.z()}) out.zigzag(std::llround(part / kQuaternionUnit));
  }
  return compress(kPoses, out.bytes());
}

std::vector<std::uint8_t> pack(SubmapPoses& poses, std::size_t max_bytes) {
  std::vector<std::uint8_t> bytes = encode(poses);
  while (bytes.size() > max_bytes && poses.poses.size() > 1) {
    // A few more attempts find how many fit.
    const std::size_t count = poses.poses.size();
    poses.poses.resize(std::max<std::size_t>(1, std::min(count - 1, count * max_bytes / bytes.size())));
    bytes = encode(poses);
  }
  if (bytes.size() > max_bytes) return {};
  return bytes;
}

Result<SubmapPoses> decode_poses(std::span<const std::uint8_t> bytes) {
  const auto content = unpack(kPoses, bytes);
  if (!content) return content.error();
  store::Unpacker from(*content);
  SubmapPoses out;
  const std::size_t count = from.get<std::uint8_t>();
  if (count > kMaxPiecePoses) return malformed("too many poses");
  for (std::size_t i = 0; i < count; ++i) {
    SubmapPose pose;
    const auto same = from.get<std::uint8_t>();
    if (same > 1 || (same == 1 && i == 0)) return malformed("a pose's submap");
    if (same == 1) {
      pose.key = out.poses.back().key;
    } else if (!read_name(from, pose.key)) {
      return malformed("the robot's name");
    }
    const std::uint64_t index = from.varint(), revision = from.varint();
    if (index > 0xffffffffu || revision > 0xffffffffu) return malformed("a pose's number");
    pose.key.index = static_cast<std::uint32_t>(index);
    pose.revision = static_cast<std::uint32_t>(revision);
    for (int axis = 0; axis < 3; ++axis)
      pose.T_map_submap.position[axis] = static_cast<double>(from.zigzag()) * kPositionUnit;
    Eigen::Vector3d q;
    for (double& part : q) part = static_cast<double>(from.zigzag()) * kQuaternionUnit;
    if (pose.T_map_submap.position.cwiseAbs().maxCoeff() > kMaxPosition || q.squaredNorm() > 1.0 + 1e-5)
      return malformed("a pose's values");
    pose.T_map_submap.orientation =
        Eigen::Quaterniond(std::sqrt(std::max(0.0, 1.0 - q.squaredNorm())), q.x(), q.y(), q.z()).normalized();
    if (!from.good()) return malformed("its length");
    out.poses.push_back(std::move(pose));
  }
  if (!from.done()) return malformed("its length");
  return out;
}

}  // namespace adit::perception
