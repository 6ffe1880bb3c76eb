// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/contract/bulk.hpp"
#include "core/exec/executor.hpp"
#include "core/result/result.hpp"
#include "core/transfer/receiver.hpp"
#include "robot_agent/carry/carried_blocks.hpp"
#include "robot_agent/carry/carried_poses.hpp"
#include "robot_agent/carry/station_views.hpp"

namespace adit::agent {

/// Carries the maps of other robots to the stations: receives the map of a robot that hears no station, and
/// sends it on where a station is heard. In memory only: after a restart it has another id and nothing, so
/// that robots send it all again. Maps are carried once: what came from a carrier is not carried on. Runs on
/// the command strand, and has pieces decoded and encoded by `compute`.
class Carrier {
 public:
  static constexpr std::size_t kMaxDecoding = 32;  ///< Pieces that are decoded; further ones are dropped.

  /// `seed`: of the id, another one at each start. Sources must not be used after this.
  explicit Carrier(std::uint64_t seed, CarryBounds bounds = {});
  Carrier(const Carrier&) = delete;
  Carrier& operator=(const Carrier&) = delete;

  /// Decodes and encodes pieces by `compute` of this strand, and calls `ready` when a source has one. Without
  /// it, both are done at once.
  void compute_on(Executor& strand, Task ready);
  /// Takes a piece that another robot sent to the carriers; one that is decoded by `compute` is acknowledged
  /// or refused later, and at most kMaxDecoding are at once. Errors: malformed (also: of another robot's
  /// map), wrong_protocol (of another release), not_supported (no part of a map), out_of_range (changes of
  /// blocks that are not here in that state), queue_full (no room). What transfer::is_acknowledged says is
  /// acknowledged.
  Result<void> take(const contract::BulkPiece& piece, Time now);
  /// The receipts to send now, by robot, see transfer::Receiver::due. `bandwidth`: of the own link, bit/s.
  std::optional<std::vector<std::pair<std::string, transfer::Receipt>>> due(Time now, double bandwidth) {
    return receiver_.due(now, bandwidth);
  }
  /// The peer as which it acknowledges.
  const transfer::PeerId& id() const { return id_; }

  /// Its content for the sender to stations, in the order in which it goes.
  std::array<transfer::Source*, 2> sources() { return {&poses_, &blocks_}; }
  /// A station acknowledged something, after the sender took that.
  void heard(const transfer::Ack& ack, Time now);
  /// Says what the time is. Call it at 10 to 50 Hz.
  void tick(Time now);

  const CarriedBlocks& blocks() const { return blocks_; }
  /// Number of pieces that were refused.
  std::uint64_t refused() const { return refused_; }

 private:
  using Stored = std::function<void(const Result<void>&)>;
  using Bases = std::map<perception::BlockIndex, perception::CoarseBlock>;
  /// Decodes and stores a piece, and calls `done` then.
  void store(const contract::BulkPiece& piece, Stored done);
  /// `bases`: what is here of the blocks of which the piece has the changes; null: they are to be found out.
  void decode(const contract::BulkPiece& piece, std::shared_ptr<const Bases> bases, Stored done);
  Result<void> store_blocks(const Result<perception::MapPiece>& blocks, const std::string& robot);
  Result<void> store_poses(const contract::BulkPiece& piece);
  /// Acknowledges a piece, or counts that it was refused.
  void note(const contract::BulkPiece& piece, const Result<void>& stored, Time now);

  transfer::PeerId id_{};
  Time now_{};
  StationViews views_{};
  CarriedPoses poses_;
  CarriedBlocks blocks_;
  transfer::Receiver receiver_{};
  std::uint64_t refused_{};
  Executor* strand_{};  ///< Null: all is done at once.
  std::size_t decoding_{};
};

}  // namespace adit::agent
