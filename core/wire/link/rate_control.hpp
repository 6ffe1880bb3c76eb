// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "core/time/time.hpp"

namespace adit::wire {

/// Parameters of RateControl.
struct RateParams {
  double max_rate{10.0};   ///< Rate on a link with room for it, 1/s, (0, 1000].
  double min_rate{1.0};    ///< Lowest rate, however bad the link is, 1/s, (0, max_rate].
  double step{1.0};        ///< Added every `rise` while the link is not full, 1/s, (0, max_rate].
  double fall{0.5};        ///< Factor on the rate when the link is full, (0, 1).
  Duration rise{500ms};    ///< Time between two increases, (0, 10 s].
  Duration settle{500ms};  ///< Time after a decrease until another may follow, (0, 10 s].
  Duration calm{1s};       ///< Time without a sign of a full link before the rate rises, (0, 60 s].
  Duration full{200ms};    ///< Queued airtime above which the link counts as full, (0, 10 s].
  /// Queued airtime below which the rate may rise; in between it does not change, (0, full].
  Duration low{50ms};
  /// How long the queue must stay above `full`, as bursts drain by themselves, (0, 10 s].
  Duration standing{300ms};
  std::uint64_t drops{3};  ///< Messages dropped within a second that mean a full link, [1, 1000].
  Duration tick{100ms};    ///< Period at which due() is called, (0, 1 s].
};

/// Adapts the rate of a periodic message to the link: additive increase, multiplicative decrease (Chiu and
/// Jain 1989) on the sender's own queue. A queue that persists, rather than a momentary one, shows a full
/// link (CoDel: Nichols and Jacobson 2012), and so do messages that the queue dropped. Losses on the radio
/// say nothing about load and are no reason to send less. It reads no clock and allocates nothing.
class RateControl {
 public:
  explicit RateControl(RateParams params = {}) : params_(params), rate_(params.max_rate) {}

  /// Updates the rate; call it at each tick. `queue`: airtime queued; `dropped`: messages dropped since the
  /// start; both of this message's class and those before it.
  void observe(Time now, Duration queue, std::uint64_t dropped) {
    if (!started_) {
      started_ = true;
      was_below_full_ = was_low_ = fell_ = rose_ = counted_ = now;
      dropped_ = dropped;
      trouble_ = now - params_.calm;
    }
    if (queue <= params_.full) was_below_full_ = now;
    if (queue <= params_.low) was_low_ = now;
    if (now - counted_ >= 1s) {
      counted_ = now;
      dropped_ = seen_;
    }
    if (dropped > seen_) trouble_ = now;
    seen_ = dropped;
    const bool stands = now - was_below_full_ >= params_.standing;
    const bool drops = dropped >= dropped_ + params_.drops;
    if (stands || drops) {
      trouble_ = now;
      if (now - fell_ < params_.settle && rate_ < params_.max_rate) return;
      rate_ = std::max(params_.min_rate, rate_ * params_.fall);
      fell_ = counted_ = now;
      dropped_ = dropped;
      return;
    }
    const bool low = now - was_low_ < params_.standing;
    if (!low || now - trouble_ < params_.calm || now - rose_ < params_.rise) return;
    rate_ = std::min(params_.max_rate, rate_ + params_.step);
    rose_ = now;
  }

  /// Lower limit of the rate whatever the link does, 1/s; 0: `min_rate`.
  void set_floor(double floor) { floor_ = std::min(floor, params_.max_rate); }
  /// Current rate, 1/s.
  double rate() const { return std::max(rate_, floor_); }
  /// Period factor for less urgent messages, in [1, 4].
  int stretch() const {
    return rate_ >= 0.7 * params_.max_rate ? 1 : rate_ >= 0.35 * params_.max_rate ? 2 : 4;
  }
  /// Whether a message should be sent at this tick; if so, it counts as sent.
  bool due(Time now) {
    if (sent_any_ && now - sent_ < from_seconds(1.0 / rate()) - params_.tick / 2) return false;
    sent_ = now;
    sent_any_ = true;
    return true;
  }

 private:
  RateParams params_;
  double rate_;
  double floor_{};
  bool started_{};
  Time was_below_full_{}, was_low_{};  // When the queue was last below `full` and below `low`.
  Time trouble_{}, fell_{}, rose_{};
  Time counted_{};           // Start of the interval in which drops are counted.
  std::uint64_t dropped_{};  // Value of the drop counter at that time.
  std::uint64_t seen_{};
  bool sent_any_{};
  Time sent_{};
};

}  // namespace adit::wire
