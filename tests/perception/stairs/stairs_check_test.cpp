// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/stairs_check.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "tests/perception/stairs/scene.hpp"

namespace adit::perception {
namespace {

using scenes::Scene;
using Riser = StairsCheck::Riser;

const Staircase kSixSteps{.foot = {0.0, 0.0, 0.085}, .rise = 0.17, .run = 0.29, .width = 1.2, .steps = 6};

/// Six steps that climb along +x from the origin, and a robot 1.5 m before them.
Scene steps(bool exist = true) {
  Scene scene;
  scene.start = {-1.5, 0.0, 0.0};
  for (int k = 0; exist && k < 6; ++k)
    scenes::add_box(scene, k * 0.29, k == 5 ? 6.0 : (k + 1) * 0.29, -0.6, 0.6, 0.0, (k + 1) * 0.17);
  return scene;
}

StairsCheck checked(const Scene& scene, const Staircase& stairs) {
  Random random(1);
  const scenes::Cloud cloud =
      scenes::sense(scene, {.lidar = {.columns = 450}, .sweeps = 5, .speed = 0.0}, random);
  return check_stairs(scenes::seen_from(scene, stairs), std::array{StairsRays{cloud.eye, cloud.points}});
}

/// The same with this many steps more.
Staircase longer(int below, int above) {
  Staircase out = kSixSteps;
  out.steps += below + above;
  out.foot -= Eigen::Vector3d(below * out.run, 0.0, below * out.rise);
  return out;
}

TEST(StairsCheck, SeesTheFootAndThatTheFloorIsLevelBeforeIt) {
  const StairsCheck check = checked(steps(), kSixSteps);
  EXPECT_EQ(check.foot, Riser::there);
  EXPECT_EQ(check.below, Riser::level);
  EXPECT_GT(check.on, 200);
  EXPECT_FALSE(check.gone());
  EXPECT_EQ(checked(steps(), longer(1, 0)).foot, Riser::level) << "one too many";
  EXPECT_EQ(checked(steps(), longer(-1, 0)).below, Riser::there) << "one was missed";
}

TEST(StairsCheck, SeesFromTheTopThatTheLandingIsLevel) {
  Scene scene = steps();
  scene.start = {5 * 0.29 + 1.5, 0.0, M_PI};
  scene.ground = 6 * 0.17;
  EXPECT_EQ(checked(scene, kSixSteps).above, Riser::level);
  EXPECT_EQ(checked(scene, longer(0, 1)).top, Riser::level) << "one too many";
}

TEST(StairsCheck, FromTheFootTheLandingIsOutOfView) {
  Scene scene = steps();
  EXPECT_EQ(checked(scene, kSixSteps).above, Riser::unseen);
  // Mixed returns at the edge of the landing, behind and below it.
  std::vector<Eigen::Vector3f> points(100, {1.5f + 5.5f * 0.29f, 0.0f, 0.9f});
  points.resize(200, {1.5f + 4.5f * 0.29f, 0.0f, 0.85f});
  const Staircase stairs = scenes::seen_from(scene, kSixSteps);
  const auto top_from = [&](float height) {
    return check_stairs(stairs, std::array{StairsRays{{0.0f, 0.0f, height}, points}}).top;
  };
  EXPECT_EQ(top_from(0.65f), Riser::unseen);
  EXPECT_EQ(top_from(1.65f), Riser::level) << "seen from above it is ground";
}

TEST(StairsCheck, IsGoneWhenRaysPassThroughAllOfIt) {
  const StairsCheck check = checked(steps(false), kSixSteps);
  EXPECT_TRUE(check.gone()) << check.through << " through, " << check.on << " on";
}

TEST(StairsCheck, WhatStandsInFrontOfItDoesNotRemoveIt) {
  for (const bool exist : {false, true}) {
    Scene scene = steps(exist);
    scenes::add_box(scene, -0.5, -0.3, -3.0, 3.0, 0.0, 2.5);
    EXPECT_FALSE(checked(scene, kSixSteps).gone());
  }
  Scene person = steps();
  scenes::add_box(person, -0.6, -0.3, -0.25, 0.25, 0.0, 1.8);
  EXPECT_FALSE(checked(person, kSixSteps).gone());
}

TEST(StairsCheck, RaysWithoutReturnDoNotRemoveIt) {
  Scene scene = steps(false);
  scene.floor = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(checked(scene, kSixSteps).gone());
}

TEST(StairsCheck, TreadsOfGratingStay) {
  Scene scene = steps(false);
  for (int k = 0; k < 6; ++k) {
    scenes::add_box(scene, k * 0.29, (k + 1) * 0.29, -0.6, 0.6, (k + 1) * 0.17 - 0.03, (k + 1) * 0.17);
    scene.solids.back().passes = 0.5;
  }
  const StairsCheck check = checked(scene, kSixSteps);
  EXPECT_FALSE(check.gone()) << check.through << " through, " << check.on << " on";
}

}  // namespace
}  // namespace adit::perception
