// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/layer_marks.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/gui/floor_fixture.hpp"

namespace adit::gui {
namespace {

/// From above, 10 pixels per m.
std::optional<Point> from_above(const Point3& place) { return Point{10 * place.x, -10 * place.y}; }

station::FoundReport three_findings() {
  station::FoundReport report;
  report.findings = {
      {.number = 7, .kind = "person", .position = {3, 4, 0}},
      {.number = 8, .kind = "gas", .position = {5, 4, 0}, .verdict = station::Verdict::confirmed},
      {.number = 9, .kind = "gas", .position = {7, 4, 0}, .verdict = station::Verdict::rejected}};
  return report;
}

std::vector<std::string> texts(const MarkList& marks) {
  std::vector<std::string> out;
  for (const MapLabel& label : marks.labels) out.push_back(label.text);
  return out;
}

TEST(Findings, StandAtTheirPlacesAndTheConfirmedOnesAreFilled) {
  const station::FoundReport found = three_findings();
  const MarkList marks = layer_marks({.found = &found, .project = from_above});
  ASSERT_EQ(marks.shapes.size(), 2U) << "none for the rejected one";
  EXPECT_EQ(marks.shapes[0].points.size(), 10U);
  EXPECT_NEAR(marks.shapes[0].points[0].x, 30, 1e-9);
  EXPECT_LT(marks.shapes[0].points[0].y, -40) << "a tip is up";
  EXPECT_FALSE(marks.shapes[0].filled);
  EXPECT_TRUE(marks.shapes[1].filled);
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"7", "8"}));
}

TEST(Findings, ATapMeansTheNearestMark) {
  const station::FoundReport found = three_findings();
  MarkList marks = layer_marks({.found = &found, .project = from_above});
  MarkList robots;
  robots.targets = {{.robot = "r1", .at = {44, -40}, .radius = 20}};
  append(marks, robots);
  EXPECT_EQ(marks.target_at(31, -41)->finding, 7U);
  EXPECT_EQ(marks.robot_at(31, -41), "");
  EXPECT_EQ(marks.robot_at(43, -41), "r1");
  EXPECT_EQ(marks.target_at(500, 500), nullptr);
}

TEST(Findings, ThePickedOneHasARingAndItsKind) {
  const station::FoundReport found = three_findings();
  const MarkList marks = layer_marks({.found = &found, .picked = 8, .project = from_above});
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"7", "8 gas"}));
  EXPECT_EQ(marks.shapes.size(), 3U);
}

TEST(Findings, PlacesThatAreNoPlacesOrBehindTheCameraAreLeftOut) {
  for (const double wrong : {1e30, std::numeric_limits<double>::quiet_NaN()}) {
    station::FoundReport found = three_findings();
    for (station::FoundItem& item : found.findings) item.position[1] = wrong;
    EXPECT_TRUE(layer_marks({.found = &found, .project = from_above}).shapes.empty());
    found = three_findings();
    for (station::FoundItem& item : found.findings) item.position[2] = wrong;
    EXPECT_EQ(layer_marks({.found = &found, .project = from_above}).targets.size(), 2U);
  }
  const station::FoundReport found = three_findings();
  EXPECT_TRUE(
      layer_marks({.found = &found, .project = [](const Point3&) { return std::nullopt; }}).targets.empty());
}

TEST(Convoys, HaveOneLineThroughTheirRobotsInOrder) {
  station::World world{
      .robots = {robot("r1", 0, 0), robot("r2", 4, 0), robot("r3", 8, 0), robot("r4", 1, 9)}};
  for (const std::size_t i : {0U, 1U, 2U}) world.robots[i].convoy = {"r3", "r1", "r2"};
  const MarkList marks = layer_marks({.world = &world, .project = from_above});
  ASSERT_EQ(marks.shapes.size(), 1U) << "each member says the same convoy";
  EXPECT_EQ(marks.shapes[0].points, (std::vector<Point>{{80, 0}, {0, 0}, {40, 0}}));
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"1/3", "2/3", "3/3"}));
  world.robots[0].located = false;
  world.robots[1].x = 1e30F;
  world.robots[2].convoy = {"r3", "r1", "r2", "unheard"};
  EXPECT_TRUE(layer_marks({.world = &world, .project = from_above}).shapes.empty())
      << "one member has no line";
}

TEST(FloorMarks, PointAtRobotsOfOtherFloors) {
  const station::World world = robots_on_two_floors();
  Floors floors;
  floors.show(two_floors());
  floors.show(world, Trails{});
  LayerScene scene{.world = &world, .project = from_above, .floors = &floors, .floor = 1};
  MarkList marks = floor_marks(scene);
  ASSERT_EQ(marks.shapes.size(), 2U) << "r4 and r9";
  EXPECT_GT(marks.shapes[0].points[0].y, marks.shapes[0].points[1].y) << "its tip is down";
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"-1", "-1"}));
  scene.floor = 0;
  marks = floor_marks(scene);
  ASSERT_EQ(marks.shapes.size(), 7U);
  EXPECT_LT(marks.shapes[0].points[0].y, marks.shapes[0].points[1].y);
  EXPECT_EQ(texts(marks)[0], "0");
  scene.floor.reset();
  EXPECT_TRUE(floor_marks(scene).shapes.empty()) << "all floors are shown";
}

TEST(FloorMarks, FindingsOfOtherFloorsArePale) {
  station::FoundReport found = three_findings();
  found.findings[0].position[2] = -4.0;
  const station::World world = robots_on_two_floors();
  Floors floors;
  floors.show(two_floors());
  floors.show(world, Trails{});
  const MarkList marks = layer_marks({.found = &found, .project = from_above, .floors = &floors, .floor = 1});
  EXPECT_LT(marks.shapes[0].opacity, 0.5);
  EXPECT_EQ(marks.shapes[1].opacity, 1.0);
}

TEST(Findings, AreAtMostFiveHundred) {
  station::FoundReport found;
  for (std::uint32_t i = 1; i <= 10000; ++i) found.findings.push_back({.number = i});
  EXPECT_EQ(layer_marks({.found = &found, .project = from_above}).targets.size(), 500U);
}

}  // namespace
}  // namespace adit::gui
