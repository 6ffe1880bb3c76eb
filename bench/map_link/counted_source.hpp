// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <utility>

#include "bench/map_link/rule.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::bench {

/// Passes everything to a BlockSource, and counts what its pieces hold. For one peer; `find_stored` finds the
/// blocks of that peer.
class CountedSource final : public transfer::Source {
 public:
  CountedSource(agent::BlockSource& source, perception::FindStored find_stored)
      : source_(source), find_stored_(std::move(find_stored)) {}

  transfer::Kind kind() const override { return source_.kind(); }
  void join(const transfer::PeerId& peer) override { source_.join(peer); }
  void leave(const transfer::PeerId& peer) override { source_.leave(peer); }
  std::size_t missing(const transfer::PeerId& peer) const override { return source_.missing(peer); }
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override;

  /// Number of calls of next().
  std::uint64_t asked() const { return asked_; }
  const Account& account() const { return account_; }

 private:
  using Name = std::pair<std::uint32_t, perception::BlockIndex>;
  agent::BlockSource& source_;
  perception::FindStored find_stored_;
  Account account_{};
  std::uint64_t asked_{};
  std::set<Name> ever_{}, lost_{};
  std::map<std::uint64_t, std::vector<Name>> flights_{};
};

}  // namespace adit::bench
