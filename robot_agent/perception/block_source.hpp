// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/transfer/source.hpp"
#include "perception/map/block.hpp"
#include "perception/types/submap_key.hpp"

namespace adit::agent {

struct BlockSourceParams {
  std::string robot{};
  std::uint64_t start{};            ///< SubmapKey::start of all submaps.
  std::size_t max_blocks{200'000};  ///< Blocks that are stored; the oldest submap's are dropped, [64, 10^7].
  Duration hold{3s};  ///< A block that peers have is sent again at most this often, however it changes.
};

/// The blocks of a robot's map as stations see them (0.2 m masks), and what each station has of them. Blocks
/// that a station never had go first, the newest of them first; every fourth piece is for blocks that
/// changed. All blocks of a piece are of one submap. The map outlives the component that makes it.
class BlockSource final : public transfer::Source {
 public:
  static constexpr std::size_t kMaxPeers = 16;

  explicit BlockSource(BlockSourceParams params) : params_(std::move(params)) {}

  /// Sets the newest state of a block; one that is equal to the stored one changes nothing.
  void update(std::uint32_t submap, const perception::CoarseBlock& block);
  std::size_t size() const { return blocks_.size(); }
  /// Number of blocks that were dropped for lack of space.
  std::uint64_t dropped() const { return dropped_; }

  transfer::Kind kind() const override { return transfer::Kind::map_blocks; }
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
  struct Entry {
    std::uint64_t known{}, occupied{};
    std::uint64_t change{};      ///< Number of the last change; rises over all blocks.
    std::uint16_t had_by{};      ///< Bit of each peer that acknowledged some state of it.
    Time sent{Duration::min()};  ///< When it was part of a piece last.
  };
  /// What one peer lacks, by number of the change.
  struct Peer {
    std::uint16_t bit{};
    std::map<std::uint64_t, Ref> unseen{};   ///< It never had them.
    std::map<std::uint64_t, Ref> changed{};  ///< It has an older state.
  };
  struct Part {
    Ref ref{};
    std::uint64_t change{};
  };
  void add_missing(Peer& peer, const Ref& ref, const Entry& entry);
  /// Candidates for a piece, all of the submap of the first one.
  std::vector<Ref> choose(const Peer& peer, Time now);
  void drop_oldest_submap();

  BlockSourceParams params_;
  std::map<Ref, Entry> blocks_{};
  std::map<transfer::PeerId, Peer> peers_{};
  std::map<std::uint64_t, std::vector<Part>> flights_{};
  std::uint64_t changes_{};
  std::uint64_t tokens_{};
  std::uint64_t dropped_{};
};

}  // namespace adit::agent
