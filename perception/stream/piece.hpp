// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/map/block.hpp"
#include "perception/types/submap_key.hpp"

/// Content of the map for the radio, as bytes. Each piece can be decoded alone, is bounded, and is compressed
/// with Zstandard and its checksum, so that a damaged piece is refused. What is decoded comes from anyone:
/// every value is checked, and nothing larger than kMaxContent bytes is unpacked.
namespace adit::perception {

constexpr std::size_t kMaxPieceBytes = 1200;
constexpr std::size_t kMaxPieceBlocks = 64;
constexpr std::size_t kMaxPiecePoses = 40;
constexpr std::size_t kMaxRobotName = 32;
constexpr std::size_t kMaxPieceContent = 8192;  ///< Bytes before compression.

/// A block, with the sender's revision of it.
struct BlockUpdate {
  CoarseBlock block{};
  std::uint32_t revision{};
  bool operator==(const BlockUpdate&) const = default;
};

/// Blocks of one submap, at most kMaxPieceBlocks.
struct MapPiece {
  SubmapKey key{};
  std::vector<BlockUpdate> blocks{};
};

/// Place of a submap.
struct SubmapPose {
  SubmapKey key{};
  Pose3 T_map_submap{};  ///< Sent to 0.1 mm and 1e-7.
  std::uint32_t revision{};
};

/// Places of at most kMaxPiecePoses submaps, which may be of several robots.
struct SubmapPoses {
  std::vector<SubmapPose> poses{};
};

/// Encodes a piece; blocks beyond kMaxPieceBlocks are left out. May be longer than kMaxPieceBytes: see
/// pack().
std::vector<std::uint8_t> encode(const MapPiece& piece);
std::vector<std::uint8_t> encode(const SubmapPoses& poses);

/// Decodes a piece. Reason::wrong_protocol for another version, malformed for everything else that is wrong:
/// other kind, damaged, too large, indices beyond BlockIndex::kLimit, occupied voxels that are not known.
Result<MapPiece> decode(std::span<const std::uint8_t> bytes);
Result<SubmapPoses> decode_poses(std::span<const std::uint8_t> bytes);

struct PackedPiece {
  std::vector<std::uint8_t> bytes{};
  std::size_t count{};  ///< How many of the blocks are inside, the first ones.
};

/// Packs as many of the first blocks as fit into `max_bytes` (at least 100), within 5 % or so, with at most
/// three compressions. Blocks that are neighbours and in order take least.
PackedPiece pack(const SubmapKey& key, std::span<const BlockUpdate> blocks, std::size_t max_bytes);

}  // namespace adit::perception
