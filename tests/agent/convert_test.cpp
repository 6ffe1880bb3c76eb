// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <gtest/gtest.h>

namespace adit::agent {
namespace {

TEST(Convert, CapabilitiesNameTheSteepestSlope) {
  Platform platform{};
  platform.max_slope = 1.0;
  EXPECT_NEAR(capabilities_of(platform, "r1", {}, 1, ModeTable::shipped()).max_slope, 0.785, 1e-3);
}

}  // namespace
}  // namespace adit::agent
