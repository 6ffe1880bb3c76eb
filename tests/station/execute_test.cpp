// SPDX-License-Identifier: Apache-2.0
// Command lines at a station: exit codes, texts, several robots.
#include <algorithm>
#include <cmath>

#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

class ExecuteTest : public StationTest {
 protected:
  ExecuteTest() {
    add("r1");
    add("r2");
    start();
    run_for(6s);
  }
};

std::optional<Reason> refuse_locked(const radio::Command&) { return Reason::locked; }

TEST_F(ExecuteTest, ARefusalIsExitOneWithItsReason) {
  robots_[0]->holder = "op2";
  robots_[0]->answering = refuse_locked;
  const Outcome outcome = execute("take r1");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(outcome.text.empty());
  EXPECT_THAT(outcome.error, HasSubstr("r1: refused: "));
  EXPECT_THAT(outcome.error, HasSubstr("op2"));
  EXPECT_EQ(outcome.json["results"][0]["reason"], "locked");
  EXPECT_EQ(outcome.json["exit"], 1);
  ASSERT_TRUE(op_->last_answer());
  EXPECT_EQ(op_->last_answer()->reason, Reason::locked);
  EXPECT_EQ(op_->counts().refused, 1U);
}

TEST_F(ExecuteTest, SeveralRobotsAnswerOneByOne) {
  robots_[1]->answering = refuse_locked;
  const Outcome outcome = execute("take r1 r2");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.text, "r1: taken\n");
  EXPECT_THAT(outcome.error, HasSubstr("r2: refused"));
}

TEST_F(ExecuteTest, ASilentRobotDelaysNoOther) {
  robots_[0]->alive = false;
  begin("take r1 r2");
  run_for(50ms);
  EXPECT_EQ(robots_[1]->holder, "op1");
  run_for(4s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 3);
  robots_[1]->answering = refuse_locked;
  EXPECT_EQ(execute("lock r1 r2").exit_code, 1) << "a refusal counts more than silence";
}

TEST_F(ExecuteTest, AnUnknownRobotNamesTheKnownOnes) {
  const Outcome outcome = execute("take r9");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("r9: "));
  EXPECT_THAT(outcome.error, HasSubstr("known robots: r1, r2"));
  EXPECT_EQ(op_->last_answer()->reason, Reason::unknown_robot);
  EXPECT_EQ(execute("status r9").exit_code, 1);
  EXPECT_EQ(execute("actions r1 r9").exit_code, 1);
  EXPECT_EQ(execute("findings r9").exit_code, 1);
  EXPECT_EQ(execute("findings r1").exit_code, 0);
}

TEST_F(ExecuteTest, WrongUsageIsExitTwo) {
  EXPECT_EQ(execute("tkae r1").exit_code, 2);
  EXPECT_EQ(execute("goto r1 north").exit_code, 2);
  EXPECT_EQ(execute("teleop r1").exit_code, 2);
  EXPECT_EQ(execute("watch").exit_code, 2);
  EXPECT_EQ(op_->counts().sent, 0U);
  EXPECT_EQ(op_->last_answer()->reason, Reason::not_supported);
}

TEST_F(ExecuteTest, TheRobotJudgesTheNameOfAModeAndTheStationNamesTheNearest) {
  for (const char* mode : {"waypoint", "orbit"}) {
    radio::ModeOption option;
    option.mode(mode);
    robots_[0]->behaviour.modes().push_back(option);
  }
  robots_[0]->answering = [](const radio::Command& command) {
    const bool known = command.kind() != radio::CMD_MODE || command.words().at(0) == "orbit";
    return known ? Reason::none : Reason::mode_unknown;
  };
  execute("take r1");
  EXPECT_EQ(execute("mode r1 orbit").exit_code, 0) << "a mode of the robot's own";
  const Outcome wrong = execute("mode r1 orbti");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.error, HasSubstr("did you mean orbit?"));
  EXPECT_THAT(wrong.error, HasSubstr("[mode_unknown]"));
}

TEST_F(ExecuteTest, StopAllReachesEveryRobot) {
  EXPECT_EQ(execute("stop all").exit_code, 0);
  EXPECT_TRUE(robots_[0]->behaviour.stopped());
  EXPECT_TRUE(robots_[1]->behaviour.stopped());
}

TEST_F(ExecuteTest, AllMeansWhatTheOperatorHoldsAndForTakeWhatIsFree) {
  const Outcome none = execute("reset all");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_EQ(none.error, "you hold no robot\n");
  EXPECT_EQ(none.json["reason"], "not_holder");
  robots_[1]->holder = "op2";
  robots_[1]->publish();
  run_for(1s);
  EXPECT_EQ(execute("take all").text, "r1: taken\n") << "never from another operator";
  EXPECT_EQ(robots_[1]->holder, "op2");
  EXPECT_THAT(execute("take all").error, HasSubstr("every robot has a holder"));
  for (const char* line : {"lock all", "mode all hold", "reset all --override", "yield all off"}) {
    const Outcome outcome = execute(line);
    EXPECT_EQ(outcome.exit_code, 0) << line << ": " << outcome.error;
    EXPECT_THAT(outcome.text, HasSubstr("r1: ")) << line;
    EXPECT_THAT(outcome.text, testing::Not(HasSubstr("r2"))) << line;
  }
  EXPECT_THAT(execute("actions all").json["actions"].dump(), HasSubstr("r2")) << "of every robot";
}

TEST_F(ExecuteTest, QueriesShowTheFleet) {
  execute("take r1");
  run_for(1500ms);
  const Outcome list = execute("list");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_THAT(list.text, HasSubstr("op1*"));
  EXPECT_EQ(list.json["robots"].size(), 2U);
  EXPECT_EQ(list.json["robots"][0]["mine"], true);
  EXPECT_THAT(execute("status r1").text, HasSubstr("op1 (you)"));
  EXPECT_EQ(execute("status").json["commands"]["accepted"], 1);
  EXPECT_THAT(execute("actions r1").text, HasSubstr("release"));
  EXPECT_THAT(execute("health").text, HasSubstr("r1: no health report"));
  EXPECT_THAT(execute("status").text, HasSubstr("station op1, no link profile"));
  const Outcome net = execute("net");
  EXPECT_THAT(net.text, HasSubstr("adit/presence"));
  EXPECT_GT(net.json["agents"][0]["total_out"].get<float>(), 0.0F);
}

TEST_F(ExecuteTest, PlanGivesTheRouteInPointsAndInWords) {
  radio::PlannedRoute& route = robots_[0]->route.emplace();
  route.length(12.5F);
  route.unknown_length(4.0F);
  route.corners(3);
  route.points({0.0F, 0.0F, 0.0F, 3.0F, -1.0F, 0.5F, 12.0F, 0.5F, std::nanf("")});
  const Outcome outcome = execute("plan r1 12 0.5");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.text, "r1: a route; 12.5 m, 4.0 m of it not seen yet: 3.0 -1.0, 12.0 0.5\n");
  const nlohmann::json planned = outcome.json["results"][0]["route"];
  EXPECT_EQ(outcome.json["results"][0]["text"], "12.5 m, 4.0 m of it not seen yet: 3.0 -1.0, 12.0 0.5");
  EXPECT_EQ(planned["length"], 12.5);
  EXPECT_EQ(planned["unknown_length"], 4.0);
  EXPECT_EQ(planned["complete"], true);
  ASSERT_EQ(planned["points"].size(), 3U);
  EXPECT_EQ(planned["points"][1], nlohmann::json({3.0, -1.0, 0.5}));
  EXPECT_EQ(nlohmann::json::parse(planned.dump())["points"][2][2], nullptr) << "a height that is not known";

  route.corners(40);
  EXPECT_EQ(execute("plan r1 12 0.5").json["results"][0]["route"]["complete"], false);
  robots_[0]->answering = [](const radio::Command&) { return Reason::goal_unreachable; };
  const Outcome refused = execute("plan r1 12 0.5");
  EXPECT_EQ(refused.json["results"][0]["reason"], "goal_unreachable");
  EXPECT_FALSE(refused.json["results"][0].contains("route"));
}

TEST_F(ExecuteTest, ARouteThatIsNoneIsNotShown) {
  radio::PlannedRoute& route = robots_[0]->route.emplace();
  for (const std::vector<float>& points :
       {std::vector{1.0F, 2.0F}, std::vector{std::nanf(""), 2.0F, 0.0F}, std::vector{1.0F, INFINITY, 0.0F}}) {
    route.points(points);
    EXPECT_FALSE(execute("plan r1 1 2").json["results"][0].contains("route"));
  }
  route.points({});
  route.length(std::nanf(""));
  EXPECT_FALSE(execute("plan r1 1 2").json["results"][0].contains("route"));
}

TEST_F(ExecuteTest, RestartAndPolicyNameTheComponent) {
  EXPECT_EQ(execute("restart r1 planner").text, "r1: planner is restarted\n");
  const auto& restart = robots_[0]->commands().back().command;
  EXPECT_EQ(restart.kind(), radio::CMD_RESTART);
  EXPECT_THAT(restart.words(), ElementsAre("planner"));
  EXPECT_EQ(execute("policy r1 sensors auto").exit_code, 0);
  EXPECT_EQ(robots_[0]->commands().back().command.kind(), radio::CMD_POLICY);
  EXPECT_THAT(robots_[0]->commands().back().command.words(), ElementsAre("sensors", "auto"));
  EXPECT_EQ(execute("policy r1 sensors manual").exit_code, 0);
  EXPECT_THAT(robots_[0]->commands().back().command.words(), ElementsAre("sensors", "manual"));
  EXPECT_TRUE(robots_[1]->commands().empty());
}

TEST_F(ExecuteTest, DownReleasesWhatItHoldsAndFallsSilent) {
  execute("take r1");
  bool notified = false;
  op_->on_down = [&] { notified = true; };
  const Outcome outcome = execute("down");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(robots_[0]->holder, "");
  EXPECT_TRUE(notified);
  EXPECT_TRUE(robots_[1]->commands().empty());
  EXPECT_EQ(execute("take r1").exit_code, 1);
  EXPECT_EQ(op_->last_answer()->reason, Reason::no_station);
  EXPECT_EQ(execute("up").exit_code, 0);
  EXPECT_EQ(execute("take r1").exit_code, 0);
}

TEST_F(ExecuteTest, AFlowTooManyIsRefusedAndCancelsNoOther) {
  // 64 waits for goals that no robot answers.
  for (const char* name : {"r3", "r4", "r5"}) add(name);
  run_for(3s);
  for (const auto& robot : robots_) robot->answering = [](const radio::Command&) { return std::nullopt; };
  for (int i = 0; i < 64; ++i) begin("goto r" + std::to_string(1 + i / 16) + " 4 5 --wait");
  ASSERT_TRUE(late_.empty());
  begin("goto r5 4 5 --wait");
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_THAT(late_[0].error, HasSubstr("r5: refused: "));
  EXPECT_THAT(late_[0].error, HasSubstr("[queue_full]"));
}

TEST_F(ExecuteTest, ANamedStopReachesARobotThatIsHeardLater) {
  std::vector<std::string> codes;
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("stop r1 r9");
  EXPECT_LT(seconds(scheduler_.elapsed() - before), 1.5);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.text, "r1: stopped\n");
  EXPECT_THAT(outcome.error, HasSubstr("r9: sent, not acknowledged yet"));
  EXPECT_THAT(outcome.error, HasSubstr("known robots: r1, r2"));
  run_for(60s);
  add("r9");
  run_for(5s);
  EXPECT_TRUE(robots_.back()->behaviour.stopped());
  EXPECT_THAT(codes, testing::Contains("stop_acknowledged r9"));
  const std::size_t commands = robots_.back()->commands().size();
  run_for(5s);
  EXPECT_EQ(robots_.back()->commands().size(), commands) << "it ends with the acknowledgement";
}

TEST_F(ExecuteTest, ARobotThatIsHeardAndDoesNotAcknowledgeTheStopIsReported) {
  std::vector<std::string> codes;
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  EXPECT_EQ(execute("stop r9").exit_code, 3);
  run_for(30s);
  add("r9").answering = [](const radio::Command&) { return std::nullopt; };
  run_for(15s);
  EXPECT_THAT(codes, testing::Contains("stop_not_acknowledged r9"));
}

TEST_F(ExecuteTest, AStopRepeatedLaterIsAnsweredToBothCallers) {
  std::vector<std::string> codes;
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  EXPECT_EQ(execute("stop r9").exit_code, 3) << "the first caller reads that it is not acknowledged yet";
  add("r9").answering = [](const radio::Command&) { return std::nullopt; };
  run_for(2s);
  begin("stop r9");
  run_for(500ms);
  ASSERT_TRUE(late_.empty()) << "the second caller waits for the robot, which is heard now";
  robots_.back()->answering = [](const radio::Command&) { return Reason::none; };
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].text, "r9: stopped\n");
  EXPECT_EQ(std::count(codes.begin(), codes.end(), "stop_acknowledged r9"), 1) << "for the first caller";
}

TEST_F(ExecuteTest, TheOldestOfSixteenStopsForUnheardRobotsGivesWayToANewOne) {
  std::vector<std::string> codes;
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  for (int i = 0; i < 16; ++i) begin("stop x" + std::to_string(i));
  run_for(2s);
  EXPECT_EQ(execute("stop x3").exit_code, 3) << "one that goes out already takes no second place";
  EXPECT_TRUE(codes.empty());
  EXPECT_EQ(execute("stop r9").exit_code, 3);
  EXPECT_THAT(codes, ElementsAre("stop_not_acknowledged x0"));
  EXPECT_EQ(execute("take r1").exit_code, 0);
  EXPECT_EQ(execute("stop r1").exit_code, 0);
  add("r9");
  add("x0");
  run_for(5s);
  EXPECT_TRUE(robots_[2]->behaviour.stopped());
  EXPECT_TRUE(robots_[3]->commands().empty()) << "its stop gave way";
}

TEST_F(ExecuteTest, AStopThatGaveWayAndIsGivenAgainHasANewNumber) {
  // A robot that heard the first stop, unheard itself, would repeat its first answer to the same number.
  for (int i = 0; i < 17; ++i) begin("stop x" + std::to_string(i));
  run_for(2s);
  begin("stop x0");
  add("x0");
  run_for(5s);
  ASSERT_FALSE(robots_.back()->commands().empty());
  EXPECT_GT(robots_.back()->commands().front().command.seq(), 1U);
}

TEST_F(ExecuteTest, AfterDownAndUpAllPlacesForUnheardRobotsAreFree) {
  std::vector<std::string> codes;
  for (int i = 0; i < 16; ++i) begin("stop x" + std::to_string(i));
  run_for(2s);
  execute("down");
  execute("up");
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  for (int i = 0; i < 16; ++i) begin("stop y" + std::to_string(i));
  run_for(2s);
  add("y0");
  run_for(5s);
  EXPECT_TRUE(robots_.back()->behaviour.stopped());
  EXPECT_THAT(codes, testing::Not(testing::Contains(HasSubstr("stop_not_acknowledged"))));
}

TEST_F(ExecuteTest, AStationThatIsDownSendsNoStopToARobotThatIsHeardLater) {
  EXPECT_EQ(execute("stop r9").exit_code, 3);
  EXPECT_THAT(execute("down").text, HasSubstr("no longer goes out: r9"));
  add("r9");
  run_for(5s);
  EXPECT_TRUE(robots_.back()->commands().empty());
}

TEST_F(ExecuteTest, TheOperatorIsNotifiedOfALostRobot) {
  std::vector<std::string> codes;
  op_->on_notice = [&](const StoredNotice& notice) { codes.push_back(notice.code + " " + notice.robot); };
  robots_[0]->alive = false;
  run_for(4s);
  robots_[0]->alive = true;
  run_for(1s);
  EXPECT_THAT(codes, ElementsAre("lost r1", "back r1"));
}

TEST_F(ExecuteTest, TheOperatorIsNotifiedOfARobotOfAnotherRelease) {
  std::vector<std::string> seen;
  op_->on_notice = [&](const StoredNotice& notice) { seen.push_back(notice.code + ": " + notice.text); };
  const auto older = network_.join(77, "r7");
  constexpr wire::TopicInfo unversioned{
      "adit/robot_state", "adit::radio::RobotState", wire::QosClass::state, 1, wire::topics::kKeyed, 256};
  const auto writer = older->make_writer(unversioned, "");
  run_for(3s);
  EXPECT_THAT(seen,
              ElementsAre(testing::StartsWith("other_release: r7 speaks version 0 of the radio contract")));
}

class FreshStation : public StationTest {};

TEST_F(FreshStation, WaitsForARobotThatItHasNotDiscoveredYet) {
  start();
  scheduler_.at(2s, [this] { add("r1"); });
  EXPECT_EQ(execute("take r1").exit_code, 0);
  EXPECT_LT(scheduler_.elapsed(), 4s);
  EXPECT_EQ(execute("take r9").exit_code, 1);
  EXPECT_NEAR(seconds(scheduler_.elapsed()), 5.0, 0.3);
}

TEST_F(FreshStation, ListWaitsForWhatIsOnItsWay) {
  start();
  scheduler_.at(1500ms, [this] {
    add("r1");
    robots_[0]->describe(2.0F, 1.5F, false);
    robots_[0]->publish();
  });
  const Outcome list = execute("list");
  ASSERT_EQ(list.json["robots"].size(), 1U);
  EXPECT_EQ(list.json["robots"][0]["kind"], "wheeled");
  EXPECT_EQ(list.json["robots"][0]["mode"], "hold");
  EXPECT_LT(seconds(scheduler_.elapsed()), 2.2);
}

TEST_F(FreshStation, KeepsTheOrderOfWhatWaits) {
  start();
  begin("take r1");
  begin("goto r1 1 2");
  add("r1");
  run_for(5s);
  EXPECT_EQ(late_.size(), 2U);
  ASSERT_EQ(robots_[0]->numbers().size(), 2U);
  EXPECT_EQ(robots_[0]->commands().back().command.kind(), radio::CMD_GOTO);
}

TEST_F(FreshStation, ACommandDoesNotOvertakeOneThatWaitsForAFurtherRobot) {
  add("r1");
  start();
  run_for(1s);
  begin("take r1 r2");
  begin("goto r1 1 2");
  scheduler_.at(2s, [this] { add("r2"); });
  run_for(4s);
  ASSERT_EQ(late_.size(), 2U);
  const auto& heard = robots_[0]->commands();
  ASSERT_EQ(robots_[0]->numbers().size(), 2U);
  EXPECT_EQ(heard.front().command.kind(), radio::CMD_TAKE) << "goto overtook take";
  EXPECT_EQ(heard.back().command.kind(), radio::CMD_GOTO);
}

TEST_F(FreshStation, ACommandGivenOnARefusalDoesNotOvertakeOneThatWaits) {
  add("r1");
  start();
  run_for(1s);
  strand_->post([this] {
    op_->execute("take r9", [this](const Outcome&) { op_->execute("goto r1 1 2", [](const Outcome&) {}); });
  });
  begin("take r1 r9");
  run_for(6s);
  ASSERT_EQ(robots_[0]->numbers().size(), 2U);
  EXPECT_EQ(robots_[0]->commands().front().command.kind(), radio::CMD_TAKE) << "goto overtook take";
}

TEST_F(FreshStation, AStopEndsWhatWaitsForItsRobots) {
  for (const char* stop : {"stop r1", "stop r3 r1", "stop all"}) {
    SCOPED_TRACE(stop);
    late_.clear();
    robots_.clear();
    start();
    for (const char* line : {"take r1", "reset r1", "goto r1 5 5", "mode r1 hold", "reset all", "status r1"})
      begin(line);
    begin(stop);
    EXPECT_EQ(std::count_if(late_.begin(), late_.end(),
                            [](const Outcome& outcome) { return outcome.json["reason"] == "stopped"; }),
              4)
        << "reset, goto, mode and reset all";
    add("r1");
    run_for(6s);
    EXPECT_EQ(late_.size(), 7U) << "take and status are done, the stop has its answer";
    EXPECT_TRUE(robots_[0]->behaviour.stopped());
    for (const auto& heard : robots_[0]->commands())
      EXPECT_THAT(heard.command.kind(), testing::AnyOf(radio::CMD_STOP, radio::CMD_TAKE));
  }
}

TEST_F(FreshStation, AStopEndsNothingOfOtherRobotsAndNothingThatIsGivenAfterIt) {
  start();
  begin("goto r2 1 2");
  begin("stop r1");
  begin("reset r1");
  add("r1");
  add("r2");
  run_for(6s);
  EXPECT_EQ(robots_[0]->commands().back().command.kind(), radio::CMD_RESET);
  ASSERT_FALSE(robots_[1]->commands().empty());
  EXPECT_EQ(robots_[1]->commands().back().command.kind(), radio::CMD_GOTO);
}

TEST_F(FreshStation, ACommandTooManyIsRefusedAndAStopIsNot) {
  start();
  for (int i = 0; i < 64; ++i) begin("status r1");
  ASSERT_TRUE(late_.empty());
  begin("take r1");
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_EQ(late_[0].json["reason"], "queue_full");
  add("r1");
  begin("stop r1");
  run_for(1s);
  EXPECT_TRUE(robots_[0]->behaviour.stopped());
}

TEST_F(FreshStation, ANamedStopGoesOutBeforeTheRobotIsHeard) {
  add("r1").alive = false;
  start();
  begin("stop r1");
  run_for(2s);
  EXPECT_FALSE(robots_[0]->commands().empty());
}

TEST_F(FreshStation, StopAllCatchesRobotsThatAppear) {
  start();
  add("r1");
  begin("stop all");
  scheduler_.at(3s, [this] { add("r2"); });
  run_for(6s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 0);
  EXPECT_TRUE(robots_[1]->behaviour.stopped());
}

TEST_F(FreshStation, StopAllWithNobodyThereIsNoAnswer) {
  start();
  EXPECT_EQ(execute("stop all").exit_code, 3);
}

TEST_F(FreshStation, AWrongNameDoesNotStart) {
  wire_ = network_.join(77, "op");
  Station station({.name = "op 1", .id = kId}, *strand_, *wire_);
  EXPECT_EQ(station.start().reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::station
