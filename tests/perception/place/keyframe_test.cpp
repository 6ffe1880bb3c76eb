// SPDX-License-Identifier: Apache-2.0
#include "perception/place/keyframe.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

Keyframe wall_keyframe() {
  PointCloud points;
  for (float y = -5; y < 5; y += 0.1f)
    for (float z = 0; z < 2; z += 0.2f) points.emplace_back(4.0f, y, z);
  points.emplace_back(100.0f, 0.0f, 0.0f);
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
  return make_keyframe(points, Pose3::level({3, -2, 0.5}, 0.1), 7);
}

TEST(Keyframe, KeepsPointsWithinReachToTheMillimetre) {
  const Keyframe before = wall_keyframe();
  ASSERT_GT(before.points.size(), 300U);
  const auto after = decode_keyframe(encode(before));
  ASSERT_TRUE(after.ok()) << after.error().text;
  EXPECT_EQ(after->odom_epoch, 7U);
  EXPECT_TRUE(after->T_odom_base.position.isApprox(before.T_odom_base.position));
  ASSERT_EQ(after->points.size(), before.points.size());
  for (std::size_t n = 0; n < before.points.size(); ++n) {
    EXPECT_LT((after->points[n] - before.points[n]).norm(), 0.001f);
    EXPECT_LT(before.points[n].norm(), Keyframe::kReach);
  }
}

TEST(Keyframe, OfADenseCloudIsBounded) {
  Random random(3);
  PointCloud points;
  for (int n = 0; n < 60'000; ++n)
    points.emplace_back(
        Eigen::Vector3d(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(0, 9))
            .cast<float>());
  EXPECT_LE(make_keyframe(points, {}, 0).points.size(), Keyframe::kMaxPoints);
  EXPECT_LE(encode(make_keyframe(points, {}, 0)).size(), 55'000U);
}

TEST(Keyframe, RefusesDamagedBytes) {
  const auto good = encode(wall_keyframe());
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{61}, good.size() - 1})
    EXPECT_EQ(decode_keyframe(std::span(good).first(size)).reason(), Reason::malformed) << size;
  Random random(5);
  for (int n = 0; n < 2000; ++n) {
    auto bytes = good;
    for (int flip = 0; flip < 4; ++flip)
      bytes[static_cast<std::size_t>(random.uniform(0, 66))] = static_cast<std::uint8_t>(random.next());
    const auto read = decode_keyframe(bytes);
    if (!read) continue;
    EXPECT_TRUE(read->T_odom_base.position.allFinite());
    EXPECT_NEAR(read->T_odom_base.orientation.norm(), 1.0, 1e-3);
  }
}

}  // namespace
}  // namespace adit::perception
