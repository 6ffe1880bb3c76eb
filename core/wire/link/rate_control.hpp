#pragma once
#include <algorithm>
#include <cstdint>

#include "core/time/time.hpp"

namespace adit::wire {

/// How a periodic message's rate follows the link.
struct RateParams {
  double max_rate{10.0};     ///< 1/s, where the link lets it, (0, 1000]
  double min_rate{1.0};      ///< 1/s, however bad the link is, (0, most]
  double step{1.0};          ///< 1/s, added every `rise` while the link is calm, (0, most]
  double fall{0.5};          ///< the rate is multiplied by this when the link is full, (0, 1)
  Duration rise{500ms};      ///< between two steps up, (0, 10 s]
  Duration settle{500ms};    ///< after a fall, until another may follow, (0, 10 s]
  Duration calm{1s};         ///< without a sign of a full link, before the rate rises, (0, 60 s]
  Duration full{200ms};      ///< airtime that waits, above which the link is full, (0, 10 s]
  Duration low{50ms};        ///< below which it is calm; in between the rate stays, (0, full]
  Duration standing{300ms};  ///< how long the queue must stay above `full`: bursts drain, (0, 10 s]
  std::uint64_t drops{3};    ///< messages dropped within a second that mean a full link, [1, 1000]
  Duration tick{100ms};      ///< how often due() is asked, (0, 1 s]
};

/// Additive increase, multiplicative decrease (Chiu and Jain 1989) by the sender's own queue: a queue that
/// stands, rather than one that is there for a moment, says that the link is full (CoDel: Nichols and
/// Jacobson 2012), and so do messages that the queue dropped. What the air loses says nothing of that, and
/// is no reason to send less. Pure, no allocation.
class RateControl {
 public:
  explicit RateControl(RateParams params = {}) : params_(params), rate_(params.max_rate) {}

  /// What waits to be sent, and what was dropped since the start, both of this message's class and those that
  /// go before it. At each tick.
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

  /// Never below this, 1/s, whatever the link; 0: `least`.
  void set_floor(double floor) { floor_ = std::min(floor, params_.max_rate); }
  /// 1/s
  double rate() const { return std::max(rate_, floor_); }
  /// How many times as rarely as usual, in [1, 4]: for what is less urgent.
  int stretch() const {
    return rate_ >= 0.7 * params_.max_rate ? 1 : rate_ >= 0.35 * params_.max_rate ? 2 : 4;
  }
  /// Whether one should be sent at this tick; when it is, it counts as sent.
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
  Time was_below_full_{}, was_low_{};  // when the queue was last seen so short
  Time trouble_{}, fell_{}, rose_{};
  Time counted_{};           // drops are counted from here on
  std::uint64_t dropped_{};  // then
  std::uint64_t seen_{};
  bool sent_any_{};
  Time sent_{};
};

}  // namespace adit::wire
