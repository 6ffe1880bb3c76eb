// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/control/ilqr.hpp"

/// A tracking problem for each motion model, for tests and benchmarks.
namespace adit::nav::test {

inline constexpr double kWaveDt = 0.05;  ///< s

template <class Model>
struct Bench {
  static Model model() { return {}; }
  static typename Ilqr<Model>::Limits limits() {
    typename Ilqr<Model>::Limits limits{};
    limits.velocity.setConstant(1.5);
    limits.rate.setConstant(1.5);
    return limits;
  }
};
template <>
inline Ilqr<model::Car>::Limits Bench<model::Car>::limits() {
  return {{1.5, 0.6}, {1.5, 1.5}};
}

/// A wave along x at about `speed`, and the twist of a body on it.
inline Reference wave(double t, double speed) {
  const double x = speed * t, slope = 0.9 * std::cos(1.5 * x);
  const double v = speed * std::hypot(1.0, slope);
  const double bend = -1.35 * std::sin(1.5 * x) / std::pow(1 + slope * slope, 1.5);
  return {{x, 0.6 * std::sin(1.5 * x), std::atan(slope)}, {v, 0, bend * v}};
}

}  // namespace adit::nav::test
