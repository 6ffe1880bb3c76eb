// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/place_agreement.hpp"

#include <gtest/gtest.h>

namespace adit::agent {
namespace {

const Pose3 kGuess = Pose3::level({5, 1, 0.5}, 0);
const Pose3 kFound = Pose3::level({2, -1, 0.3}, 0);

TEST(PlaceAgreement, TakesTwoResultsThatSayTheSame) {
  PlaceAgreement agreement;
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));
  EXPECT_TRUE(agreement.agrees(Pose3::level({2.1, -1, 0.3}, 0), kGuess, {0, 3}));
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));  // It begins again.
}

TEST(PlaceAgreement, TwoResultsThatDifferAreNone) {
  PlaceAgreement agreement;
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));
  EXPECT_FALSE(agreement.agrees(Pose3::level({2.6, -1, 0.3}, 0), kGuess, {0, 3}));
  EXPECT_FALSE(agreement.agrees(Pose3::level({2.6, -1, 0.5}, 0), kGuess, {0, 3}));
}

TEST(PlaceAgreement, AResultOfAnotherFrameIsNoFirstOne) {
  PlaceAgreement agreement;
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 4}));  // The pose jumped.
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {1, 4}));  // The odometry began again.
  EXPECT_TRUE(agreement.agrees(kFound, kGuess, {1, 4}));
}

TEST(PlaceAgreement, AScanThatFindsNothingIsBetweenTheTwo) {
  PlaceAgreement agreement;
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));
  agreement.reset();
  EXPECT_FALSE(agreement.agrees(kFound, kGuess, {0, 3}));
}

}  // namespace
}  // namespace adit::agent
