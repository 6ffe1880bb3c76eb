// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/findings/finding.hpp"
#include "core/result/result.hpp"

namespace adit::findings {

/// Some of a robot's findings on their way to stations, usable alone.
struct FindingPiece {
  static constexpr std::size_t kMaxBytes = 1200;   ///< Largest encoded piece that is read.
  static constexpr std::size_t kMaxFindings = 24;  ///< In one piece.

  std::string robot{};         ///< The findings are all of this robot.
  std::uint32_t stored{};      ///< Findings that the robot stores.
  std::uint32_t overflowed{};  ///< Findings dropped or refused for lack of space, since its start.
  std::vector<Finding> findings{};
  Owner owner{};  ///< Of all of them; zero: a piece of version 1 or 2.
  bool operator==(const FindingPiece&) const = default;
};

/// Encodes a piece of 1 to kMaxFindings valid findings of its robot: version, robot, owner, stored,
/// overflowed, the findings, and a checksum (CRC-32C), so that a damaged piece is refused. Written as
/// version 3.
store::Bytes encode(const FindingPiece& piece);
/// Bytes of an encoded piece without its findings.
std::size_t encoded_head(const std::string& robot);
/// Bytes of one finding in a piece, at most 655: each finding fits alone into every piece.
std::size_t encoded_size(const Finding& finding);

/// Decodes a piece of version 1 (revisions are 0), 2 (no owner) or 3, from anyone. Reason::wrong_protocol for
/// another version, malformed for everything else that is wrong: truncated, damaged, too long, bytes behind
/// the end, a finding that is not valid.
Result<FindingPiece> decode_piece(std::span<const std::uint8_t> bytes);

}  // namespace adit::findings
