// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "core/transfer/piece.hpp"
#include "core/wire/link/rate_control.hpp"
#include "core/wire/link_state.hpp"

namespace adit::transfer {

/// Parameters of Pacer.
struct PacerParams {
  double share{0.55};           ///< Part of the link's bandwidth, (0, 1]; the class may use 0.6 of it.
  double max_rate{60e3};        ///< Largest rate over all peers, bytes/s.
  double unknown_link{4e6};     ///< Bandwidth assumed where no profile limits the sender, bit/s.
  Duration max_queue{60ms};     ///< Airtime queued above which nothing is added.
  std::size_t priority{5};      ///< Of the class, see core/wire/link.hpp.
  double max_loss{0.5};         ///< Share of lost pieces above which the link counts as full, (0, 1].
  std::size_t loss_window{16};  ///< Number of pieces over which the loss is measured.
};

/// Says how many bytes of class `bulk` or `video` may go out now. Rate = a share of the link's bandwidth,
/// reduced while the queue persists or messages are dropped (wire::RateControl). It allows at most one piece
/// beyond a tenth of a second, so that a command that comes next waits for one frame. Reads no clock.
class Pacer {
 public:
  explicit Pacer(PacerParams params = {}) : params_(params) {}

  /// Updates the credit; call it before each round of sending. `peers`: receivers of each piece, which cost a
  /// datagram each, >= 1.
  void observe(Time now, const wire::SenderState& link, std::size_t peers);
  /// Largest content of a piece on this link, bytes.
  std::size_t piece_bytes() const { return piece_bytes_; }
  /// Whether a piece may go out now. `ahead`: it need not wait until the rate has made up for the piece
  /// before.
  bool allows(bool ahead = false) const {
    return idle_ && credit_ > (ahead ? -static_cast<double>((piece_bytes_ + kPieceOverhead) * peers_) : 0.0);
  }
  /// Records that a piece went out.
  void sent(std::size_t bytes) { credit_ -= static_cast<double>((bytes + kPieceOverhead) * peers_); }
  /// Records whether a piece arrived.
  void settled(bool arrived);
  /// Present rate over all peers, bytes/s.
  double rate() const { return rate_; }

 private:
  PacerParams params_;
  wire::RateControl control_{};
  std::size_t peers_{1};
  std::size_t piece_bytes_{kMaxPieceBytes};
  double rate_{}, credit_{};
  bool idle_{};
  bool started_{};
  Time at_{};
  std::size_t arrived_{}, lost_{};
  bool lossy_{};
};

}  // namespace adit::transfer
