// SPDX-License-Identifier: Apache-2.0
#include "perception/input/isolated_returns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

constexpr int kRings = 16, kColumns = 900;

/// A sweep in a round room of `radius` m, column by column. `dust`: share of the beams that end before it.
Sweep round_room(double radius, double dust, Random& random, std::vector<bool>& phantom) {
  Sweep sweep;
  phantom.clear();
  for (int column = 0; column < kColumns; ++column)
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = 2 * M_PI * column / kColumns, slope = std::tan((2 * ring - 15) * M_PI / 180);
      phantom.push_back(random.chance(dust));
      const double far =
          (phantom.back() ? random.uniform(0.5, radius - 1) : radius) + random.uniform(-0.03, 0.03);
      sweep.points.push_back(
          {Eigen::Vector3d(far * std::cos(azimuth), far * std::sin(azimuth), far * slope).cast<float>(), 0.0f,
           0.0f, static_cast<std::uint16_t>(ring)});
    }
  return sweep;
}

TEST(IsolatedReturns, FindsDustAndKeepsWalls) {
  Random random(1);
  std::vector<bool> phantom;
  const Sweep sweep = round_room(8, 0.05, random, phantom);
  IsolatedReturns returns;
  const auto& isolated = returns.find(sweep);
  ASSERT_EQ(isolated.size(), sweep.points.size());
  int found = 0, dust = 0, wrong = 0;
  for (std::size_t n = 0; n < isolated.size(); ++n) {
    dust += phantom[n];
    found += phantom[n] && isolated[n] != 0;
    wrong += !phantom[n] && isolated[n] != 0;
  }
  EXPECT_GT(found, 0.8 * dust);
  EXPECT_EQ(wrong, 0);
}

/// A sweep of a lidar that scans a rosette with four lines in one plane, as Livox's do, in a furnished room:
/// walls of a box and twelve pillars.
Sweep rosette(Random& random) {
  Sweep sweep;
  constexpr int kPoints = 20'000, kLines = 4;
  for (int n = 0; n < kPoints; ++n) {
    const double t = 0.1 * n / kPoints;
    const double out = 0.6 * std::cos(2 * M_PI * 93.7 * t), about = 2 * M_PI * 61.3 * t + 0.01 * (n % kLines);
    Eigen::Vector3d ray(1.0, std::tan(out) * std::cos(about), std::tan(out) * std::sin(about));
    ray.normalize();
    double range = std::min(8 / ray.x(), ray.y() != 0 ? 5 / std::abs(ray.y()) : 1e9);
    range = std::min(range, ray.z() < 0 ? 1.2 / -ray.z() : ray.z() > 0 ? 2.0 / ray.z() : 1e9);
    for (int pillar = 0; pillar < 12; ++pillar) {
      const Eigen::Vector2d at(2 + 0.45 * pillar, (pillar % 2 ? 1 : -1) * (0.4 + 0.1 * pillar));
      const Eigen::Vector2d flat = ray.head<2>().normalized();
      const double along = at.dot(flat), aside = std::abs(at.x() * flat.y() - at.y() * flat.x());
      if (aside < 0.1) range = std::min(range, along / ray.head<2>().norm());
    }
    sweep.points.push_back({(ray * (range + random.uniform(-0.02, 0.02))).cast<float>(), 0.0f, 0.0f,
                            static_cast<std::uint16_t>(n % kLines)});
  }
  return sweep;
}

TEST(IsolatedReturns, LinesOfARosetteAreNoRings) {
  Random random(4);
  const Sweep sweep = rosette(random);
  IsolatedReturns returns;
  const auto& isolated = returns.find(sweep);
  const auto wrong = std::count(isolated.begin(), isolated.end(), 1);
  EXPECT_LT(static_cast<double>(wrong), 0.05 * static_cast<double>(sweep.points.size()));
}

TEST(IsolatedReturns, AMaskOfTooManyIsNone) {
  Random random(5);
  std::vector<bool> phantom;
  const Sweep sweep = round_room(20, 0.7, random, phantom);
  IsolatedReturns returns;
  EXPECT_TRUE(returns.find(sweep).empty());
  EXPECT_TRUE(returns.scattered());
}

TEST(IsolatedReturns, ASweepWithoutRingsHasNone) {
  Random random(2);
  std::vector<bool> phantom;
  Sweep sweep = round_room(8, 0.05, random, phantom);
  for (TimedPoint& p : sweep.points) p.ring = 0;
  EXPECT_TRUE(IsolatedReturns().find(sweep).empty());
  EXPECT_TRUE(IsolatedReturns().find(Sweep{}).empty());
}

TEST(IsolatedReturns, SurvivesBrokenSweeps) {
  Random random(3);
  IsolatedReturns returns;
  for (int n = 0; n < 300; ++n) {
    Sweep sweep;
    for (std::uint64_t k = random.below(400); k > 0; --k) {
      const auto any = [&] {
        if (random.chance(0.1)) return std::numeric_limits<float>::quiet_NaN();
        if (random.chance(0.1)) return std::numeric_limits<float>::infinity();
        if (random.chance(0.1)) return 0.0f;
        return static_cast<float>(random.uniform(-1, 1) * (random.chance(0.1) ? 1e30 : 20));
      };
      sweep.points.push_back({{any(), any(), any()},
                              any(),
                              any(),
                              static_cast<std::uint16_t>(random.below(random.chance(0.01) ? 65536 : 40))});
    }
    const auto& isolated = returns.find(sweep);
    EXPECT_TRUE(isolated.empty() || isolated.size() == sweep.points.size());
  }
}

}  // namespace
}  // namespace adit::perception
