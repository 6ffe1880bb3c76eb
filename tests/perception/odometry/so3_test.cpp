// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/so3.hpp"

#include <gtest/gtest.h>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

TEST(RotationBetween, TurnsOneDirectionIntoTheOther) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d from(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Eigen::Vector3d to(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    const Eigen::Quaterniond turn = rotation_between(from, to);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-9);
    EXPECT_NEAR(log_so3(turn).norm(), std::acos(from.normalized().dot(to.normalized())), 1e-6);
  }
}

TEST(RotationBetween, OppositeDirectionsAreHalfATurnApart) {
  for (const Eigen::Vector3d& from :
       {Eigen::Vector3d(0, 0, -9.81), Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(1, 2, 3)}) {
    const Eigen::Quaterniond turn = rotation_between(from, -from);
    EXPECT_NEAR(turn.norm(), 1, 1e-12);
    EXPECT_LT((turn * from + from).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace adit::perception
