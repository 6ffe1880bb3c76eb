// SPDX-License-Identifier: Apache-2.0
#include "perception/input/turn_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace adit::perception {
namespace {

constexpr std::uint64_t kMilli = 1'000'000;

/// Turns at `rate` (rad/s) for `seconds`; the gyro measures `gain` times that, at 100 Hz, the odometry the
/// whole turn, at 20 Hz.
void turn_body(TurnCheck& check, double rate, double gain, double seconds,
               std::uint64_t start = 1000 * kMilli) {
  for (int n = 0; n < seconds * 100; ++n) {
    const std::uint64_t stamp = start + static_cast<std::uint64_t>(n) * 10 * kMilli;
    check.add_rate(stamp, gain * rate);
    if (n % 5 == 0) check.add_yaw(stamp, std::remainder(rate * n / 100, 2 * M_PI));
  }
}

TEST(TurnCheck, AgreesWithAGyroThatTurnsAsTheOdometry) {
  for (const double rate : {0.8, -0.8}) {
    TurnCheck check;
    turn_body(check, rate, 1.0, 10);
    EXPECT_EQ(check.refusal(), "") << rate;
    EXPECT_NEAR(check.ratio(), 1.0, 0.05) << rate;
  }
}

TEST(TurnCheck, RefusesTheWrongSignAndDegrees) {
  TurnCheck opposite, degrees;
  turn_body(opposite, 0.8, -1.0, 3);
  EXPECT_THAT(opposite.refusal(), testing::HasSubstr("opposite"));
  turn_body(degrees, 0.8, 180 / M_PI, 3);
  EXPECT_THAT(degrees.refusal(), testing::HasSubstr("57 times"));
  turn_body(opposite, 0.8, 1.0, 6, 20'000 * kMilli);
  EXPECT_EQ(opposite.refusal(), "") << "repaired";
}

TEST(TurnCheck, SlipAndNoiseAreNoMistake) {
  TurnCheck slips, stuck, stands, briefly;
  turn_body(slips, 1.0, 0.2, 10);
  EXPECT_EQ(slips.refusal(), "");
  turn_body(stuck, 1.0, 0.0, 10);
  EXPECT_EQ(stuck.refusal(), "");
  turn_body(stands, 0.01, -1.0, 400);
  EXPECT_EQ(stands.ratio(), 0) << "too slow to tell";
  turn_body(briefly, 0.8, -1.0, 1.5);
  EXPECT_EQ(briefly.refusal(), "") << "less than a quarter turn";
}

TEST(TurnCheck, ComparesNothingOverGapsAndOtherClocks) {
  TurnCheck check;
  for (std::uint64_t n = 1; n < 50; ++n) {
    check.add_rate(n * 1000 * kMilli, -1);
    check.add_yaw(n * 1000 * kMilli, 1.0 * static_cast<double>(n));
  }
  EXPECT_EQ(check.ratio(), 0);
  for (std::uint64_t n = 1; n < 500; ++n) {
    check.add_rate(n * 10 * kMilli, -1);
    check.add_yaw((n + 100'000) * 10 * kMilli, 0.01 * static_cast<double>(n));
  }
  EXPECT_EQ(check.ratio(), 0);
}

}  // namespace
}  // namespace adit::perception
