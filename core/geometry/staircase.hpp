// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace adit {

/// A straight flight of equal steps, in a frame whose z points up.
struct Staircase {
  static constexpr int kLeastSteps = 3, kMostSteps = 100;
  static constexpr double kLeastRise = 0.10, kMostRise = 0.25;   ///< m
  static constexpr double kLeastRun = 0.20, kMostRun = 0.45;     ///< m
  static constexpr double kLeastWidth = 0.6, kMostWidth = 10.0;  ///< m

  /// Standard deviations, m and rad.
  struct Sigmas {
    double place{};  ///< Of `foot`, in each direction.
    double heading{}, rise{}, run{}, width{};
    bool operator==(const Sigmas&) const = default;
  };

  Eigen::Vector3d foot{Eigen::Vector3d::Zero()};  ///< Centre of the lowest riser's face, m.
  double heading{};                               ///< Direction of climbing about z, rad, (-pi, pi].
  double rise{};                                  ///< Height of a step, m.
  double run{};                                   ///< From riser to riser, m.
  double width{};                                 ///< Of the treads, m.
  int steps{};                                    ///< Risers.
  Sigmas sigma{};
  bool operator==(const Staircase&) const = default;

  /// Unit vector of climbing, horizontal.
  Eigen::Vector2d direction() const { return {std::cos(heading), std::sin(heading)}; }
  /// Centre of the highest riser's face, m.
  Eigen::Vector3d top() const {
    const double n = steps - 1;
    return foot + Eigen::Vector3d(n * run * std::cos(heading), n * run * std::sin(heading), n * rise);
  }
  double floor_below() const { return foot.z() - rise / 2; }
  double floor_above() const { return top().z() + rise / 2; }
};

/// Whether all values are finite and within the bounds above, and no standard deviation is negative.
inline bool valid(const Staircase& s) {
  const auto within = [](double value, double least, double most) { return value >= least && value <= most; };
  return s.foot.allFinite() && within(s.heading, -M_PI, M_PI) &&
         within(s.rise, Staircase::kLeastRise, Staircase::kMostRise) &&
         within(s.run, Staircase::kLeastRun, Staircase::kMostRun) &&
         within(s.width, Staircase::kLeastWidth, Staircase::kMostWidth) &&
         s.steps >= Staircase::kLeastSteps && s.steps <= Staircase::kMostSteps &&
         within(s.sigma.place, 0.0, 10.0) && within(s.sigma.heading, 0.0, M_PI) &&
         within(s.sigma.rise, 0.0, 1.0) && within(s.sigma.run, 0.0, 1.0) && within(s.sigma.width, 0.0, 10.0);
}

}  // namespace adit
