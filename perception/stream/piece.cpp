// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/piece.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "perception/map/block_hash.hpp"
#include "perception/stream/byte_stream.hpp"

namespace adit::perception {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kBlocks = 1, kPoses = 2;
constexpr std::size_t kHeader = 2;  ///< Version and kind.
constexpr int kLevel = 3;           ///< Higher levels gain less than 1 % on a piece.
constexpr double kPositionUnit = 1e-4, kQuaternionUnit = 1e-7;
constexpr double kMaxPosition = 1e5;  ///< m

/// What the masks of a block are like.
enum Shape : std::uint8_t { known_throughout = 1, nothing_occupied = 2 };

/// Bits by columns, z within y within x: columns of walls make equal bytes.
std::uint64_t by_columns(std::uint64_t mask) {
  std::uint64_t out = 0;
  for (int i = 0; i < 64; ++i) out |= (mask >> i & 1) << ((i >> 4) | (i & 3) << 4 | (i >> 2 & 3) << 2);
  return out;
}

// The same exchange of the axes x and z leads back.
std::uint64_t by_layers(std::uint64_t columns) { return by_columns(columns); }

void write_key(ByteWriter& to, const SubmapKey& key) {
  to.text(std::string_view(key.robot).substr(0, kMaxRobotName));
  to.u64(key.start);
}

bool read_name(ByteReader& from, SubmapKey& key) {
  key.robot = from.text();
  key.start = from.u64();
  return !key.robot.empty() && key.robot.size() <= kMaxRobotName;
}

/// Four streams of bytes one after the other: each compresses best among its like.
std::vector<std::uint8_t> content_of(const SubmapKey& key, std::span<const BlockUpdate> blocks) {
  ByteWriter head, shapes, known, occupied;
  write_key(head, key);
  head.varint(key.index);
  head.u8(static_cast<std::uint8_t>(blocks.size()));
  BlockIndex before{};
  std::int64_t revision = 0;
  for (const BlockUpdate& update : blocks) {
    const CoarseBlock& b = update.block;
    head.zigzag(b.index.x - before.x);
    head.zigzag(b.index.y - before.y);
    head.zigzag(b.index.z - before.z);
    head.zigzag(static_cast<std::int64_t>(update.revision) - revision);
    before = b.index;
    revision = update.revision;
    const std::uint8_t shape = static_cast<std::uint8_t>(
        (b.known == ~std::uint64_t{0} ? known_throughout : 0) | (b.occupied == 0 ? nothing_occupied : 0));
    shapes.u8(shape);
    if ((shape & known_throughout) == 0) known.u64(by_columns(b.known));
    if ((shape & nothing_occupied) == 0) occupied.u64(by_columns(b.occupied));
  }
  std::vector<std::uint8_t> out = head.bytes();
  for (const ByteWriter* part : {&shapes, &known, &occupied})
    out.insert(out.end(), part->bytes().begin(), part->bytes().end());
  return out;
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

}  // namespace

std::vector<std::uint8_t> encode(const MapPiece& piece) {
  const std::span<const BlockUpdate> blocks(piece.blocks);
  return compress(kBlocks, content_of(piece.key, blocks.first(std::min(blocks.size(), kMaxPieceBlocks))));
}

Result<MapPiece> decode(std::span<const std::uint8_t> bytes) {
  const auto content = unpack(kBlocks, bytes);
  if (!content) return content.error();
  ByteReader from(*content);
  MapPiece piece;
  if (!read_name(from, piece.key)) return malformed("the robot's name");
  const std::uint64_t index = from.varint();
  const std::size_t count = from.u8();
  if (index > 0xffffffffu || count > kMaxPieceBlocks) return malformed("too many blocks");
  piece.key.index = static_cast<std::uint32_t>(index);
  std::array<std::int64_t, 4> last{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::int64_t& value : last) {
      const std::int64_t difference = from.zigzag();
      if (std::abs(difference / 2) > 0xffffffff) return malformed("an index");
      value += difference;
    }
    if (std::any_of(last.begin(), last.begin() + 3,
                    [](std::int64_t v) { return std::abs(v) >= BlockIndex::kLimit; }) ||
        last[3] < 0 || last[3] > 0xffffffff)
      return malformed("a block's index or revision");
    BlockUpdate update;
    update.block.index = {static_cast<std::int32_t>(last[0]), static_cast<std::int32_t>(last[1]),
                          static_cast<std::int32_t>(last[2])};
    update.revision = static_cast<std::uint32_t>(last[3]);
    piece.blocks.push_back(update);
  }
  std::array<std::uint8_t, kMaxPieceBlocks> shapes{};
  for (std::size_t i = 0; i < count; ++i) {
    shapes[i] = from.u8();
    if (shapes[i] > (known_throughout | nothing_occupied)) return malformed("a block's shape");
  }
  for (std::size_t i = 0; i < count; ++i)
    piece.blocks[i].block.known =
        (shapes[i] & known_throughout) != 0 ? ~std::uint64_t{0} : by_layers(from.u64());
  for (std::size_t i = 0; i < count; ++i) {
    CoarseBlock& block = piece.blocks[i].block;
    if ((shapes[i] & nothing_occupied) == 0) block.occupied = by_layers(from.u64());
    if ((block.occupied & ~block.known) != 0) return malformed("occupied voxels that are not known");
  }
  if (from.failed() || !from.at_end()) return malformed("its length");
  return piece;
}

PackedPiece pack(const SubmapKey& key, std::span<const BlockUpdate> blocks, std::size_t max_bytes) {
  blocks = blocks.first(std::min(blocks.size(), kMaxPieceBlocks));
  const auto packed = [&](std::size_t count) {
    return PackedPiece{compress(kBlocks, content_of(key, blocks.first(count))), count};
  };
  // Blocks take 8 to 20 bytes before compression and rarely half of that after it.
  const std::size_t first_guess =
      std::clamp<std::size_t>(max_bytes / 8, 1, std::max<std::size_t>(1, blocks.size()));
  PackedPiece best{};
  std::size_t count = std::min(first_guess, blocks.size());
  for (int attempt = 0; attempt < 3 && count > 0; ++attempt) {
    PackedPiece now = packed(count);
    const std::size_t size = now.bytes.size();
    const bool fits = size <= max_bytes;
    if (fits && now.count > best.count) best = std::move(now);
    if (fits && (count == blocks.size() || size * 20 >= max_bytes * 19 || attempt == 2)) break;
    // The next guess is a little short, as the first bytes of a piece are its own.
    std::size_t next = std::max<std::size_t>(1, count * max_bytes * 31 / (32 * size));
    if (!fits) next = std::min(next, count - 1);
    next = std::min(next, blocks.size());
    if (next <= best.count) break;
    count = next;
  }
  // What cannot be compressed takes at most 20 bytes and an index a block.
  for (count = std::min(blocks.size(), max_bytes / 40); best.count == 0 && count > 0; count /= 2) {
    PackedPiece now = packed(count);
    if (now.bytes.size() <= max_bytes) best = std::move(now);
  }
  return best;
}

std::vector<std::uint8_t> encode(const SubmapPoses& poses) {
  const std::span<const SubmapPose> sent =
      std::span(poses.poses).first(std::min(poses.poses.size(), kMaxPiecePoses));
  ByteWriter out;
  out.u8(static_cast<std::uint8_t>(sent.size()));
  const SubmapPose* before = nullptr;
  for (const SubmapPose& pose : sent) {
    const bool same =
        before != nullptr && before->key.robot == pose.key.robot && before->key.start == pose.key.start;
    out.u8(same ? 1 : 0);
    if (!same) write_key(out, pose.key);
    before = &pose;
    out.varint(pose.key.index);
    out.varint(pose.revision);
    for (int axis = 0; axis < 3; ++axis)
      out.zigzag(std::llround(std::clamp(pose.T_map_submap.position[axis], -kMaxPosition, kMaxPosition) /
                              kPositionUnit));
    Eigen::Quaterniond q = pose.T_map_submap.orientation.normalized();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    for (const double part : {q.x(), q.y(), q.z()}) out.zigzag(std::llround(part / kQuaternionUnit));
  }
  return compress(kPoses, out.bytes());
}

Result<SubmapPoses> decode_poses(std::span<const std::uint8_t> bytes) {
  const auto content = unpack(kPoses, bytes);
  if (!content) return content.error();
  ByteReader from(*content);
  SubmapPoses out;
  const std::size_t count = from.u8();
  if (count > kMaxPiecePoses) return malformed("too many poses");
  for (std::size_t i = 0; i < count; ++i) {
    SubmapPose pose;
    const std::uint8_t same = from.u8();
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
    if (from.failed()) return malformed("its length");
    out.poses.push_back(std::move(pose));
  }
  if (!from.at_end()) return malformed("its length");
  return out;
}

}  // namespace adit::perception
