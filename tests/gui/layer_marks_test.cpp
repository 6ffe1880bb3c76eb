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

TEST(Findings, ThatAreWithdrawnHaveNoStarAndNoTarget) {
  station::FoundReport found = three_findings();
  found.findings[0].withdrawn = found.findings[1].withdrawn = true;
  const MarkList marks = layer_marks({.found = &found, .picked = 7, .project = from_above});
  EXPECT_TRUE(marks.shapes.empty());
  EXPECT_TRUE(marks.labels.empty());
  EXPECT_EQ(marks.target_at(30, -40), nullptr);
}

TEST(Findings, AnOperatorsMarkIsAFlagWhosePoleStandsOnItsPlace) {
  station::FoundReport found = three_findings();
  found.findings[0].mark = true;
  const MarkList marks = layer_marks({.found = &found, .project = from_above});
  ASSERT_EQ(marks.shapes.size(), 2U);
  ASSERT_EQ(marks.shapes[0].points.size(), 4U);
  EXPECT_NEAR(marks.shapes[0].points[0].x, 30, 1e-9);
  EXPECT_NEAR(marks.shapes[0].points[0].y, -40, 1e-9);
  EXPECT_EQ(marks.shapes[1].points.size(), 10U) << "a star";
  EXPECT_EQ(marks.target_at(30, -40)->finding, 7U);
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

station::StairsReport two_flights() {
  station::StairsReport report;
  const Staircase flight{
      .foot = {4, 2, 0.1}, .heading = 0.0, .rise = 0.2, .run = 0.3, .width = 1.2, .steps = 6};
  report.stairs = {{.number = 7, .stairs = flight, .findings = {7, 8}, .robots = {"r1", "r2"}},
                   {.number = 9, .stairs = flight, .findings = {9}, .verdict = station::Verdict::rejected}};
  return report;
}

TEST(Ribbons, LeadFromFootToTopWithChevronsUphill) {
  const station::StairsReport stairs = two_flights();
  const MarkList marks = layer_marks({.stairs = &stairs, .project = from_above});
  ASSERT_EQ(marks.shapes.size(), 3U) << "none for the rejected one";
  const auto& corners = marks.shapes[0].points;
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_NEAR(corners[0].x, 40, 1e-9);
  EXPECT_NEAR(corners[0].y, -14, 1e-9);
  EXPECT_NEAR(corners[2].x, 55, 1e-9) << "five runs ahead";
  EXPECT_NEAR(corners[2].y, -26, 1e-9);
  EXPECT_FALSE(marks.shapes[0].dashed) << "two robots have seen it";
  for (const std::size_t i : {1U, 2U}) {
    ASSERT_EQ(marks.shapes[i].points.size(), 3U);
    EXPECT_GT(marks.shapes[i].points[1].x, marks.shapes[i].points[0].x) << "the tip is uphill";
  }
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"6 steps"}));
  ASSERT_EQ(marks.targets.size(), 1U);
  EXPECT_EQ(marks.targets[0].finding, 7U);
}

TEST(Ribbons, FromTheSideHaveTheEdgesOfTheirTreads) {
  const station::StairsReport stairs = two_flights();
  const Projection from_south = [](const Point3& place) { return Point{10 * place.x, -10 * place.z}; };
  const MarkList marks =
      layer_marks({.stairs = &stairs, .picked = 7, .project = from_south, .from_side = true});
  ASSERT_EQ(marks.shapes.size(), 12U) << "a ribbon, 6 risers and 5 treads";
  std::set<long> heights;  // Of all edges, dm.
  for (const Shape& shape : std::span(marks.shapes).subspan(1)) {
    ASSERT_EQ(shape.points.size(), 4U);
    EXPECT_TRUE(shape.filled);
    for (const Point& point : shape.points) heights.insert(std::lround(-point.y));
  }
  EXPECT_EQ(heights, (std::set<long>{0, 2, 4, 6, 8, 10, 12})) << "from the floor below to the one above";
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"7 stairs, 6 steps"}));
}

TEST(Ribbons, TakeThePlaceOfTheStarsOfTheirFindings) {
  const station::StairsReport stairs = two_flights();
  station::FoundReport found = three_findings();
  found.findings[2].verdict = station::Verdict::open;
  found.findings.push_back({.number = 10, .kind = "stairs", .position = {1, 1, 0}});
  const MarkList marks = layer_marks({.found = &found, .stairs = &stairs, .project = from_above});
  EXPECT_EQ(texts(marks), (std::vector<std::string>{"6 steps", "10"}))
      << "10 could not be read as a staircase";
}

TEST(Ribbons, ThatOneRobotHasSeenAreDashedUntilTheyAreConfirmed) {
  station::StairsReport stairs = two_flights();
  stairs.stairs[0].robots = {"r1"};
  EXPECT_TRUE(layer_marks({.stairs = &stairs, .project = from_above}).shapes[0].dashed);
  stairs.stairs[0].verdict = station::Verdict::confirmed;
  EXPECT_FALSE(layer_marks({.stairs = &stairs, .project = from_above}).shapes[0].dashed);
}

TEST(Ribbons, BelongToTheFloorBelowAndToTheOneAbove) {
  station::StairsReport stairs = two_flights();
  stairs.stairs[0].stairs.foot.z() = -3.9;
  stairs.stairs[0].stairs.steps = 21;
  const station::World world = robots_on_two_floors();
  Floors floors;
  floors.show(two_floors());
  floors.show(world, Trails{});
  LayerScene scene{.stairs = &stairs, .project = from_above, .floors = &floors};
  for (const std::size_t floor : {0U, 1U}) {
    scene.floor = floor;
    EXPECT_EQ(layer_marks(scene).shapes[0].opacity, 1.0) << floor;
  }
  stairs.stairs[0].stairs.steps = 6;
  EXPECT_LT(layer_marks(scene).shapes[0].opacity, 0.5) << "it ends below the upper floor";
}

TEST(Ribbons, PlacesThatAreNoPlacesOrBehindTheCameraHaveNone) {
  station::StairsReport stairs = two_flights();
  stairs.stairs.resize(1);
  EXPECT_TRUE(layer_marks({.stairs = &stairs, .project = [](const Point3&) { return std::nullopt; }})
                  .targets.empty());
  for (const double wrong : {1e30, std::numeric_limits<double>::quiet_NaN()})
    for (const int axis : {0, 1, 2}) {
      station::StairsReport odd = stairs;
      odd.stairs[0].stairs.foot[axis] = wrong;
      EXPECT_TRUE(layer_marks({.stairs = &odd, .project = from_above}).shapes.empty());
    }
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
