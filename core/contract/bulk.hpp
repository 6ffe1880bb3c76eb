// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/contract/common.hpp"
#include "core/transfer/piece.hpp"

namespace adit::radio {
class BulkPiece;
class BulkAck;
}  // namespace adit::radio

namespace adit::contract {

/// A piece of content that a robot sent to stations or carriers.
struct BulkPiece {
  std::string robot{};
  std::uint32_t session{}, id{};
  std::uint8_t kind{};               ///< Of transfer::Kind, or of a later release.
  std::uint32_t waiting{};           ///< As in transfer::Piece.
  std::vector<std::uint8_t> data{};  ///< At most transfer::kMaxPieceBytes.
  bool operator==(const BulkPiece&) const = default;
};

radio::BulkPiece encode(const BulkPiece& piece);
/// Returns nothing if the robot has no valid name, or if the piece is too large.
std::optional<BulkPiece> decode(const radio::BulkPiece& sample);

/// What arrived at a station or a carrier, of all robots.
struct BulkAck {
  static constexpr std::size_t kMaxReceipts = 16, kMaxDigests = 3;

  std::string station{};  ///< Of a carrier: the robot's name.
  Id station_id{};        ///< Of a carrier: drawn at each start.
  std::uint32_t start{};  ///< Of what the sender has on its disk; another one begins with nothing.
  std::vector<std::pair<std::string, transfer::Receipt>> receipts{};  ///< By robot.
  std::optional<transfer::Look> look{};                               ///< Place that the operator looks at.
  bool carrier{};      ///< The sender is a robot that carries maps.
  bool all_digests{};  ///< The sender has no other maps than those of `digests`.
  std::vector<transfer::ContentDigest> digests{};
  bool operator==(const BulkAck&) const = default;

  /// What it says to one robot: without a receipt for it, the sender has no piece of it.
  transfer::Ack to(const std::string& robot) const;
};

radio::BulkAck encode(const BulkAck& ack);
/// Returns nothing if the sender has no valid name. Receipts and digests of invalid names are left out, and
/// so is a place that cannot be one.
std::optional<BulkAck> decode(const radio::BulkAck& sample);

}  // namespace adit::contract
