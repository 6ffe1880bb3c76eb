// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "perception/stream/piece.hpp"

/// A robot's map as bytes for its disk. Compressed with Zstandard and its checksum; what is read is checked
/// as pieces from the radio are, and nothing larger than the bounds below is unpacked.
namespace adit::perception {

constexpr std::size_t kMaxStoredBlocks = std::size_t{1} << 17;
constexpr std::size_t kMaxStoredSubmaps = 4096;
constexpr std::size_t kMaxStoredPeers = 16;
constexpr std::size_t kMaxStoredBytes = std::size_t{4} << 20;  ///< Of one submap or one list of places.

/// One submap. Its blocks are ordered by index.
struct StoredSubmap {
  SubmapKey key{};
  Pose3 T_map_submap{};
  bool placed{};  ///< Whether the pose is known.
  std::uint32_t pose_revision{};
  std::uint32_t odom_epoch{};  ///< Submaps of one start and epoch lie in one lattice of blocks.
  BlockIndex offset{};         ///< Of its first block in that lattice.
  std::vector<BlockUpdate> blocks{};
};

/// Newest poses of all submaps, and which submaps stations have complete.
struct StoredPlaces {
  /// A station and the submaps that it has complete.
  struct Peer {
    std::array<std::uint8_t, 16> id{};
    std::uint32_t start{};             ///< Of the station's program: a new one has nothing.
    std::vector<std::uint32_t> has{};  ///< Positions in `poses`.
  };
  std::vector<SubmapPose> poses{};
  std::vector<Peer> peers{};
};

std::vector<std::uint8_t> encode_stored(const StoredSubmap& submap);
std::vector<std::uint8_t> encode_stored(const StoredPlaces& places);

/// Error: malformed.
Result<StoredSubmap> decode_stored_submap(std::span<const std::uint8_t> bytes);
Result<StoredPlaces> decode_stored_places(std::span<const std::uint8_t> bytes);

}  // namespace adit::perception
