// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/map/block.hpp"
#include "perception/stream/block_set.hpp"
#include "perception/types/submap_key.hpp"

/// Content of the map for the radio, as bytes. Each piece can be decoded alone, or with what its receivers
/// acknowledged before; it is bounded, and has a checksum, so that a damaged piece is refused. Blocks are
/// coded as in block_coder.hpp, poses compressed with Zstandard. What is decoded comes from anyone: every
/// value is checked, and nothing larger than kMaxPieceBlocks blocks or kMaxPieceContent bytes is unpacked.
namespace adit::perception {

constexpr std::size_t kMaxPieceBytes = 1200;
constexpr std::size_t kMaxPieceBlocks = 512;
constexpr std::size_t kMaxPiecePoses = 40;
constexpr std::size_t kMaxRobotName = 32;
constexpr std::size_t kMaxPieceContent = 8192;  ///< Bytes of a piece, and of poses before compression.

/// A block, with the sender's revision of it.
///
/// Of a block that still changes, a sender gives voxels of 0.4 m only. They are for who has nothing finer of
/// it, as a piece goes to all stations, of which others may know more: they are stored under kCoarseRevision
/// and added to each other, so that any state in voxels of 0.2 m replaces them, in any order.
struct BlockUpdate {
  static constexpr std::uint32_t kCoarseRevision = 0;  ///< Of no block in voxels of 0.2 m.
  CoarseBlock block{};
  std::uint32_t revision{};
  bool coarse{};  ///< In voxels of 0.4 m, all eight parts of one the same.

  /// The revision under which it is stored.
  std::uint32_t stored_revision() const { return coarse ? kCoarseRevision : revision; }
  bool operator==(const BlockUpdate&) const = default;
};

/// Blocks of one submap, at most kMaxPieceBlocks.
struct MapPiece {
  SubmapKey key{};
  std::vector<BlockUpdate> blocks{};
};

/// What two states of a block in voxels of 0.4 m show together, in any order: what either shows occupied is.
inline CoarseBlock merged(const CoarseBlock& one, const CoarseBlock& other) {
  return {one.index, one.known | other.known, one.occupied | other.occupied};
}

/// Whether a state of a block is to be stored where one with these voxels and this revision is.
inline bool is_newer(std::uint64_t known, std::uint64_t occupied, std::uint32_t revision,
                     const BlockUpdate& update) {
  if (revision != BlockUpdate::kCoarseRevision || update.stored_revision() != revision)
    return update.stored_revision() > revision;
  return (update.block.known & ~known) != 0 || (update.block.occupied & ~occupied) != 0;
}

/// Place of a submap.
struct SubmapPose {
  SubmapKey key{};
  Pose3 T_map_submap{};  ///< Sent to 1 mm and 1e-5: 2 cm at 1 km from the submap.
  std::uint32_t revision{};
};

/// Places of at most kMaxPiecePoses submaps, which may be of several robots.
struct SubmapPoses {
  std::vector<SubmapPose> poses{};
};

/// Encodes a piece; blocks beyond kMaxPieceBlocks or BlockIndex::kLimit are left out, and older states of a
/// block that is there twice. May be longer than kMaxPieceBytes: see pack(). Equal revisions take no space.
/// `find_base`: an older state of a block in voxels of 0.2 m that all receivers have, see write_blocks().
std::vector<std::uint8_t> encode(const MapPiece& piece, const FindBase& find_base = {});
std::vector<std::uint8_t> encode(const SubmapPoses& poses);

/// What is here of a block of a submap; nothing: it is not here.
using FindStored = std::function<std::optional<CoarseBlock>(const SubmapKey&, const BlockIndex&)>;

/// Decodes a piece; its blocks are in rising order. Reason::wrong_protocol for another version, of the piece
/// or of the coder's tables, out_of_range for changes of blocks of which another state is here, malformed for
/// everything else that is wrong: other kind, damaged, too large, indices beyond BlockIndex::kLimit.
Result<MapPiece> decode(std::span<const std::uint8_t> bytes, const FindStored& find_stored = {});
Result<SubmapPoses> decode_poses(std::span<const std::uint8_t> bytes);

/// A piece in bytes.
struct PackedPiece {
  std::vector<std::uint8_t> bytes{};
  std::size_t count{};  ///< How many of the blocks are inside, the first ones.
};

/// Packs as many of the first blocks as fit into `max_bytes` (at least 100), within 5 % or so; they are
/// encoded two or three times for it. Blocks that are neighbours take least. `find_base`: see encode().
PackedPiece pack(const SubmapKey& key, std::span<const BlockUpdate> blocks, std::size_t max_bytes,
                 const FindBase& find_base = {});

/// Encodes as many of the first poses as fit into `max_bytes`, and erases the others from `poses`. Returns
/// nothing if not even one fits.
std::vector<std::uint8_t> pack(SubmapPoses& poses, std::size_t max_bytes);

}  // namespace adit::perception
