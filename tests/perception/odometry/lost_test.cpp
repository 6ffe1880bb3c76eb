// SPDX-License-Identifier: Apache-2.0
// A body that is elsewhere than its odometry believes.
#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "perception/odometry/lidar_odometry.hpp"

namespace adit::perception {
namespace {

/// A box, m: from `low` to `high`.
struct Hall {
  Eigen::Vector3d low, high;
};
const Hall kRoom{{-4, -3, -0.5}, {4, 3, 2.5}};

/// A body that stands or is moved, in a hall of its own, with clouds and perhaps wheels.
struct MovedBody {
  explicit MovedBody(bool has_wheels = false) : wheels(has_wheels), odometry(params(has_wheels)) {}
  static LidarOdometryParams params(bool wheels) {
    LidarOdometryParams out = LidarOdometryParams::clouds_only(0.02, 0.3, 60);
    out.motion.has_wheels = out.registration.has_prior = wheels;
    return out;
  }
  std::vector<Eigen::Vector3f> cloud(const Hall& hall, const Pose3& at) {
    std::vector<Eigen::Vector3f> points;
    const Pose3 T_base_hall = at.inverse();
    const Eigen::Vector3d size = hall.high - hall.low;
    const double areas[3]{size.y() * size.z(), size.x() * size.z(), size.x() * size.y()};
    for (int n = 0; n < 3000; ++n) {
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(hall.low[axis], hall.high[axis]);
      const double which = random.uniform(0, areas[0] + areas[1] + areas[2]);
      const int side = which < areas[0] ? 0 : which < areas[0] + areas[1] ? 1 : 2;
      p[side] = (random.chance(0.5) ? hall.low : hall.high)[side] + random.uniform(-0.02, 0.02);
      points.push_back((T_base_hall * p).cast<float>());
    }
    return points;
  }
  /// One sweep in a hall; `rolled`: the pose by the wheels.
  const OdometryState& sweep(const Hall& hall, const Pose3& at, const Pose3& rolled = {}) {
    stamp += period;
    if (wheels) odometry.add(BodyMotion{stamp, rolled});
    odometry.advance(stamp);
    return odometry.update(cloud(hall, at));
  }

  bool wheels;
  LidarOdometry odometry;
  Random random{1};
  std::uint64_t period{100'000'000};  ///< Of the sweeps, ns.
  std::uint64_t stamp{1'000'000'000'000};
};

TEST(Lost, ABodyThatSlidIsNeverOkByItself) {
  for (const bool wheels : {false, true}) {
    SCOPED_TRACE(wheels ? "wheels" : "clouds alone");
    MovedBody body(wheels);
    for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
    ASSERT_EQ(body.odometry.state().health, Localisation::ok);
    const Pose3 slid = Pose3::level({1.8, 1.2, 0.7}, 0);
    bool was_lost = false;
    for (int n = 0; n < 100; ++n) {
      const OdometryState& state = body.sweep(kRoom, slid);
      was_lost = was_lost || state.health == Localisation::lost;
      if (n < 2) continue;
      ASSERT_NE(state.health, Localisation::ok) << n;
      ASSERT_GE(5 * state.sigma(), (slid.position - state.pose.position).norm()) << n;
      ASSERT_GE(5 * std::sqrt(state.covariance(5, 5)), std::abs(slid.yaw() - state.pose.yaw())) << n;
    }
    EXPECT_TRUE(was_lost);
    EXPECT_TRUE(body.odometry.state().unplaced);
    // Somebody says where it is.
    const Pose3 correction = slid * body.odometry.state().pose.inverse();
    body.odometry.relocalised(correction, 0.1, 0.02);
    for (int n = 0; n < 10; ++n) body.sweep(kRoom, slid);
    const OdometryState& state = body.odometry.state();
    EXPECT_EQ(state.health, Localisation::ok);
    EXPECT_FALSE(state.unplaced);
    EXPECT_LT((slid.position - state.pose.position).norm(), 0.05);
    EXPECT_NEAR(state.sigma(), 0.1, 0.02);
  }
}

TEST(Lost, AnotherHallIsNotTakenForTheFirst) {
  const Hall halls[]{{{-12, -9, -0.5}, {12, 9, 5.5}},
                     {{-12, -9, -0.5}, {12, 9, 2.5}},
                     {{-1.5, -1.2, -0.5}, {1.6, 1.4, 2.5}}};
  for (const Hall& other : halls)
    for (const bool wheels : {false, true}) {
      SCOPED_TRACE(std::to_string(other.high.x()) + " x " + std::to_string(other.high.z()) +
                   (wheels ? " wheels" : " clouds alone"));
      MovedBody body(wheels);
      for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
      Pose3 rolled{};
      for (int n = 0; n < 40; ++n) {
        // It stands, and then it drives.
        if (n >= 10) rolled.position.x() += other.high.x() > 2 ? 0.1 : 0.02;
        const OdometryState& state = body.sweep(other, rolled, rolled);
        if (n < 2) continue;
        ASSERT_NE(state.health, Localisation::ok) << n;
        ASSERT_GT(state.sigma(), 0.5) << n;
      }
      EXPECT_EQ(body.odometry.state().health, Localisation::lost);
      // The first hall is still what it was, and is found again.
      for (int n = 0; n < 10; ++n) body.sweep(kRoom, body.odometry.state().pose, rolled);
      EXPECT_EQ(body.odometry.state().health, Localisation::ok);
      EXPECT_LT(body.odometry.state().sigma(), 0.1);
    }
}

TEST(Lost, ANewMapBeginsAfterFiveSecondsWhateverTheRate) {
  for (const std::uint64_t period : {50'000'000U, 100'000'000U, 150'000'000U, 200'000'000U}) {
    MovedBody body(true);
    body.period = period;
    for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
    const std::uint64_t moved_at = body.stamp;
    while (!body.odometry.state().unplaced && body.stamp < moved_at + 20'000'000'000)
      body.sweep(kRoom, Pose3::level({1.8, 1.2, 0.7}, 0));
    const double seconds = static_cast<double>(body.stamp - moved_at) * 1e-9;
    EXPECT_NEAR(seconds, 5.0, 1.01 * static_cast<double>(period) * 1e-9) << period;
  }
}

TEST(Lost, ACorrectionOfAPoseBeforeAStepIsRefused) {
  const Pose3 slid = Pose3::level({1.8, 1.2, 0.7}, 0);
  // It was applied before, or the robot has found its place itself meanwhile.
  for (const bool twice : {true, false}) {
    SCOPED_TRACE(twice ? "twice" : "found itself");
    MovedBody body(true);
    for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
    EXPECT_EQ(body.odometry.state().steps, 0U);
    for (int n = 0; n < 80; ++n) body.sweep(kRoom, slid);
    ASSERT_TRUE(body.odometry.state().unplaced);
    const std::uint32_t steps = body.odometry.state().steps;
    const Pose3 correction = slid * body.odometry.state().pose.inverse();
    if (twice) {
      EXPECT_TRUE(body.odometry.relocalised(correction, 0.1, 0.02, steps));
      EXPECT_EQ(body.odometry.state().relocalised, 1U);
      for (int n = 0; n < 10; ++n) body.sweep(kRoom, slid);
    } else {
      // It comes back into what it saw first.
      for (int n = 0; n < 60; ++n) body.sweep(kRoom, Pose3{});
      EXPECT_EQ(body.odometry.state().relocalised, 0U);
    }
    const Pose3 at = body.odometry.state().pose;
    ASSERT_EQ(body.odometry.state().health, Localisation::ok);
    EXPECT_FALSE(body.odometry.relocalised(correction, 0.1, 0.02, steps));
    EXPECT_EQ(body.odometry.state().pose.position, at.position);
    EXPECT_TRUE(body.odometry.relocalised({}, 0.1, 0.02, body.odometry.state().steps));
  }
}

TEST(Lost, ACorrectionIsRefusedWhenThePoseWasDrawnToTheMapMeanwhile) {
  MovedBody body(false);
  for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
  const Hall dust{{-1, -1, -0.3}, {1.1, 1.2, 1}};
  for (int n = 0; n < 10; ++n) body.sweep(dust, Pose3{});
  ASSERT_EQ(body.odometry.state().health, Localisation::lost);
  const std::uint32_t steps = body.odometry.state().steps;
  body.sweep(kRoom, Pose3::level({0.3, 0, 0}, 0));
  ASSERT_EQ(body.odometry.state().health, Localisation::lost);
  ASSERT_NEAR(body.odometry.state().pose.position.x(), 0.3, 0.05);
  EXPECT_FALSE(body.odometry.relocalised(Pose3::level({0.3, 0, 0}, 0), 0.1, 0.02, steps));
}

TEST(Lost, TheFirstMapIsFoundAgainAfterANewOneBegan) {
  MovedBody body(true);
  for (int n = 0; n < 30; ++n) body.sweep(kRoom, Pose3{});
  const Hall dust{{-1, -1, -0.3}, {1.1, 1.2, 1}};
  for (int n = 0; n < 80; ++n) body.sweep(dust, Pose3{});
  EXPECT_EQ(body.odometry.state().health, Localisation::weak);
  EXPECT_TRUE(body.odometry.state().unplaced);
  for (int n = 0; n < 60; ++n) body.sweep(kRoom, Pose3::level({0.3, 0, 0}, 0));
  EXPECT_EQ(body.odometry.state().health, Localisation::ok);
  EXPECT_FALSE(body.odometry.state().unplaced);
  EXPECT_NEAR(body.odometry.state().pose.position.x(), 0.3, 0.03);
  EXPECT_LT(body.odometry.state().sigma(), 0.1);
}

}  // namespace
}  // namespace adit::perception
