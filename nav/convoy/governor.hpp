// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <limits>

namespace adit::nav {

/// Limits the speed of a convoy's leader so that the convoy does not tear. A leader whose last followers fall
/// behind, or are not heard, slows down for a bounded time; then it drives on, and the operator is notified
/// that the convoy is split.
class Governor {
 public:
  /// State of the convoy behind its leader.
  struct Members {
    double longest_gap{};  ///< Between two neighbours, m.
    double slowest{};      ///< Speed of the member behind that gap, m/s.
    double silence{};      ///< Longest time since a member's beacon, s.
  };
  /// Thresholds and waiting times.
  struct Params {
    double min_gap{6.0};       ///< A gap below this is never too long, m.
    double gap_ratio{4.0};     ///< A gap above this many times the gap at rest is too long.
    double gap_wait{30.0};     ///< Longest time that the leader waits for a gap to close, s.
    double silent_after{5.0};  ///< A member silent for longer may be lost, s.
    double silent_speed{0.3};  ///< Speed while a member is silent, m/s.
    double silent_wait{20.0};  ///< Longest time at that speed, s.
    double splice_share{0.5};  ///< Share of its speed while others close up to one that left, (0, 1].
    double splice_wait{10.0};  ///< Longest time at that speed, s.
    double spliced{0.8};       ///< They have closed up when each gap is less than that wider than at rest, m.
  };
  /// Limits of the leader's speed.
  struct Verdict {
    double limit{std::numeric_limits<double>::infinity()};  ///< m/s
    double share{1.0};                                      ///< Of the speed that is set for the convoy.
    bool split{};                                           ///< The waiting time ended.
  };

  Governor() : Governor(Params{}) {}
  explicit Governor(Params params) : params_(params) {}

  /// A member left between two others.
  void member_left() { splice_left_ = params_.splice_wait; }

  /// @param gap  The gap at rest, m.
  /// @param period  Time since the last call, s.
  Verdict step(const Members& members, double gap, double period) {
    Verdict verdict{};
    const bool too_long = members.longest_gap > std::max(params_.min_gap, params_.gap_ratio * gap);
    const bool silent = members.silence > params_.silent_after;
    long_for_ = too_long ? long_for_ + period : 0.0;
    silent_for_ = silent ? silent_for_ + period : 0.0;
    if (too_long && long_for_ <= params_.gap_wait) verdict.limit = members.slowest;
    if (silent && silent_for_ <= params_.silent_wait)
      verdict.limit = std::min(verdict.limit, params_.silent_speed);
    // The member behind the one that left reports its new gap only after it heard of that.
    constexpr double kReported = 2.0;  // s
    splice_left_ = std::max(0.0, splice_left_ - period);
    const bool reported = splice_left_ < params_.splice_wait - kReported;
    if (reported && members.longest_gap < gap + params_.spliced) splice_left_ = 0.0;
    if (splice_left_ > 0.0) verdict.share = params_.splice_share;
    verdict.split = long_for_ > params_.gap_wait || silent_for_ > params_.silent_wait;
    return verdict;
  }

 private:
  Params params_;
  double long_for_{}, silent_for_{};  // How long it has been so, s.
  double splice_left_{};              // The leader still drives slowly for that long, s.
};

}  // namespace adit::nav
