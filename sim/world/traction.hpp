// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "core/geometry/pose.hpp"
#include "sim/world/active.hpp"

namespace adit::sim {

/// Faults between a robot's drive and the ground that are active now. They overlap freely: the end of one
/// leaves the others as they are.
class Traction {
 public:
  /// The drive is stationary and ignores commands.
  void jam(bool begins) { jams_ += begins ? 1 : -1; }
  /// The body is stuck and its wheels turn at `wheels` (body frame, m/s and rad/s), whatever is commanded. Of
  /// several slips the newest determines the wheels.
  void slip(const Twist2& wheels, bool begins) { change_active(slips_, wheels, begins); }
  /// The body turns by this share, [0, 1], less than its wheels say.
  void turn_slip(double share, bool begins) { change_active(turn_slips_, share, begins); }

  /// Whether the body stays where it is.
  bool holds() const { return jams_ > 0 || !slips_.empty(); }
  /// What the wheels of a stuck body turn at.
  std::optional<Twist2> spin() const {
    return slips_.empty() ? std::nullopt : std::optional<Twist2>(slips_.back());
  }
  /// Share of the wheels' turn by which the body turns, [0, 1].
  double turn_share() const {
    return std::transform_reduce(turn_slips_.begin(), turn_slips_.end(), 1.0, std::multiplies<>(),
                                 [](double lost) { return 1.0 - lost; });
  }

 private:
  int jams_{};
  std::vector<Twist2> slips_{};
  std::vector<double> turn_slips_{};
};

}  // namespace adit::sim
