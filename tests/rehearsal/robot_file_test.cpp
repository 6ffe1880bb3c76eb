// SPDX-License-Identifier: Apache-2.0
// Robots of a scenario that come from robots' files, and the keys of such files written in a scenario.
#include <gtest/gtest.h>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

constexpr const char* kRobotFile = R"(name: scout
platform: legged
pose: [2, 1, 0.5]
radio: {domain: 3, interfaces: [10.0.0.1], link: mesh_100k}
cmd_vel: twist_stamped
lock_lease: 20
on_link_loss: return
link_loss_after: 4
battery: {warning: 0.5, low: 0.4, last: 0.3, at_last: return}
after_restart: hold
start_height: 5
)";

/// A scenario with that line in `robots`, which is line 4.
std::string scenario_with(const std::string& robot) {
  return "world: {boxes: [], floor: 0, ceiling: 3}\nduration: 20\nrobots:\n  - " + robot +
         "\nbasestations:\n  - {id: op1}\n";
}

class RobotFiles : public testing::Test {
 protected:
  Result<Scenario> read(const std::string& robot) {
    return load_scenario(scratch.write("s.yaml", scenario_with(robot)).string());
  }
  /// What is wrong with that robot, in one line.
  std::string complaint(const std::string& robot) {
    const auto s = read(robot);
    return s.ok() ? "nothing" : s.error().text;
  }
  Scratch scratch{};
};

TEST_F(RobotFiles, SayWhetherARobotCarriesMaps) {
  const auto carries = [this](const std::string& keys) {
    const auto s = read("{id: r1, platform: wheeled, pose: [0, 0, 0]" + keys + "}");
    return s.ok() && s->robots.at(0).settings.carry_maps;
  };
  EXPECT_FALSE(carries(""));
  EXPECT_TRUE(carries(", map: {carry: true}"));
  EXPECT_FALSE(carries(", map: {carry: false}"));
  for (const char* wrong : {"map: {carry: perhaps}", "map: true", "map: {carries: true}"})
    EXPECT_NE(complaint(std::string("{id: r1, platform: wheeled, pose: [0, 0, 0], ") + wrong + "}"),
              "nothing")
        << wrong;
}

TEST_F(RobotFiles, GiveEverythingThatTheScenarioDoesNotSay) {
  scratch.write("scout.yaml", kRobotFile);
  const auto s = read("{file: scout.yaml}");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const RobotSpec& r = s->robots.at(0);
  EXPECT_EQ(r.id, "scout");
  EXPECT_EQ(r.platform, "legged");
  EXPECT_EQ(r.settings.platform.name, "legged");
  EXPECT_DOUBLE_EQ(r.pose.x, 2.0);
  EXPECT_DOUBLE_EQ(r.settings.start.yaw, 0.5);
  EXPECT_EQ(r.settings.velocity, agent::VelocityType::twist_stamped);
  EXPECT_EQ(r.settings.lock_lease, Duration(20s));
  EXPECT_EQ(r.settings.safeguards.link_loss.action, agent::OnLoss::back);
  EXPECT_EQ(r.settings.safeguards.link_loss.after, Duration(4s));
  EXPECT_DOUBLE_EQ(r.settings.safeguards.battery.low, 0.4);
  EXPECT_TRUE(r.settings.safeguards.return_at_last_battery);
  EXPECT_FALSE(r.settings.resume_after_restart);
  EXPECT_EQ(r.settings.start_height, 5.0);
}

TEST_F(RobotFiles, TheHeightOfTheStartBelongsToThePose) {
  scratch.write("scout.yaml", kRobotFile);
  const auto height = [&](const std::string& keys) {
    return read("{file: scout.yaml" + keys + "}").value().robots.at(0).settings.start_height;
  };
  EXPECT_EQ(height(", pose: [0, 0, 0]"), std::nullopt);
  EXPECT_EQ(height(", pose: [0, 0, 0], start_height: 7"), 7.0);
}

TEST_F(RobotFiles, TheScenariosKeysGoBeforeTheFiles) {
  scratch.write("scout.yaml", kRobotFile);
  const auto s = read(
      "{file: scout.yaml, id: r7, platform: wheeled, pose: [0, 0, 0], after_restart: resume, cmd_vel: twist, "
      "battery: {low: 0.35, charge: 0.6, drain: 0.01}}");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const RobotSpec& r = s->robots.at(0);
  EXPECT_EQ(r.id, "r7");
  EXPECT_EQ(r.settings.name, "r7");
  EXPECT_EQ(r.settings.platform.name, "wheeled");
  EXPECT_DOUBLE_EQ(r.settings.start.x, 0.0);
  EXPECT_TRUE(r.settings.resume_after_restart);
  EXPECT_EQ(r.settings.velocity, agent::VelocityType::twist);
  EXPECT_DOUBLE_EQ(r.settings.safeguards.battery.warning, 0.5);
  EXPECT_DOUBLE_EQ(r.settings.safeguards.battery.low, 0.35);
  EXPECT_TRUE(r.settings.safeguards.return_at_last_battery);
  const DriverParams driver = make_driver_params(r);
  EXPECT_DOUBLE_EQ(driver.charge, 0.6);
  EXPECT_DOUBLE_EQ(driver.drain, 0.01);
}

TEST_F(RobotFiles, ThoseThatComeAlongAreFoundFromAnywhere) {
  for (const char* file : {"config/robots/r1.yaml", "robots/r1.yaml"}) {
    const auto s = read(std::string("{file: ") + file + "}");
    ASSERT_TRUE(s.ok()) << s.error().text;
    EXPECT_EQ(s->robots.at(0).id, "r1");
  }
}

TEST_F(RobotFiles, ATreeIsBesideTheScenarioOrAbsolute) {
  const std::string tree =
      scratch
          .write("oak.xml",
                 "<root BTCPP_format=\"4\"><BehaviorTree ID=\"T\"><AlwaysSuccess/></BehaviorTree></root>")
          .string();
  // What the product thinks of that tree comes after it was found.
  EXPECT_NE(complaint("{id: r1, platform: wheeled, pose: [0, 0, 0], tree: oak.xml}").find("mode"),
            std::string::npos);
  EXPECT_NE(complaint("{id: r1, platform: wheeled, pose: [0, 0, 0], tree: " + tree + "}").find("mode"),
            std::string::npos);
  const std::string shipped = source_folder() + "/config/trees/robot.xml";
  const auto s = read("{id: r1, platform: wheeled, pose: [0, 0, 0], tree: " + shipped + "}");
  ASSERT_TRUE(s.ok()) << s.error().text;
  EXPECT_EQ(s->robots.at(0).settings.tree, shipped);
}

TEST_F(RobotFiles, ARefusedTreeNamesScenarioTreeAndLine) {
  const std::string tree =
      scratch.write("elm.xml", "<root BTCPP_format=\"4\">\n  <Elm/>\n</root>\n").string();
  scratch.write("elm.yaml", "name: r1\nplatform: wheeled\ntree: elm.xml\n");
  for (const char* robot :
       {"{id: r1, platform: wheeled, pose: [0, 0, 0], tree: elm.xml}", "{file: elm.yaml}"}) {
    const std::string text = complaint(robot);
    EXPECT_NE(text.find("s.yaml:4: "), std::string::npos) << text;
    EXPECT_NE(text.find(tree + ":2"), std::string::npos) << text;
  }
}

TEST_F(RobotFiles, WrongKeysNameFileAndLine) {
  scratch.write("bad.yaml", "name: r1\nplatform: wheeled\nbatery: {low: 0.1}\n");
  const std::string inside = complaint("{file: bad.yaml}");
  EXPECT_NE(inside.find("s.yaml:4: "), std::string::npos) << inside;
  EXPECT_NE(inside.find("bad.yaml:3: "), std::string::npos) << inside;
  EXPECT_NE(inside.find("battery"), std::string::npos) << inside;

  const std::string head = "{id: r1, platform: wheeled, pose: [0, 0, 0], ";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"file: nowhere.yaml", "nowhere.yaml"},
      {"tree: nowhere.xml", "nowhere.xml"},
      {"battery: {charge: 2}", "[0, 1]"},
      {"battery: {drain: -1}", "[0, 1]"},
      {"battery: {warning: 0.1}", "warning >= low >= last"},
      {"battery: {at_last: fly}", "hold or return"},
      {"battery: {colour: red}", "colour"},
      {"after_restart: go", "resume or hold"},
      {"cmd_vel: string", "twist or twist_stamped"},
      {"lock_lease: -1", "[0, "},
      {"radio: {domain: 3}", "radio"},
  };
  for (const auto& [key, expected] : wrong) {
    const std::string text = complaint(head + key + "}");
    EXPECT_NE(text.find("s.yaml:4: "), std::string::npos) << key << ": " << text;
    EXPECT_NE(text.find(expected), std::string::npos) << key << ": " << text;
  }
}

}  // namespace
}  // namespace adit::sim
