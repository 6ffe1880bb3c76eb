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
  /// Limits of the leader's speed.
  struct Verdict {
    double limit{std::numeric_limits<double>::infinity()};  ///< m/s
    double share{1.0};                                      ///< Of the speed that is set for the convoy.
    bool split{};                                           ///< The waiting time ended.
  };

  /// A member left between two others.
  void member_left() { splice_left_ = kSpliceWait; }

  /// @param gap  The gap at rest, m.
  /// @param period  Time since the last call, s.
  Verdict step(const Members& members, double gap, double period) {
    Verdict verdict{};
    const bool too_long = members.longest_gap > std::max(kMinGap, kGapRatio * gap);
    const bool silent = members.silence > kSilentAfter;
    long_for_ = too_long ? long_for_ + period : 0.0;
    silent_for_ = silent ? silent_for_ + period : 0.0;
    if (too_long && long_for_ <= kGapWait) verdict.limit = members.slowest;
    if (silent && silent_for_ <= kSilentWait) verdict.limit = std::min(verdict.limit, kSilentSpeed);
    // The member behind the one that left reports its new gap only after it heard of that.
    constexpr double kReported = 2.0;  // s
    splice_left_ = std::max(0.0, splice_left_ - period);
    const bool reported = splice_left_ < kSpliceWait - kReported;
    if (reported && members.longest_gap < gap + kSpliced) splice_left_ = 0.0;
    if (splice_left_ > 0.0) verdict.share = kSpliceShare;
    verdict.split = long_for_ > kGapWait || silent_for_ > kSilentWait;
    return verdict;
  }

 private:
  static constexpr double kMinGap = 6.0;       ///< A gap below this is never too long, m.
  static constexpr double kGapRatio = 4.0;     ///< A gap above this many times the gap at rest is too long.
  static constexpr double kGapWait = 30.0;     ///< Longest time that the leader waits for a gap to close, s.
  static constexpr double kSilentAfter = 5.0;  ///< A member silent for longer may be lost, s.
  static constexpr double kSilentSpeed = 0.3;  ///< Speed while a member is silent, m/s.
  static constexpr double kSilentWait = 20.0;  ///< Longest time at that speed, s.
  // Share of its speed while others close up to one that left, (0, 1].
  static constexpr double kSpliceShare = 0.5;
  static constexpr double kSpliceWait = 10.0;  ///< Longest time at that speed, s.
  // They have closed up when each gap is less than that wider than at rest, m.
  static constexpr double kSpliced = 0.8;

  double long_for_{}, silent_for_{};  // How long it has been so, s.
  double splice_left_{};              // The leader still drives slowly for that long, s.
};

}  // namespace adit::nav
