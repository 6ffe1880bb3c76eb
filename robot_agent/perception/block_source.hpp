// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/transfer/source.hpp"
#include "perception/map/block.hpp"
#include "perception/stream/piece.hpp"
#include "perception/types/submap_key.hpp"
#include "robot_agent/perception/block_votes.hpp"
#include "robot_agent/perception/piece_job.hpp"

namespace adit::agent {

struct BlockSourceParams {
  std::string robot{};
  std::uint64_t start{};            ///< SubmapKey::start of submaps that are not named by open().
  std::size_t max_blocks{200'000};  ///< Blocks that are stored, [64, 10^7]; see BlockSource::update.
  // A place of which a station knows less than the robot goes when it has not changed for `settle`, at the
  // latest after `wait`: while a robot passes, its blocks grow with every scan. The first time, it goes in
  // voxels of 0.4 m. A place that shows something else, or more in voxels of 0.2 m, goes after `hold` without
  // a change, at the latest after `max_hold`. It waits until it is part of a full piece, or did not change
  // for twice that time. Pieces that are not full go once in a `round`. On links with small frames `wait` and
  // `round` are four times as long, as a header takes a third of a piece.
  Duration settle{2s};
  Duration wait{2200ms};
  Duration round{2s};
  Duration hold{30s};
  Duration max_hold{180s};
  double fill{0.8};  ///< Part of a piece from which on it is full, [0, 1].
  /// A station that lacks more than fills so many pieces gets voxels of 0.4 m of all of it first.
  std::size_t coarse_pieces{64};
  std::size_t slice{3000};  ///< Cells that are looked up at once for a peer that joins: 1 ms, [1, 10^7].
};

/// Name and place of a submap. Submaps of one group lie in one lattice of blocks: they move together, and
/// block i of a submap covers the same place as block i + offset of the group.
struct SubmapPlace {
  std::uint64_t start{};
  std::uint32_t index{};
  std::uint64_t group{};
  perception::BlockIndex offset{};
};

/// Blocks of a group's lattice from `low` to `high`, both included.
struct BlockRegion {
  std::uint64_t group{};
  perception::BlockIndex low{}, high{};
};

/// The blocks of a robot's map as stations see them (0.2 m masks), and what each station has of them.
///
/// Submaps of one group move together, and lie in one lattice: a station gets the merge of all of them, as
/// blocks of the group's first submap. So a place is sent once, however many submaps saw it, and again only
/// if the merge shows something else. Blocks with voxels of 0.4 m of which a station knows nothing go first,
/// the newest of them first; every fourth piece is first for what rested or changed. While a block still
/// changes, a station gets its voxels of 0.4 m, and those of 0.2 m once it rests. Blocks wait until they fill
/// a piece, within the bounds of BlockSourceParams. While a station is behind by more than kBacklog blocks,
/// those in the focus go before others, and surfaces before free space; while it is behind by more than
/// `coarse_pieces` pieces, it first gets voxels of 0.4 m of all that it lacks. Of a block whose last state it
/// acknowledged, a station is sent what changed. All blocks of a piece are of one group. The map outlives
/// the component that makes it. Submaps are numbered by age.
///
/// It runs on a strand that has little time. So a piece is chosen here, and encoded by `compute`, one at a
/// time: next() has it once it is ready. What a peer that joins lacks is looked up in slices, one each time
/// that tick() is called; it is sent nothing before.
class BlockSource final : public transfer::Source {
 public:
  static constexpr std::size_t kMaxPeers = 16;
  static constexpr std::size_t kBacklog = perception::kMaxPieceBlocks;

  explicit BlockSource(BlockSourceParams params) : params_(std::move(params)) {}

  /// Encodes pieces by `compute` of this strand, on which all calls are made, and calls `ready` when next()
  /// has one. Without it, next() encodes.
  void encode_on(Executor& strand, Task ready);

  /// Names a submap before its first block.
  void open(std::uint32_t submap, const SubmapPlace& place);
  /// Says what the time is; what is updated now changes now. Looks up the next slice for a peer that joins.
  void tick(Time now);
  /// Sets the newest state of a block; one that is equal to the stored one changes nothing. When there is no
  /// room, a submap is dropped: the oldest one that newer ones cover, or the oldest one.
  void update(std::uint32_t submap, const perception::CoarseBlock& block, std::uint32_t revision = 0);
  /// Makes all later revisions larger: after a restart, peers may know larger ones than the disk.
  void skip_revisions(std::uint32_t count) { changes_ += count; }
  /// Notes that a peer has the present state of all places that no other submaps than these saw, before
  /// anything was sent to it.
  void has(const transfer::PeerId& peer, const std::set<std::uint32_t>& submaps);
  bool knows(const transfer::PeerId& peer) const { return peers_.contains(peer); }
  /// Whether any peer lacks so much that the focus matters.
  bool is_behind() const;
  /// Sets what every peer is to have first, the first region first.
  void focus(std::vector<BlockRegion> regions);
  /// Sets what one peer is to have first, after that of every peer.
  void focus(const transfer::PeerId& peer, std::vector<BlockRegion> regions);
  /// Whether a peer acknowledged the present state of all places that a submap saw.
  bool complete(const transfer::PeerId& peer, std::uint32_t submap) const;
  std::size_t size() const { return blocks_.size(); }
  /// Number of blocks that were dropped for lack of space.
  std::uint64_t dropped() const { return dropped_; }
  /// Blocks of a submap, by index, with the number of their last change.
  void for_each(
      std::uint32_t submap,
      const std::function<void(const perception::CoarseBlock&, std::uint32_t revision)>& visit) const;
  /// Number of blocks of a submap that were erased since the last call because newer ones outvote them.
  std::size_t take_pruned(std::uint32_t submap);
  /// Whether newer submaps of its group show more than 90 % of a submap's blocks.
  bool is_covered(std::uint32_t submap) const;
  /// The submap that is worth least: one of the oldest that is covered, or the oldest. Nothing: there is but
  /// the newest one.
  std::optional<std::uint32_t> oldest_to_drop() const;
  /// Whether a submap is the first one of its group, whose name and pose all blocks of the group have.
  bool is_first(std::uint32_t submap) const;
  /// Forgets a submap; peers keep what they have.
  void drop(std::uint32_t submap);

  transfer::Kind kind() const override { return transfer::Kind::map_blocks; }
  bool for_carriers() const override { return true; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override;
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct Ref {
    std::uint32_t submap{};
    perception::BlockIndex index{};
    auto operator<=>(const Ref&) const = default;
  };
  static constexpr Ref first_of(std::uint32_t submap) { return {submap, {INT32_MIN, INT32_MIN, INT32_MIN}}; }
  /// A cell of a group's lattice.
  struct LatticeCell {
    std::uint64_t group{};
    perception::BlockIndex index{};
    auto operator<=>(const LatticeCell&) const = default;
  };
  struct Block {
    std::uint64_t known{}, occupied{};
    std::uint64_t change{};  ///< Number of the last change; rises over all blocks.
  };
  /// A cell that was seen.
  struct Place {
    std::vector<std::uint32_t> submaps{};  ///< That saw it, by age.
    BlockVotes forgotten{};                ///< Of older submaps, whose blocks were erased.
    std::uint64_t known{}, occupied{};     ///< The merge of all of them.
    std::uint64_t change{};                ///< Number of its last change.
    std::uint64_t sent_known{}, sent_occupied{}, sent_change{};  ///< As it was sent last.
    std::uint16_t up_to_date{};  ///< Bit of each peer to which that went, unless it was lost.
    std::uint16_t had_by{};      ///< Bit of each peer that acknowledged that.
    std::uint64_t base_known{}, base_occupied{}, base_change{};  ///< As it was acknowledged last.
    std::uint16_t base_by{};    ///< Bit of each peer that has exactly that, as far as is known.
    std::uint16_t missed_by{};  ///< Bit of each peer for which changes to that were lost once.
    std::uint16_t seen_by{};    ///< Bit of each peer that acknowledged any state of it.
    std::uint64_t coarse_known{},
        coarse_change{};                ///< As it went in voxels of 0.4 m last, see in_large_voxels().
    std::uint16_t coarse_by{};          ///< Bit of each peer to which that went, unless it was lost.
    std::uint16_t coarse_missed_by{};   ///< Bit of each peer for which that was lost: it is tried once more.
    std::optional<Time> waits_since{};  ///< Since then some peer lacks its present state.
    std::optional<Time> grew_since{};   ///< Since then some peer lacks voxels of 0.4 m.
    Time changed{};

    bool is_sent() const { return sent_change != 0 && sent_known == known && sent_occupied == occupied; }
    /// Whether the state that was sent last neither arrived at these peers nor was lost.
    bool is_on_its_way(std::uint16_t to) const { return (up_to_date & ~had_by & to) != 0; }
    /// Whether a peer has, or gets, any state of it in voxels of 0.2 m.
    bool is_fine(std::uint16_t peer) const { return ((seen_by | up_to_date) & peer) != 0; }
    /// Whether it shows voxels of 0.4 m that were not sent to a peer.
    bool lacks_coarse(std::uint16_t peer) const;
    /// Whether these peers can be sent what changed.
    bool has_base(std::uint16_t to) const { return (to & ~base_by) == 0 && (base_known & ~known) == 0; }
    void acknowledge(std::uint16_t by);
    void forget(std::uint16_t peer);
  };
  using Cells = std::map<LatticeCell, Place>;
  using Cell = Cells::value_type;
  /// Cells by the number of their present change; a cell leaves them before it is erased.
  using Lacked = std::map<std::uint64_t, Cell*>;
  /// What one peer lacks.
  struct BlockRecipient {
    std::uint16_t bit{};
    Lacked unseen{};   ///< With voxels of 0.4 m of which it knows nothing.
    Lacked resting{};  ///< That went in voxels of 0.4 m, and in no others.
    Lacked changed{};  ///< Others.
    /// Cells from this one on were not looked up since it joined: they have the bits of the peer before it.
    /// Nothing: it has joined.
    std::optional<LatticeCell> joins_from{};
    std::set<std::uint32_t> has{};      ///< While it joins: the submaps given to BlockSource::has().
    std::optional<Time> rests_until{};  ///< There was not enough for a piece when it was looked at last.
    std::optional<Time> changed_rests_until{};  ///< Nothing in `changed` was due then.
    std::vector<BlockRegion> focus{};
    std::optional<Time> round_ends{};  ///< Until then only full pieces go.
    std::size_t focus_next{};          ///< The slice of the focus that was looked at last.
    std::optional<Time>
        focus_rests_until{};  ///< It lacked nothing of the focus when that was looked at last.
    std::uint64_t coarse_below{
        UINT64_MAX};      ///< Those of `unseen` with earlier changes go next as coarse ones.
    bool coarse_first{};  ///< All that it lacks goes in voxels of 0.4 m first.
    bool behind{};        ///< More than kBacklog of `unseen` and `resting` could go.

    void forget(std::uint64_t change) { unseen.erase(change), resting.erase(change), changed.erase(change); }
    bool has_joined() const { return !joins_from; }
    /// Whether the cell was looked up for it.
    bool covers(const LatticeCell& cell) const { return !joins_from || cell < *joins_from; }
  };
  /// A place in a piece, in the state that is sent.
  struct Part {
    LatticeCell cell{};
    bool coarse{};  ///< In voxels of 0.4 m.
    std::uint64_t known{}, occupied{};
    std::uint64_t change{};  ///< Of that state.
    bool based{};            ///< What changed goes.
  };
  /// A piece that is encoded.
  struct Pending {
    std::uint64_t number{};
    std::vector<Part> parts{};
    std::uint16_t to{};  ///< Its bases are those of these peers.
    std::size_t max_bytes{};
    std::optional<perception::PackedPiece> packed{};  ///< Nothing: not yet.
  };
  /// What the blocks of a piece are expected to take.
  struct Bytes {
    static constexpr double kHeader = 32.0;
    double coarse{}, changes{}, complete{};
    double sum() const { return kHeader + coarse + changes + complete; }
    void add(bool is_coarse, bool based) { (is_coarse ? coarse : based ? changes : complete) += 1.0; }
  };
  SubmapPlace place_of(std::uint32_t submap) const;
  LatticeCell cell_of(const Ref& ref) const;
  /// The block of a submap in a cell.
  Ref ref_in(const LatticeCell& cell, std::uint32_t submap) const;
  /// What the merge of these submaps shows of a cell.
  BlockVotes votes_of(const LatticeCell& cell, const Place& place,
                      std::optional<std::uint32_t> without = {}) const;
  /// Notes that a peer lacks the present state of a place. Returns whether it lacks voxels of 0.4 m.
  static bool add_missing(BlockRecipient& peer, Cell& cell);
  /// Notes that a peer has the present state of a place if no other submaps than these saw it.
  static void note_had(BlockRecipient& peer, Cell& cell, const std::set<std::uint32_t>& submaps);
  /// Looks up the next cells for a peer that joins.
  void continue_join(BlockRecipient& peer);
  /// The bits of those of these peers that have joined.
  std::uint16_t bits_of(std::span<const transfer::PeerId> peers) const;
  /// Chooses the next piece, and has it encoded. False: there is none now.
  bool begin_piece(std::span<const transfer::PeerId> peers, std::size_t max_bytes, Time now);
  /// Notes that these parts are on their way to these peers.
  void note_parts(const std::vector<Part>& parts, std::uint16_t to);
  /// Notes that a state of a place went to these peers. It may be older than the present one.
  void note_sent(Cell& cell, const Part& part, std::uint16_t to);
  /// The same in voxels of 0.4 m.
  void note_coarse(Cell& cell, const Part& part, std::uint16_t to);
  /// Takes the length of a piece into the mean lengths of blocks.
  void learn(const std::vector<Part>& sent, std::size_t bytes);
  /// What so many blocks are expected to take.
  Bytes expected(Bytes counts) const;
  enum class Due { no, yes, late };
  struct Waits {
    Duration rest{}, flush{}, latest{};
  };
  /// `since`: since when it waits.
  static Due due(const Place& place, std::optional<Time> since, const Waits& waits, Time now);
  Waits held() const { return {params_.hold, 2 * params_.hold, params_.max_hold}; }
  /// Whether a place of BlockRecipient::unseen is to go in voxels of 0.4 m.
  bool goes_coarse(const Place& place, std::uint16_t peer, Time now) const {
    return !place.is_fine(peer) && now - place.changed < params_.hold;
  }
  struct Choice;
  /// Whether a peer is to have voxels of 0.4 m of all that it lacks before any of 0.2 m: notes when that
  /// begins and ends.
  bool is_coarse_first(BlockRecipient& peer, std::size_t max_bytes) const;
  /// Places for a piece, all of one group. Defined in block_choice.cpp, as all that it calls.
  std::vector<Part> choose(BlockRecipient& peer, std::size_t max_bytes, Time now);
  std::vector<Part> choose_coarse(BlockRecipient& peer);
  void add_focused(BlockRecipient& peer, Time now, Choice& out);
  /// Adds what a peer lacks of a region at one x; returns how many cells were looked at.
  std::size_t add_slice(const BlockRecipient& peer, const BlockRegion& region, std::int32_t x, Time now,
                        Choice& out) const;
  static void begin_focus(BlockRecipient& peer);
  void add_unseen(const BlockRecipient& peer, Duration wait, Time now, Choice& out) const;
  /// Adds at most `most` of these places that are due; returns how many.
  std::size_t add_held(const BlockRecipient& peer, const Lacked& places, std::size_t most, Time now,
                       Choice& out) const;
  void add_resting(const BlockRecipient& peer, Time now, Choice& out) const;
  void add_changed(BlockRecipient& peer, Time now, Choice& out);
  /// Erases a block; what was seen stays as it is.
  void erase(const Ref& ref);
  /// Erases blocks that show nothing any more, whatever comes: three newer ones know each of their voxels. So
  /// a place takes the space of a few submaps, however often the robot comes there.
  void prune(const LatticeCell& cell);
  /// Whether three newer blocks of a place than that at `position` know each of its voxels.
  bool is_outvoted(const LatticeCell& cell, const Place& place, std::size_t position) const;
  void make_room();

  BlockSourceParams params_;
  std::map<std::uint32_t, SubmapPlace> names_{};
  std::map<std::uint64_t, std::uint32_t> first_{};  ///< The first submap of each group.
  std::map<Ref, Block> blocks_{};
  Cells cells_{};
  std::map<std::uint32_t, std::size_t> pruned_{};
  std::map<transfer::PeerId, BlockRecipient> peers_{};
  std::map<std::uint64_t, std::vector<Part>> flights_{};  ///< Pieces on their way, by token.
  std::vector<BlockRegion> focus_{};
  std::optional<Pending> pending_{};
  std::uint64_t pieces_begun_{};
  Executor* strand_{};  ///< Null: pieces are encoded by next().
  Task ready_{};
  Time now_{};
  /// Of a block in a piece, in the mean: complete, what changed, and in voxels of 0.4 m.
  double complete_bytes_{4.0}, change_bytes_{2.0}, coarse_bytes_{1.0};
  std::uint64_t changes_{};
  std::uint64_t tokens_{};
  std::uint64_t dropped_{};
};

}  // namespace adit::agent
