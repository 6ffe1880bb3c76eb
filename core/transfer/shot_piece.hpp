// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::transfer {

/// Bytes of a block of a single picture; the last one may be shorter.
inline constexpr std::size_t kShotBlock = 256;

/// Some blocks of a single picture of a camera, on their way to the station that asked for it.
struct ShotPiece {
  static constexpr std::uint32_t kMaxPicture = 512 * 1024;  ///< Of a whole picture, bytes.

  std::string camera{};    ///< A valid name.
  std::uint32_t number{};  ///< As the station asked for it.
  std::uint64_t stamp{};   ///< Exposure by the driver's clock, ns; 0: unknown.
  std::uint32_t age{};     ///< Time from the exposure to the coding, ms.
  std::optional<std::array<float, 4>>
      place{};                       ///< Of the robot at the exposure: x y z yaw, map frame, m, rad.
  std::uint32_t bytes{};             ///< Of the whole picture, [1, kMaxPicture].
  std::uint32_t crc{};               ///< CRC-32C of the whole picture.
  std::uint16_t first{};             ///< Its first block.
  std::vector<std::uint8_t> data{};  ///< One block or more.
  bool operator==(const ShotPiece&) const = default;

  /// Encoded bytes beside `data`.
  std::size_t head() const { return 33 + camera.size() + (place ? 16 : 0); }
};

std::vector<std::uint8_t> encode(const ShotPiece& piece);
/// Errors: wrong_protocol (another version), malformed (truncated, too long, damaged, blocks that are not
/// whole or lie outside the picture, no valid name, a place that is none).
Result<ShotPiece> decode_shot_piece(std::span<const std::uint8_t> bytes);

}  // namespace adit::transfer
