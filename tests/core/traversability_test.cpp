// SPDX-License-Identifier: Apache-2.0
#include "core/config/traversability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/config/platform_file.hpp"

namespace adit {
namespace {

Traversability of(const char* name) {
  const auto platform = config::load_platform(name);
  EXPECT_TRUE(platform) << platform.error().text;
  return Traversability::of(*platform);
}

TEST(Traversability, is_derived_from_the_body) {
  struct Row {
    const char* name;
    double step, obstacle, slope, drop, headroom;
  };
  for (const Row& row :
       {Row{"wheeled", 0.08, 0.105, 0.35, 0.15, 0.65}, Row{"tracked", 0.15, 0.175, 0.5, 0.225, 0.70},
        Row{"legged", 0.22, 0.245, 0.22 / 0.28, 0.33, 0.80}}) {
    const Traversability limits = of(row.name);
    EXPECT_NEAR(limits.step, row.step, 1e-12) << row.name;
    EXPECT_NEAR(limits.obstacle, row.obstacle, 1e-12) << row.name;
    EXPECT_NEAR(limits.slope, row.slope, 1e-12) << row.name;
    EXPECT_NEAR(limits.drop, row.drop, 1e-12) << row.name;
    EXPECT_NEAR(limits.headroom, row.headroom, 1e-12) << row.name;
    EXPECT_GT(limits.drop, limits.step) << "what it can climb it can also go down";
    EXPECT_GT(limits.tilt, std::atan(limits.slope)) << "standing on the steepest ground is no danger";
  }
}

TEST(Traversability, a_noisier_lidar_sees_a_kerb_higher) {
  Platform platform;
  platform.step = 0.1;
  EXPECT_NEAR(Traversability::of(platform, 0.0).obstacle, 0.1, 1e-12);
  EXPECT_NEAR(Traversability::of(platform, 0.04).obstacle, 0.15, 1e-12);
  platform.lidars = {LidarConfig{}};
  platform.lidars[0].noise = 0.04;
  EXPECT_NEAR(Traversability::of(platform).obstacle, 0.15, 1e-12);
}

TEST(Traversability, the_tilt_may_stand_in_the_file) {
  Platform platform;
  platform.max_tilt = 0.4;
  EXPECT_EQ(Traversability::of(platform).tilt, 0.4);
}

}  // namespace
}  // namespace adit
