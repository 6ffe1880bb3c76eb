// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/pacer.hpp"

#include <algorithm>

namespace adit::transfer {
namespace {

constexpr double kBurst = 0.1;  // s
constexpr std::size_t kMinPieceBytes = 128;

}  // namespace

void Pacer::observe(Time now, const wire::SenderState& link, std::size_t peers) {
  const double bandwidth = link.link != nullptr ? link.link->bandwidth : params_.unknown_link;
  const std::size_t frame = link.link != nullptr ? link.link->frame_bytes() : 1400;
  peers_ = std::max<std::size_t>(1, peers);
  piece_bytes_ =
      std::clamp(frame > kPieceOverhead ? frame - kPieceOverhead : 0, kMinPieceBytes, kMaxPieceBytes);
  const Duration queue = link.waiting(params_.priority);
  control_.observe(now, lossy_ ? std::max<Duration>(queue, 1s) : queue, link.lost(params_.priority));
  rate_ = std::min(params_.max_rate, params_.share * bandwidth / 8.0) * control_.rate() /
          wire::RateParams{}.max_rate;
  if (started_) credit_ += rate_ * std::max(0.0, seconds(now - at_));
  started_ = true;
  at_ = now;
  // A credit that is just positive allows one piece, which leaves a debt: on a thin link one at a time.
  credit_ = std::min(credit_, rate_ * kBurst);
  idle_ = queue <= params_.max_queue;
}

void Pacer::settled(bool arrived) {
  ++(arrived ? arrived_ : lost_);
  if (arrived_ + lost_ < params_.loss_window) return;
  lossy_ = static_cast<double>(lost_) > params_.max_loss * static_cast<double>(arrived_ + lost_);
  arrived_ = lost_ = 0;
}

}  // namespace adit::transfer
