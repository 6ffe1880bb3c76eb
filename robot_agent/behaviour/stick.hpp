// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// The last sample of the holder's stick, and its age.
class Stick {
 public:
  static constexpr Duration kFresh = 300ms;  ///< For an older sample, zero is sent.
  static constexpr Duration kPresent = 1s;   ///< Without a newer sample, manual modes fall to hold.

  void update(const Twist2& value, Time now) {
    value_ = value;
    at_ = now;
    known_ = true;
  }
  void forget() { known_ = false; }
  bool fresh(Time now) const { return known_ && now - at_ < kFresh; }
  bool present(Time now) const { return known_ && now - at_ < kPresent; }
  bool centred() const { return known_ && value_.zero(); }

 private:
  Twist2 value_{};
  Time at_{};
  bool known_{};
};

}  // namespace adit::agent
