// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "core/time/time.hpp"
#include "core/transfer/piece.hpp"

namespace adit::transfer {

/// Interface to content of one kind that peers are to have. It knows what each peer has, and gives on demand
/// the newest state of what a peer lacks. Called by one Sender, on its strand.
class Source {
 public:
  /// Content of one piece, on its way until acknowledged() or lost() is called for each of its peers.
  struct Content {
    std::uint64_t token{};  ///< Identifies it within the source.
    std::vector<std::uint8_t> data{};
  };

  virtual ~Source() = default;

  virtual Kind kind() const = 0;
  /// Whether robots that carry content on to stations get it as well.
  virtual bool for_carriers() const { return false; }
  /// Adds a peer that has nothing; what it had is forgotten if it joined before.
  virtual void join(const PeerId& peer) = 0;
  /// Forgets a peer.
  virtual void leave(const PeerId& peer) = 0;
  /// Whether its next piece need not wait until the rate has made up for the preceding one. It must be rare.
  virtual bool ahead() const { return false; }
  /// Number of parts that the peer lacks and that are not on their way to it.
  virtual std::size_t missing(const PeerId& peer) const = 0;
  /// Content that `peers` lack, above all the first one, of at most `max_bytes`, on its way to all of them.
  /// One part that cannot be cut may be longer, up to kMaxPieceBytes. Nothing: there is none now, or the
  /// sources behind this one are to have a turn.
  virtual std::optional<Content> next(std::span<const PeerId> peers, std::size_t max_bytes, Time now) = 0;
  virtual void acknowledged(const PeerId& peer, std::uint64_t token) = 0;
  virtual void lost(const PeerId& peer, std::uint64_t token) = 0;
  /// Called once the content has arrived at each of its peers or was lost on its way there.
  virtual void settled(std::uint64_t token) = 0;
};

}  // namespace adit::transfer
