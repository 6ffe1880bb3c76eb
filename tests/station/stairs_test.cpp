// SPDX-License-Identifier: Apache-2.0
// Staircases that robots find, at a station: merged, listed, judged.
#include "basestation/findings/stairs_report.hpp"

#include <gmock/gmock.h>

#include "basestation/commands/station_commands.hpp"
#include "basestation/model/json.hpp"
#include "core/findings/stairs_data.hpp"
#include "tests/station/findings_fixture.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

Staircase flight_to_the_north(int steps = 6) {
  return {.foot = {8.0, 2.5, 0.1},
          .heading = M_PI / 2,
          .rise = 0.2,
          .run = 0.3,
          .width = 1.2,
          .steps = steps,
          .sigma = {.place = 0.02, .heading = 0.02, .rise = 0.002, .run = 0.003, .width = 0.05}};
}

class StairsTest : public StoredFindings {
 protected:
  using StoredFindings::find;
  void find(const std::string& robot, std::uint64_t id, const Staircase& stairs) {
    find({.key = {robot, id},
          .kind = findings::kStairs,
          .position = {stairs.foot.x(), stairs.foot.y(), stairs.foot.z()},
          .data = findings::encode_stairs(stairs)});
  }
  void hear(const std::string& name, bool stairs, float step) {
    radio::Capabilities sample;
    sample.name(name);
    sample.kind(radio::AGENT_ROBOT);
    sample.stairs(stairs);
    sample.step(step);
    fleet_.hear(sample, {.received = Time(1s)});
  }
  StairsReport report() { return stairs_report(desk_, book_, chunks_, fleet_); }
};

TEST_F(StairsTest, WithoutAnyTheReportSaysSo) {
  EXPECT_EQ(stairs_text(report()), "no staircase was found yet\n");
}

TEST_F(StairsTest, MoveWithTheSubmapInWhichTheyWereSeen) {
  const Staircase stairs = flight_to_the_north(4);
  const perception::SubmapKey key{"r1", 77, 3};
  const Pose3 before = Pose3::level({1, 2, 0.25}, 0.5), after = Pose3::level({1, 2.5, 0.5}, -0.1);
  const Eigen::Vector3f offset = (before.inverse() * stairs.foot).cast<float>();
  find({.key = {"r1", 1},
        .kind = findings::kStairs,
        .position = {stairs.foot.x(), stairs.foot.y(), stairs.foot.z()},
        .data = findings::encode_stairs(stairs),
        .anchor = findings::Anchor{77, 3, {offset.x(), offset.y(), offset.z()}, 0.25f}});
  ASSERT_EQ(report().stairs.size(), 1u);
  EXPECT_NEAR((report().stairs[0].stairs.foot - stairs.foot).norm(), 0.0, 0.001) << "its submap is not here";
  ASSERT_TRUE(chunks_.count("r1", 1, 0, Time{}));
  ASSERT_TRUE(chunks_.take("r1", perception::SubmapPoses{{{key, before, 1}}}));
  EXPECT_NEAR((report().stairs[0].stairs.foot - stairs.foot).norm(), 0.0, 0.001);
  EXPECT_NEAR(report().stairs[0].stairs.heading, stairs.heading, 0.01);
  ASSERT_TRUE(chunks_.take("r1", perception::SubmapPoses{{{key, after, 2}}}));
  const Eigen::Vector3d moved = after * (before.inverse() * stairs.foot);
  EXPECT_NEAR((report().stairs[0].stairs.foot - moved).norm(), 0.0, 0.001);
  EXPECT_NEAR(report().stairs[0].stairs.heading, stairs.heading + 0.25, 0.01);
  EXPECT_NEAR(found().findings.at(0).position[1], moved.y(), 0.001);
}

TEST_F(StairsTest, SeenByTwoRobotsAreOneRowWithTheFirstNumber) {
  find({.key = {"r3", 1}, .kind = "person", .position = {1, 1, 0}});
  find("r2", 5, flight_to_the_north(4));
  Staircase upper = flight_to_the_north(4);
  upper.foot += Eigen::Vector3d(0, 2 * upper.run, 2 * upper.rise);
  find("r1", 9, upper);
  hear("r1", true, 0.2F);
  hear("r2", true, 0.15F);
  hear("r3", false, 0.3F);
  const StairsReport seen = report();
  ASSERT_EQ(seen.stairs.size(), 1U);
  const StairsItem& item = seen.stairs[0];
  EXPECT_EQ(item.number, 2U) << "that of r2, which was here first";
  EXPECT_THAT(item.findings, ElementsAre(2U, 3U));
  EXPECT_THAT(item.robots, ElementsAre("r1", "r2"));
  EXPECT_EQ(item.stairs.steps, 6);
  EXPECT_THAT(item.fleet,
              ElementsAre(Climber{"r1", true, ""}, Climber{"r2", false, "climbs steps of 0.15 m at most"},
                          Climber{"r3", false, "climbs no stairs"}));
  EXPECT_EQ(stairs_text(seen),
            "ID  DIRECTION  FLOORS M    STEPS  RISE M  RUN M  WIDTH M       SEEN BY  WHO MAY CLIMB  VERDICT\n"
            " 2  90d        0.0 -> 1.2      6   0.200  0.300  1.20 +- 0.04  r1, r2   r1             open\n");
}

TEST_F(StairsTest, AreJudgedByTheNumberOfTheirRow) {
  find("r1", 1, flight_to_the_north());
  Staircase wide = flight_to_the_north();
  wide.width = 2.0;
  find("r2", 1, wide);
  EXPECT_NEAR(report().stairs[0].stairs.width, 1.6, 1e-6);
  book_.judge({"r2", 1}, Verdict::rejected, [](const Result<void>&) {});
  EXPECT_EQ(report().stairs[0].verdict, Verdict::open);
  EXPECT_NEAR(report().stairs[0].stairs.width, 1.2, 1e-6) << "what is rejected is left out of the mean";
  EXPECT_THAT(report().stairs[0].robots, ElementsAre("r1", "r2"));
  book_.judge({"r1", 1}, Verdict::rejected, [](const Result<void>&) {});
  ASSERT_EQ(report().stairs.size(), 1U);
  EXPECT_EQ(report().stairs[0].verdict, Verdict::rejected);
  EXPECT_THAT(stairs_text(report()), HasSubstr("rejected"));
}

TEST_F(StairsTest, DamagedOnesAreLeftOutAndCounted) {
  find({.key = {"r1", 1}, .kind = findings::kStairs, .position = {1, 1, 0}, .data = {1, 2, 3}});
  EXPECT_EQ(stairs_text(report()), "no staircase was found yet\n1 staircase could not be read\n");
  find({.key = {"r1", 2}, .kind = findings::kStairs, .position = {1, 1, 0}});
  find("r1", 3, flight_to_the_north());
  EXPECT_EQ(report().unreadable, 2U);
  EXPECT_EQ(report().stairs.size(), 1U);
  EXPECT_THAT(stairs_text(report()), HasSubstr("\n2 staircases could not be read\n"));
}

TEST_F(StairsTest, ARobotThatWasNotDescribedMayNotClimb) {
  find("r1", 1, flight_to_the_north());
  radio::RobotState state;
  state.robot("r1");
  fleet_.hear(state, {.received = Time(1s)});
  EXPECT_THAT(report().stairs[0].fleet, ElementsAre(Climber{"r1", false, "has not said what it climbs"}));
  EXPECT_THAT(stairs_text(report()), HasSubstr("none"));
}

TEST_F(StairsTest, TheCommandListsWhatRobotsSend) {
  FakeRobot& robot = add("r1");
  start();
  run_for(6s);
  EXPECT_EQ(execute("stairs").text, "no staircase was found yet\n");
  const Staircase sent = flight_to_the_north();
  const findings::Finding finding{.key = {"r1", 4},
                                  .kind = findings::kStairs,
                                  .position = {sent.foot.x(), sent.foot.y(), sent.foot.z()},
                                  .data = findings::encode_stairs(sent)};
  radio::BulkPiece piece;
  piece.robot("r1");
  piece.session(3);
  piece.id(1);
  piece.kind(static_cast<std::uint8_t>(transfer::Kind::findings));
  piece.data(findings::encode({"r1", 1, 0, {finding}}));
  robot.send(piece);
  run_for(1s);
  const Outcome outcome = execute("stairs");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("0.0 -> 1.2"));
  const auto row = outcome.json["stairs"][0];
  EXPECT_EQ(row["number"], 1);
  EXPECT_EQ(row["robots"], nlohmann::json({"r1"}));
  EXPECT_EQ(row["steps"], 6);
  EXPECT_NEAR(row["heading"].get<double>(), M_PI / 2, 1e-4);
  EXPECT_NEAR(row["floor_above"].get<double>(), 1.2, 1e-6);
  EXPECT_NEAR(row["top"][1].get<double>(), 4.0, 1e-3);
  EXPECT_NEAR(row["sigma"]["width"].get<double>(), 0.05, 1e-6);
  EXPECT_EQ(outcome.json["unreadable"], 0);
  EXPECT_EQ(execute("finding 1 reject").exit_code, 0);
  EXPECT_EQ(execute("stairs").json["stairs"][0]["verdict"], "rejected");
  const auto read = stairs_of({.json = line_of(execute("stairs").json)});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stairs[0].verdict, Verdict::rejected);
}

}  // namespace
}  // namespace adit::station
