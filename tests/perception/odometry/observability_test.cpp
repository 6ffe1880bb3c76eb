// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/observability.hpp"

#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "perception/odometry/so3.hpp"

namespace adit::perception {
namespace {

struct Residuals {
  std::vector<ResidualDirection> all{};
  Eigen::Matrix<double, 6, 6> information{Eigen::Matrix<double, 6, 6>::Zero()};

  void add(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal, double sigma = 0.03) {
    const double weight = 1 / (sigma * sigma);
    all.push_back({normal.cast<float>(), arm.cast<float>(), static_cast<float>(weight)});
    Eigen::Matrix<double, 6, 1> J;
    J << normal, arm.cross(normal);
    information += weight * J * J.transpose();
  }
  Localizability judged() const { return judge(information, all, 4.0, {}); }
};

/// Walls beside, floor and ceiling; normals scatter by a degree, as of real planes.
Residuals corridor_residuals(bool with_end) {
  Residuals r;
  Random random(5);
  const auto scatter = [&] {
    return Eigen::Vector3d(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                           random.uniform(-0.02, 0.02));
  };
  for (int n = 0; n < 400; ++n) {
    const double x = random.uniform(-10, 10);
    r.add({x, 1.5, random.uniform(-0.5, 2)}, (Eigen::Vector3d::UnitY() + scatter()).normalized());
    r.add({x, -1.5, random.uniform(-0.5, 2)}, (Eigen::Vector3d::UnitY() + scatter()).normalized());
    r.add({x, random.uniform(-1.5, 1.5), -0.5}, (Eigen::Vector3d::UnitZ() + scatter()).normalized());
  }
  for (int n = 0; with_end && n < 60; ++n)
    r.add({10, random.uniform(-1.5, 1.5), random.uniform(-0.5, 2)}, Eigen::Vector3d::UnitX());
  return r;
}

TEST(Observability, ASmoothCorridorLeavesItsAxisOpen) {
  const Localizability found = corridor_residuals(false).judged();
  EXPECT_EQ(found.t[0], Observability::none);
  EXPECT_GT(std::abs(found.axes_t.col(0).x()), 0.99);
  EXPECT_EQ(found.t[1], Observability::strong);
  EXPECT_EQ(found.t[2], Observability::strong);
  for (const Observability r : found.r) EXPECT_EQ(r, Observability::strong);
}

TEST(Observability, FarFloorAndCeilingDetermineTheRollInACorridor) {
  // They are 10 to 28 m ahead and behind, 1.3 m beside the axis at most: a long arm, of which little is a
  // lever.
  Residuals r = corridor_residuals(true);
  r.all.clear();
  r.information.setZero();
  Random random(8);
  for (int n = 0; n < 600; ++n) {
    const double x = (n % 2 == 0 ? 1 : -1) * random.uniform(10, 28), y = random.uniform(-1.3, 1.3);
    r.add({x, y, -0.5}, Eigen::Vector3d::UnitZ());
    r.add({x, y, 2.5}, Eigen::Vector3d::UnitZ());
    r.add({x, 1.3, random.uniform(-0.4, 0.4)}, Eigen::Vector3d::UnitY());
  }
  const Localizability found = r.judged();
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(found.axes_r(0, axis)) > 0.9) {
      EXPECT_EQ(found.r[static_cast<std::size_t>(axis)], Observability::strong) << found.sigma_r[axis];
    }
}

TEST(Observability, AnEndWallClosesIt) {
  const Localizability found = corridor_residuals(true).judged();
  for (const Observability t : found.t) EXPECT_EQ(t, Observability::strong);
}

TEST(Observability, AFloorAloneLeavesThreeDirectionsOpen) {
  Residuals r;
  Random random(6);
  for (int n = 0; n < 500; ++n)
    r.add({random.uniform(-8, 8), random.uniform(-8, 8), -0.5}, Eigen::Vector3d::UnitZ());
  const Localizability found = r.judged();
  int open = 0;
  for (std::size_t n = 0; n < 3; ++n)
    open += (found.t[n] == Observability::none) + (found.r[n] == Observability::none);
  EXPECT_EQ(open, 3);
}

TEST(Observability, NothingSeenDeterminesNothing) {
  const Localizability found = Residuals{}.judged();
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(found.t[n], Observability::none);
    EXPECT_EQ(found.r[n], Observability::none);
  }
}

}  // namespace
}  // namespace adit::perception
