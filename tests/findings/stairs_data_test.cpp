// SPDX-License-Identifier: Apache-2.0
#include "core/findings/stairs_data.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace adit::findings {
namespace {

Staircase six_steps() {
  return {.foot = {8.0, 2.5, 0.1},
          .heading = -3.1,
          .rise = 0.2,
          .run = 0.3,
          .width = 1.2345,
          .steps = 6,
          .sigma = {.place = 0.01, .heading = 0.02, .rise = 0.002, .run = 0.003, .width = 0.05}};
}

Finding finding_of(const Staircase& stairs) {
  return {.key = {"r1", 7},
          .kind = kStairs,
          .position = {stairs.foot.x(), stairs.foot.y(), stairs.foot.z()},
          .data = encode_stairs(stairs)};
}

TEST(StairsData, ComesBackWithinItsResolution) {
  const Staircase sent = six_steps();
  const auto got = stairs_of(finding_of(sent));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->foot, sent.foot);
  EXPECT_EQ(got->steps, 6);
  EXPECT_NEAR(got->heading, sent.heading, 1e-4);
  EXPECT_NEAR(got->rise, sent.rise, 1e-4);
  EXPECT_NEAR(got->run, sent.run, 1e-4);
  EXPECT_NEAR(got->width, sent.width, 1e-4);
  EXPECT_NEAR(got->sigma.width, 0.05, 1e-4);
}

TEST(StairsData, IsShortAtTheBoundsToo) {
  Staircase largest = six_steps();
  largest.width = Staircase::kMostWidth;
  largest.steps = Staircase::kMostSteps;
  largest.heading = M_PI;
  largest.sigma = {.place = 10.0, .heading = 3.0, .rise = 1.0, .run = 1.0, .width = 10.0};
  EXPECT_LE(encode_stairs(largest).size(), 32U);
  EXPECT_TRUE(stairs_of(finding_of(largest)));
  largest.heading = -M_PI;
  EXPECT_TRUE(stairs_of(finding_of(largest)));
}

TEST(StairsData, RefusesWhatIsNone) {
  const Finding good = finding_of(six_steps());
  for (std::size_t length = 0; length < good.data.size(); ++length) {
    Finding cut = good;
    cut.data.resize(length);
    EXPECT_FALSE(stairs_of(cut)) << length;
  }
  Finding longer = good;
  longer.data.push_back(0);
  EXPECT_EQ(stairs_of(longer).error().reason, Reason::malformed);
  Finding other = good;
  other.data[0] = 9;
  EXPECT_EQ(stairs_of(other).error().reason, Reason::wrong_protocol);
  other = good;
  other.kind = "person";
  EXPECT_EQ(stairs_of(other).error().reason, Reason::malformed);
  other = good;
  other.position[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(stairs_of(other));
  Staircase wrong = six_steps();
  wrong.rise = 0.5;
  EXPECT_FALSE(stairs_of(finding_of(wrong)));
  wrong = six_steps();
  wrong.steps = 2;
  EXPECT_FALSE(stairs_of(finding_of(wrong)));
  wrong = six_steps();
  wrong.sigma.rise = -0.1;
  EXPECT_FALSE(stairs_of(finding_of(wrong)));
}

}  // namespace
}  // namespace adit::findings
