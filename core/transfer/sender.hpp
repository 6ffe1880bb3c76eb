// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "core/transfer/pacer.hpp"
#include "core/transfer/source.hpp"

namespace adit::transfer {

/// Parameters of Sender.
struct SenderParams {
  std::uint32_t session{1};       ///< Drawn at each start of the sender, not 0.
  std::size_t max_peers{16};      ///< Peers whose content is remembered, [1, 16].
  std::size_t max_in_flight{96};  ///< Pieces that are neither acknowledged nor lost, [1, Receipt::kSpan).
  Duration silence{12s};          ///< A peer whose acknowledgement is older is sent nothing.
  Duration station_silence{
      15s};  ///< Carriers are sent to once no station acknowledged for this long, >= silence.
  Duration min_rejoin{
      2s};  ///< Shortest time between two starts of a peer, as each costs a round over all content.
  /// Bounds of the time after which a piece counts as lost if no acknowledgement has anything of its session.
  Duration min_timeout{3s};
  Duration max_timeout{8s};
  Duration unnamed{2s};           ///< The same for a peer to which nothing came yet.
  std::size_t pieces_at_once{4};  ///< Largest number of pieces of one call of due().
  PacerParams pacing{};
};

/// Sends the content of its sources to every peer that acknowledges, as the link allows. A piece goes to all
/// peers at once and is chosen for the one that lacks most. A piece counts as lost when an acknowledgement
/// comes that ought to have it and does not, or when two could have come: acknowledgements are lost, too, and
/// name only senders of which something arrived. Its content is missing again, and the source gives its
/// newest state later.
///
/// Carriers, robots that take content on to stations, are peers for content that is for them. As each peer
/// costs a copy on the air, they are sent to only while no station is heard. A station takes a carrier's slot
/// when there is no other.
///
/// A pure state machine, bounded in all that others can make it store. Sources must outlive it.
class Sender {
 public:
  explicit Sender(SenderParams params) : params_(params), pacer_(params.pacing) {}

  /// Adds a source; those added first go first.
  void add(Source& source) { sources_.push_back(&source); }
  /// Takes an acknowledgement, genuine or not: it must come from a known station, or a known robot that says
  /// that it is a carrier. Returns whether it is of the peer's present start.
  bool acknowledged(const Ack& ack, Time now);
  /// The pieces to send now. Call it at 10 to 50 Hz.
  std::vector<Piece> due(Time now, const wire::SenderState& link);

  std::uint32_t session() const { return params_.session; }
  std::size_t peers() const { return peers_.size(); }
  /// Whether no station was heard for so long that carriers are sent to.
  bool serves_carriers(Time now) const {
    return station_heard_ && now - *station_heard_ >= params_.station_silence;
  }
  std::size_t in_flight() const { return flights_.size(); }

 private:
  static constexpr std::size_t kStarts = 4;  ///< Earlier starts of a peer that are remembered.
  /// A peer that acknowledges.
  struct Peer {
    std::uint32_t start{};
    std::deque<std::uint32_t> earlier{};  ///< Starts that ended: their acknowledgements come late.
    Time heard{};
    Time joined{};  ///< When its present start was taken.
    bool carrier{false};
    bool named{false};  ///< It acknowledged a piece, so that its acknowledgements name this sender.
  };
  /// A piece on its way.
  struct Flight {
    std::uint32_t id{};
    std::uint64_t token{};
    Source* source{};
    Time sent{};
    std::vector<PeerId> awaited{};  ///< Peers that have not acknowledged it.
  };
  Peer* admit(const Ack& ack, Time now);
  /// Forgets a peer if there are too many. Returns false if none may go.
  bool make_room(bool for_carrier, Time now);
  void forget(PeerId peer);
  void join(const Ack& ack);
  bool is_served(const Peer& peer, Time now) const {
    return peer.carrier == serves_carriers(now) && now - peer.heard < params_.silence;
  }
  void settle(const PeerId& peer, const Receipt& receipt, Time now);
  void expire(Time now);
  void measure(Duration delay);
  /// Time after which an acknowledgement ought to have a piece: 1.5 times the shortest delay.
  Duration due_within() const;
  /// Time after which two acknowledgements ought to have come.
  Duration timeout() const;
  /// Peers to send to, those that lack most of the source's content first; none if no one lacks any.
  std::vector<PeerId> served(const Source& source, Time now) const;
  /// Parts of all sources that the peer that lacks most lacks.
  std::uint32_t waiting(const std::vector<PeerId>& peers) const;

  SenderParams params_;
  Pacer pacer_;
  std::vector<Source*> sources_{};
  std::map<PeerId, Peer> peers_{};
  std::deque<Flight> flights_{};
  std::optional<Time> station_heard_{};  ///< A station acknowledged; at first: when this sender began.
  std::uint32_t last_id_{};
  std::optional<double> least_delay_{};  ///< Of acknowledgements, s; it follows longer ones slowly.
};

}  // namespace adit::transfer
