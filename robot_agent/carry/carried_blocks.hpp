// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <compare>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/transfer/source.hpp"
#include "perception/stream/map_digest.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/piece_job.hpp"

namespace adit::agent {

/// Bounds of the maps that a robot carries.
struct CarryBounds {
  std::size_t max_robots{16};
  std::size_t max_submaps{1024};    ///< Of one robot.
  std::size_t max_blocks{200'000};  ///< Of all robots; each takes about 100 B.
  std::size_t slice{3000};          ///< Blocks that are looked at in one call, [1, 10^7].
};

/// Whether a station should get a robot's map from here now.
using WantsMap = std::function<bool(const transfer::PeerId& station, const std::string& robot)>;

/// The numbers of the peers of a carried source, one bit each.
class PeerSlots {
 public:
  static constexpr std::size_t kSlots = 16;
  static constexpr std::uint16_t bit(std::size_t slot) { return static_cast<std::uint16_t>(1U << slot); }

  /// Takes a slot; nothing: all are taken.
  std::optional<std::size_t> join(const transfer::PeerId& peer);
  void leave(const transfer::PeerId& peer) { slots_.erase(peer); }
  std::optional<std::size_t> find(const transfer::PeerId& peer) const;
  const std::map<transfer::PeerId, std::size_t>& all() const { return slots_; }

 private:
  std::map<transfer::PeerId, std::size_t> slots_{};
};

/// The blocks of other robots' maps, for the stations that lack them: the newest state that came of each,
/// under the names and revisions that its robot gave it. A block goes to a station once, unless it is lost or
/// a newer state comes. Parts whose digest is that of the station do not go.
///
/// It runs on a strand that has little time, as BlockSource: pieces are encoded by `compute`, and what takes
/// time in proportion to the map is done in slices.
class CarriedBlocks final : public transfer::Source {
 public:
  CarriedBlocks(CarryBounds bounds, WantsMap wants) : bounds_(bounds), wants_(std::move(wants)) {}

  /// See BlockSource::encode_on().
  void encode_on(Executor& strand, Task ready);
  /// Goes on with peers that join, and with digests.
  void tick();

  /// Takes blocks of one robot's map. Returns whether there was room for all of them.
  bool take(const perception::MapPiece& piece);
  /// Takes the digest of a robot's map that a station has.
  void compare(const transfer::PeerId& station, const transfer::ContentDigest& digest);
  /// The stored state of a block; nothing: it is not here.
  std::optional<perception::CoarseBlock> find(const perception::SubmapKey& key,
                                              const perception::BlockIndex& index) const;
  std::size_t size() const { return blocks_; }
  /// Number of blocks of one robot.
  std::size_t size(const std::string& robot) const;

  transfer::Kind kind() const override { return transfer::Kind::carried_blocks; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override;
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId&, std::uint64_t) override {}
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct Ref {
    std::size_t submap{};
    perception::BlockIndex index{};
    auto operator<=>(const Ref&) const = default;
  };
  struct Block {
    std::uint64_t known{}, occupied{};
    std::uint32_t revision{};
    std::uint16_t had_by{};  ///< Bits of the peers that have this state, or to which it is on its way.
  };
  /// A part of a map, see perception::MapDigest.
  struct Part {
    std::map<Ref, Block> blocks{};
    std::array<std::size_t, PeerSlots::kSlots> missing{};  ///< Blocks that the peer of each slot lacks.
    std::uint32_t sum{};
  };
  /// A place in a robot's map, from which it is looked at.
  struct Position {
    std::size_t part{};
    std::optional<Ref> ref{};  ///< Nothing: the first one.
  };
  struct Robot {
    std::vector<perception::SubmapKey> submaps{};
    std::map<perception::SubmapKey, std::size_t> numbers{};  ///< The place of each in `submaps`.
    std::array<Part, perception::MapDigest::kPoses> parts{};
    std::array<Position, PeerSlots::kSlots> lacked_from{};  ///< See lacked().
    std::size_t size() const;
  };
  /// How far the blocks of all robots were looked at.
  struct Cursor {
    std::string robot{};
    Position at{};
  };
  /// A digest of which only parts were compared yet.
  struct Comparison {
    transfer::PeerId station{};
    transfer::ContentDigest digest{};
    std::size_t next_part{};
  };
  struct Sent {
    std::size_t part{};
    Ref ref{};
    std::uint64_t known{}, occupied{};
    std::uint32_t revision{};
  };
  struct Flight {
    std::string robot{};
    std::vector<Sent> blocks{};
  };
  /// A block that a piece could have.
  struct Candidate {
    Sent at{};
    perception::BlockUpdate update{};
  };
  /// A piece that is encoded.
  struct Pending {
    std::uint64_t number{};
    Flight content{};
    std::size_t max_bytes{};
    std::optional<perception::PackedPiece> packed{};  ///< Nothing: not yet.
  };
  /// The slot of a peer that has joined.
  std::optional<std::size_t> slot_of(const transfer::PeerId& peer) const;
  /// Clears the bit of a slot in the next blocks. Returns whether those were the last.
  bool clear_slice(Cursor& cursor, std::size_t slot);
  void continue_join(std::size_t slot);
  /// Compares the next parts of digests.
  void continue_compare();
  bool begin_piece(std::span<const transfer::PeerId> peers, std::size_t max_bytes);
  /// What the peer of a slot lacks of a robot's map: blocks of one submap, the newest first. Looks at a
  /// bounded number of blocks; the next call begins where it found the first one.
  std::vector<Candidate> lacked(Robot& robot, std::size_t slot) const;
  std::optional<std::size_t> number_of(Robot& robot, const perception::SubmapKey& key) const;

  CarryBounds bounds_;
  WantsMap wants_;
  PeerSlots slots_{};
  std::map<std::string, Robot> robots_{};
  std::map<std::uint64_t, Flight> flights_{};
  std::uint64_t tokens_{};
  std::size_t blocks_{};
  std::map<std::size_t, Cursor> joining_{};  ///< By slot: up to there, nothing is of the peer before.
  std::deque<Comparison> comparisons_{};
  std::optional<Pending> pending_{};
  std::uint64_t pieces_begun_{};
  Executor* strand_{};  ///< Null: pieces are encoded by next().
  Task ready_{};
};

}  // namespace adit::agent
