// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basestation/findings/marks.hpp"
#include "core/transfer/source.hpp"

namespace adit::station {

/// This station's marks, which every other station is to have on its disk: the most important first, several
/// in a piece. Only what is on this station's disk is sent, so that no other one has a revision that a
/// restart loses. After a restart of this station each other one gets its marks once more, 512 at most: it
/// finds them on its disk and acknowledges them.
///
/// A mark that a station does not acknowledge goes again after 1, 2, 4, 8 and 16 s. A pure state machine.
class MarkSource final : public transfer::Source {
 public:
  static constexpr Duration kLongestRest = std::chrono::seconds(16);

  /// `station`: this station's name. Both others must outlive the source.
  MarkSource(std::string station, const FindingDesk& desk, const Marks& marks)
      : station_(std::move(station)), desk_(desk), marks_(marks) {}

  /// Updates the list of marks that may be sent: call it when findings changed, or are on the disk.
  void refresh();
  /// Whether there is any.
  bool empty() const { return revisions_.empty(); }

  transfer::Kind kind() const override { return transfer::Kind::findings; }
  void join(const transfer::PeerId& peer) override { peers_[peer] = {}; }
  void leave(const transfer::PeerId& peer) override { peers_.erase(peer); }
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  using Revisions = std::map<std::uint64_t, std::uint32_t>;  ///< By the mark's id.
  /// What a station has of one mark.
  struct Held {
    std::optional<std::uint32_t> has{};   ///< The revision that it acknowledged.
    std::optional<std::uint32_t> sent{};  ///< The revision that is on its way.
    std::uint8_t losses{};                ///< In a row.
    Time rests_until{};
  };
  using Peer = std::map<std::uint64_t, Held>;
  static bool lacks(const Peer& peer, std::uint64_t id, std::uint32_t revision);

  std::string station_;
  const FindingDesk& desk_;
  const Marks& marks_;
  Revisions revisions_{};  ///< Of the marks on this station's disk.
  std::map<transfer::PeerId, Peer> peers_{};
  std::map<std::uint64_t, Revisions> flights_{};  ///< By token.
  std::uint64_t tokens_{};
  Time now_{};
};

}  // namespace adit::station
