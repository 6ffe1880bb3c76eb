// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <optional>

#include "core/time/time.hpp"

namespace adit::agent {

/// Limits the new findings of programs on the robot: kBurst at once, then one each second.
class ReportRate {
 public:
  static constexpr int kBurst = 20;

  /// Whether one more may be reported now; then it counts.
  bool take(Time now) {
    if (filled_) tokens_ = std::min<double>(kBurst, tokens_ + seconds(now - *filled_));
    filled_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

 private:
  double tokens_{kBurst};
  std::optional<Time> filled_{};
};

}  // namespace adit::agent
