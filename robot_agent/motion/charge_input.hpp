// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/result/result.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Judges the charge that a driver sends. The type says 0 to 1, but many drivers send percent. A percentage
/// of 0.8 may be either, so a participant that once sent more than 1 is not believed any more.
class ChargeInput {
 public:
  static constexpr float kUnknown = -1.0f;
  static constexpr float kMost = 1.01f;  ///< Full, with the error of a sensor.

  /// The charge, [0, 1]; kUnknown for NaN, by which a driver says that it does not measure it. Error:
  /// out_of_range.
  Result<float> take(float percentage, const wire::ParticipantId& sender) {
    if (sender != sender_) in_percent_ = false;
    sender_ = sender;
    if (std::isnan(percentage)) return kUnknown;
    in_percent_ = in_percent_ || percentage > kMost;
    if (in_percent_ || percentage < 0) {
      char text[160];
      std::snprintf(
          text, sizeof text,
          "the charge on /battery_state is %.4g%s: `percentage` goes from 0 to 1; the charge counts "
          "as unknown",
          static_cast<double>(percentage), in_percent_ ? ", as if it were percent" : "");
      return Error{Reason::out_of_range, text};
    }
    return std::min(percentage, 1.0f);
  }

 private:
  wire::ParticipantId sender_{};
  bool in_percent_{false};
};

}  // namespace adit::agent
