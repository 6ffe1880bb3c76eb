// SPDX-License-Identifier: Apache-2.0
// What a simulated camera sees: geometry, bodies, and that the same place looks the same.
#include "sim/world/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "sim/world/simulation.hpp"

namespace adit::sim {
namespace {

/// A room of 20 x 20 m and 3 m height around (0, 0), with a wall of 2 m width and 1 m height, 4 m ahead.
std::shared_ptr<const World> camera_room() {
  const std::array<Box, 5> boxes{Box{-10.5, 10.5, -10.5, -10, 0, 3}, Box{-10.5, 10.5, 10, 10.5, 0, 3},
                                 Box{-10.5, -10, -10, 10, 0, 3}, Box{10, 10.5, -10, 10, 0, 3},
                                 Box{4, 4.2, -1, 1, 0, 1}};
  return std::make_shared<const World>(*make_box_world(boxes, 0, 3));
}

PictureJob job_at(double x, double y, double yaw = 0.0, double pitch = 0.0) {
  PictureJob job;
  job.world = camera_room();
  job.T_world_camera = {
      {x, y, 0.5},
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY())};
  job.width = 160;
  job.height = 120;
  job.field_of_view = 1.2;
  job.grain = 0.0;
  job.seed = 7;
  return job;
}

std::array<int, 3> pixel(const CameraImage& image, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// The mean difference of two pictures' bytes.
double mean_difference(const CameraImage& a, const CameraImage& b) {
  EXPECT_EQ(a.rgb.size(), b.rgb.size());
  double sum = 0.0;
  for (std::size_t n = 0; n < a.rgb.size(); ++n) sum += std::abs(a.rgb[n] - b.rgb[n]);
  return sum / static_cast<double>(a.rgb.size());
}

/// Pixels that differ between a picture and the same one without the bodies: columns and rows from, to.
struct Changed {
  int left{10000}, right{-1}, top{10000}, bottom{-1};
};
Changed changed(const PictureJob& job) {
  PictureJob empty = job;
  empty.bodies.clear();
  const CameraImage with = job.render(), without = empty.render();
  Changed out;
  for (int y = 0; y < job.height; ++y)
    for (int x = 0; x < job.width; ++x)
      if (pixel(with, x, y) != pixel(without, x, y))
        out = {std::min(out.left, x), std::max(out.right, x), std::min(out.top, y), std::max(out.bottom, y)};
  return out;
}

/// A body of 1 x 2 x 1 m whose front is `ahead` metres before the camera's ground point; 0.5 m is its middle.
VisibleBody block_ahead(double ahead, double left = 0.0) {
  return {BodyKind::robot, {{ahead + 0.5, left, 0}, 0.0, 1.0, 2.0, 1.0}};
}

TEST(Camera, TheSamePlaceGivesTheSamePictureByteForByte) {
  PictureJob job = job_at(0, 0);
  job.grain = 2.0;
  EXPECT_EQ(job.render().rgb, job.render().rgb);
  const CameraImage first = job.render();
  job.seed = 8;
  EXPECT_NE(job.render().rgb, first.rgb) << "the noise has a seed";
  EXPECT_LT(mean_difference(job.render(), first), 4.0);
}

TEST(Camera, PicturesOfTwoPlacesDifferAndThoseOfNeighboursLittle) {
  const CameraImage here = job_at(0, 0).render();
  const double near = mean_difference(here, job_at(0.01, 0).render());
  const double far = mean_difference(here, job_at(-5, 3).render());
  EXPECT_GT(near, 0.0);
  EXPECT_LT(near, 5.0);
  EXPECT_GT(far, 3.0 * near);
  EXPECT_GT(mean_difference(here, job_at(0, 0, 2.0).render()), 3.0 * near);
}

TEST(Camera, ABodyAtAKnownDistanceCoversTheRightPixels) {
  // 2 m wide at 4 m: 1 / 4 of the focal length to each side; 0.5 m up and down: 1 / 8.
  const double focal = 80.0 / std::tan(0.6);
  PictureJob job = job_at(-8, 5);
  job.bodies = {block_ahead(-4, 5)};
  const Changed at = changed(job);
  EXPECT_NEAR(at.left, 80 - focal / 4, 1.01);
  EXPECT_NEAR(at.right, 80 + focal / 4 - 1, 1.01);
  EXPECT_NEAR(at.top, 60 - focal / 8, 1.01);
  EXPECT_NEAR(at.bottom, 60 + focal / 8 - 1, 1.01);
  // Twice as far it is half as large; to the left it is at the left.
  job.bodies = {block_ahead(0, 5)};
  EXPECT_NEAR(changed(job).right, 80 + focal / 8 - 1, 1.01);
  job.bodies = {block_ahead(-4, 7)};
  EXPECT_NEAR(changed(job).right, 80 - focal / 5 - 1, 1.01) << "the far end of its side, 1 m to the left";
  // A larger picture, with fewer rays, shows it at the same place.
  job.bodies = {block_ahead(-4, 5)};
  job.width = 640;
  job.height = 480;
  const Changed large = changed(job);
  EXPECT_NEAR(large.left, 4 * (80 - focal / 4), 2.01);
  EXPECT_NEAR(large.bottom, 4 * (60 + focal / 8) - 1, 2.01);
}

TEST(Camera, AWallOfTheWorldIsWhereItsCornersAre) {
  // A wall 4 m ahead, from 0.5 m below to 0.5 m above the camera, against a world without it.
  const std::array<Box, 1> wall{Box{4, 4.2, -1, 1, 0, 1}};
  PictureJob with = job_at(0, 0), without = job_at(0, 0);
  with.world = std::make_shared<const World>(*make_box_world(wall, 0, 3));
  without.world = std::make_shared<const World>(*make_box_world(std::span<const Box>{}, 0, 3));
  const CameraImage a = with.render(), b = without.render();
  const double focal = 80.0 / std::tan(0.6);
  const auto differs = [&](double x, double y) {
    return pixel(a, static_cast<int>(x), static_cast<int>(y)) !=
           pixel(b, static_cast<int>(x), static_cast<int>(y));
  };
  EXPECT_TRUE(differs(80, 60 - focal / 8 + 2));
  EXPECT_FALSE(differs(80, 60 - focal / 8 - 3));
  EXPECT_TRUE(differs(80, 60 + focal / 8 - 2));
  EXPECT_FALSE(differs(80, 60 + focal / 8 + 3));
  EXPECT_TRUE(differs(80 - focal / 4 + 2, 60));
  EXPECT_FALSE(differs(80 - focal / 4 - 3, 60));
}

TEST(Camera, ThePitchOfTheMountingMovesThePictureUp) {
  const double focal = 80.0 / std::tan(0.6);
  PictureJob job = job_at(-8, 5, 0.0, 0.2);
  job.bodies = {block_ahead(-4, 5)};
  const Changed at = changed(job);
  // The top edge is atan(1 / 8) above the horizon, which is 0.2 rad above the optical axis.
  EXPECT_NEAR(at.top, 60 - focal * std::tan(0.2 + std::atan(0.125)), 1.01);
  EXPECT_NEAR(at.bottom, 60 - focal * std::tan(0.2 - std::atan(0.125)) - 1, 1.01);
}

TEST(Camera, ASmallerFieldOfViewMagnifies) {
  PictureJob job = job_at(-8, 5);
  job.bodies = {block_ahead(0, 5)};
  job.field_of_view = 0.4;
  const double focal = 80.0 / std::tan(0.2);
  EXPECT_NEAR(changed(job).left, 80 - focal / 8, 1.01);
}

TEST(Camera, WhatIsBehindAWallIsNotSeen) {
  PictureJob job = job_at(-8, 5);
  job.bodies = {{BodyKind::robot, {{13.0, 5.0, 0.0}, 0.0, 1.0, 1.0, 1.0}}};
  EXPECT_EQ(changed(job).right, -1);
}

TEST(Camera, FloorWallAndCeilingDifferInBrightness) {
  const CameraImage image = job_at(-8, 5).render();
  const auto brightness = [&](int from, int to) {
    double sum = 0.0;
    for (int y = from; y < to; ++y)
      for (int x = 0; x < image.width; ++x) sum += pixel(image, x, y)[1];
    return sum / (to - from) / image.width;
  };
  EXPECT_GT(brightness(0, 20), brightness(100, 120) + 15.0) << "a floor is darker than a ceiling";
}

TEST(Camera, InsideSomethingSolidItIsBlack) {
  PictureJob job = job_at(4.1, 0);
  const CameraImage image = job.render();
  EXPECT_EQ(std::count(image.rgb.begin(), image.rgb.end(), 0), static_cast<std::ptrdiff_t>(image.rgb.size()));
}

/// Whether a picture has a pixel that is far more red than blue and green (an orange robot), or blue.
bool shows(const CameraImage& image, BodyKind kind) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto [r, g, b] = pixel(image, x, y);
      if (kind == BodyKind::robot && r > 90 && r > 5 * b && r > g + 50) return true;
      if (kind == BodyKind::person && b > 60 && b > 2 * g && b > 3 * r) return true;
    }
  return false;
}

TEST(Camera, RobotsAndPeopleOfASimulationAreVisible) {
  Platform platform;
  platform.cameras = {CameraConfig{.width = 160, .height = 120}, CameraConfig{.width = 160, .height = 120}};
  platform.cameras[0].mounting = {.x = 0.3, .z = 0.5};
  platform.cameras[1].mounting = {.x = -0.3, .z = 0.5, .yaw = M_PI};
  SimulationParams params;
  params.people = {{{{-3.0, 5.0}, {-3.0, 5.1}}, 0.1, true}};
  const auto simulation = Simulation::create(
      camera_room(), {{"r1", platform, {-7, 5, 0}}, {"r2", Platform{}, {-5, 4.2, 0}}}, params);
  ASSERT_TRUE(simulation.ok()) << simulation.error().text;
  const CameraImage ahead = simulation->picture(0, 0).render(), behind = simulation->picture(0, 1).render();
  EXPECT_TRUE(shows(ahead, BodyKind::robot));
  EXPECT_TRUE(shows(ahead, BodyKind::person));
  EXPECT_FALSE(shows(behind, BodyKind::robot));
  EXPECT_FALSE(shows(behind, BodyKind::person));
  EXPECT_NE(simulation->picture(0, 0).seed, simulation->picture(0, 1).seed);
}

}  // namespace
}  // namespace adit::sim
