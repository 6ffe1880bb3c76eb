// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/contract/robot.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// Decides when stations must receive the followed route again: not while the robot drives along what they
/// have.
class RouteReport {
 public:
  static constexpr double kTolerance = 0.5;  ///< Deviation that is sent, m.
  static constexpr double kLearnt = 2.0;     ///< Unknown length that was seen meanwhile and is sent, m.
  static constexpr Duration kPeriod = 1s;    ///< Between two reports of one goal, at least.

  /// Whether to send `route` now; it then counts as sent. `stretch`: the periods are this many times as long,
  /// for thin links.
  bool due(const contract::Route& route, Time now, double stretch = 1.0);

 private:
  contract::Route sent_{};
  double sent_unknown_{};  ///< Length of its legs through unknown space, m.
  std::optional<Time> sent_at_{};
};

}  // namespace adit::agent
