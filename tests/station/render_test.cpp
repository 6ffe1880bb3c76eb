// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/watch/render.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace adit::station::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

World fleet(int robots) {
  World world{.station = "op1", .link = "wifi"};
  for (int i = 1; i <= robots; ++i) {
    Robot& robot = world.robots.emplace_back();
    robot.name = "r" + std::to_string(i);
    robot.age = 0.1;
    robot.lost = i == 3;
    robot.platform = "wheeled";
    robot.located = true;
    robot.x = 1.25F;
    robot.y = -200.5F;
    robot.yaw = 1.57F;
    robot.vx = 0.5F;
    robot.wz = 0.1F;
    robot.holder = "op1";
    robot.mine = true;
    robot.locked = i == 1;
    robot.mode = i == 2 ? "smart_joystick" : "waypoint";
    robot.moving_allowed = true;
    robot.goal_state = GoalState::active;
    robot.goal = {12.0, 0.5, std::nan("")};
  }
  for (int i = 0; i < 30; ++i)
    world.notices.push_back({{.severity = Severity::warning,
                              .code = "taken",
                              .text = "notice " + std::to_string(i),
                              .robot = "r1"},
                             0,
                             100.0 - i,
                             true});
  return world;
}

std::string text(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

TEST(Render, TheTitleCountsFindings) {
  World world = fleet(3);
  EXPECT_THAT(render(world, {}, 20, 200, false)[0], Not(HasSubstr("findings")));
  world.findings = {.listed = 5, .open = 2};
  EXPECT_THAT(render(world, {}, 20, 200, false)[0], HasSubstr("findings 5, 2 new"));
}

TEST(Render, TheTypedLineAndTheKeysStayInViewInASmallWindow) {
  const auto lines =
      render(fleet(3), {.selected = "r1", .help = true, .typing = true, .line = "goto"}, 6, 40, false);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_THAT(lines[4], HasSubstr(":goto_"));
  EXPECT_THAT(lines[5], HasSubstr("t take"));
}

TEST(Render, FillsEveryWindowAndNeverMore) {
  for (const int rows : {4, 10, 24, 50})
    for (const int columns : {20, 80, 132, 200})
      for (const int robots : {0, 3, 40})
        for (const bool help : {false, true}) {
          const auto lines = render(fleet(robots), {.selected = "r3", .help = help}, rows, columns, false);
          EXPECT_LE(lines.size(), static_cast<std::size_t>(rows));
          EXPECT_EQ(lines.size() == static_cast<std::size_t>(rows), true) << rows << " " << robots;
          for (const std::string& line : lines)
            EXPECT_LE(line.size(), static_cast<std::size_t>(columns)) << line;
        }
}

TEST(Render, ColoursTakeNoCells) {
  auto strip = [](std::string line) {
    for (std::size_t at; (at = line.find('\x1b')) != std::string::npos;)
      line.erase(at, line.find('m', at) - at + 1);
    return line;
  };
  const auto plain = render(fleet(3), {.selected = "r1"}, 24, 80, false);
  const auto coloured = render(fleet(3), {.selected = "r1"}, 24, 80, true);
  ASSERT_EQ(plain.size(), coloured.size());
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(strip(coloured[i]), plain[i]);
}

TEST(Render, ShowsRobotsNewestNoticesAndKeys) {
  const std::string page = text(render(fleet(3), {.selected = "r2"}, 24, 80, false));
  EXPECT_THAT(page, HasSubstr("> 2 r2"));
  EXPECT_THAT(page, HasSubstr("op1#"));
  EXPECT_THAT(page, HasSubstr("LOST"));
  EXPECT_THAT(page, HasSubstr("to 12.0,0.5"));
  EXPECT_THAT(page, HasSubstr("-200.5"));
  EXPECT_THAT(page, HasSubstr("notice 29"));
  EXPECT_THAT(page, testing::Not(HasSubstr("notice 0\n")));
  EXPECT_THAT(page, HasSubstr("m drive ? q"));
}

TEST(Render, ARobotHasTheNumberOfItsName) {
  World world = fleet(10);
  std::ranges::sort(world.robots, {}, &Robot::name);
  const std::string page = text(render(world, {.selected = "r1"}, 24, 80, false));
  EXPECT_THAT(page, HasSubstr(" 2 r2 "));
  EXPECT_THAT(page, HasSubstr(" 9 r9 "));
  EXPECT_THAT(page, HasSubstr("   r10 ")) << "no key selects it";
}

TEST(Render, ARobotThatMovesIsNotReady) {
  World world;
  Robot& robot = world.robots.emplace_back();
  robot.name = "r1";
  robot.located = robot.mine = true;
  robot.vx = 1.0F;
  robot.mode = "smart_joystick";
  EXPECT_THAT(text(render(world, {.selected = "r1"}, 24, 80, false)), HasSubstr("driven by hand"));
  world.robots[0].vx = 0.0F;
  world.robots[0].mode = "hold";
  world.robots[0].reason = Reason::joystick_stale;
  EXPECT_THAT(text(render(world, {.selected = "r1"}, 24, 80, false)),
              HasSubstr("does not move: joystick_stale"));
}

TEST(Render, TheSelectedRobotStaysInView) {
  EXPECT_THAT(text(render(fleet(40), {.selected = "r40"}, 24, 80, false)), HasSubstr("> "));
  EXPECT_THAT(text(render(fleet(40), {.selected = "r40"}, 24, 80, false)), HasSubstr("r40"));
}

TEST(Render, RobotsOfWhichLittleIsKnownDoNoHarm) {
  EXPECT_THAT(text(render({}, {}, 24, 80, false)), HasSubstr("no robot has been heard"));
  World odd{.robots = {{}, {}}, .notices = {{}}};
  odd.robots[1].name = "r5";
  odd.robots[1].stops = {"", "op2"};
  EXPECT_EQ(render(odd, {.selected = ""}, 24, 80, true).size(), 24U);
}

}  // namespace
}  // namespace adit::station::cli
