// SPDX-License-Identifier: Apache-2.0
// The programs as an operator meets them: separate processes over Fast DDS.
#include "tests/live/programs.hpp"

#include <signal.h>

namespace adit::live {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST_F(Programs, AuthorityBetweenTwoOperators) {
  const Process robot = agent();
  EXPECT_EQ(op("op1", {"take", "r1"}).exit_code, 0);
  EXPECT_EQ(op("op1", {"lock", "r1"}).exit_code, 0);
  const auto refused = op("op2", {"take", "r1"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("op1")) << "the holder's name";
  EXPECT_EQ(op("op1", {"grant", "r1", "op2"}).exit_code, 0);
  EXPECT_EQ(op("op1", {"mode", "r1", "hold"}).exit_code, 1) << "handed over";
  EXPECT_EQ(op("op1", {"stop", "r1"}).exit_code, 0) << "a stop needs no authority";
  const auto reset = op("op2", {"reset", "r1"});
  EXPECT_EQ(reset.exit_code, 1);
  EXPECT_THAT(reset.err, HasSubstr("op1")) << "whose stop it is";
  EXPECT_EQ(op("op2", {"reset", "r1", "--override"}).exit_code, 0);
  EXPECT_EQ(op("op2", {"down"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return listed("op1", "r1").value("holder", "?").empty(); }))
      << "down releases";
}

TEST_F(Programs, KilledStationHasItsRobotsBackAtOnce) {
  PlainDriver driver(*net_);
  const Process robot = agent();
  Seconds shortest = Seconds::max();
  for (int i = 0; i < max_measurements() && shortest >= 2500ms; ++i) {
    if (i > 0) {
      EXPECT_EQ(op("op1", {"down", "--leave"}).exit_code, 0);
    }
    Process first = station("op1");
    ASSERT_TRUE(eventually([&] { return op("op1", {"take", "r1"}).exit_code == 0; })) << first.err();
    EXPECT_EQ(op("op1", {"lock", "r1"}).exit_code, 0);
    first.signal(SIGKILL);
    first.wait(Seconds(5));
    const auto killed = std::chrono::steady_clock::now();
    const auto sent = op("op1", {"goto", "r1", "1", "0"});  // restarts the station
    shortest = std::min<Seconds>(shortest, std::chrono::steady_clock::now() - killed);
    EXPECT_EQ(sent.exit_code, 0) << sent.err;
    EXPECT_TRUE(listed("op1", "r1").value("mine", false));
    EXPECT_TRUE(listed("op1", "r1").value("locked", false));
  }
  EXPECT_LT(shortest, 2500ms);
}

TEST_F(Programs, ForeignParticipantMovesNothingAndIsReported) {
  PlainDriver driver(*net_);
  const Process robot = agent();
  ASSERT_EQ(op("op1", {"take", "r1"}).exit_code, 0);
  Foreigner foreigner(*net_, "foreigner", "r1");
  ASSERT_TRUE(net_->until([&] { return foreigner.matched() && foreigner.authority().holder() == "op1"; }));
  station::Id own = id_of("somebody"), his{};
  std::copy_n(foreigner.authority().holder_id().begin(), his.size(), his.begin());
  for (const auto& id : {own, his}) {
    for (const auto kind : {radio::CMD_MODE, radio::CMD_GOTO, radio::CMD_RELEASE, radio::CMD_RESET}) {
      radio::Command command;
      command.station("op1");
      command.station_id(id);
      command.kind(kind);
      if (kind == radio::CMD_MODE) command.words({"waypoint"});
      if (kind == radio::CMD_GOTO) command.numbers({3.0, 0.0});
      foreigner.announce("op1", id);  // as the holder's station would, started again
      const auto answer = foreigner.ask(command);
      ASSERT_TRUE(answer.has_value()) << "not even an answer";
      EXPECT_FALSE(answer->accepted());
      EXPECT_EQ(name(static_cast<Reason>(answer->reason())), "identity_mismatch");
    }
    for (int i = 0; i < 20; ++i) {
      foreigner.announce("op1", id);
      foreigner.joystick(id, 1.0F);
      net_->pass(50ms);
    }
  }
  EXPECT_EQ(foreigner.authority().holder(), "op1");
  EXPECT_GT(driver.told().count, 20);
  EXPECT_EQ(driver.told().moving, 0) << "something moved";
  bool reported = false;
  for (const auto& notice : foreigner.notices())
    reported = reported || (notice.code() == "intruder" && notice.operator_name() == "op1");
  EXPECT_TRUE(reported);
  const auto status = json("op1", {"status"});
  EXPECT_THAT(status.dump(), HasSubstr("intruder")) << "the holder reads it";
  EXPECT_EQ(op("op1", {"goto", "r1", "1", "0"}).exit_code, 0) << "the holder goes on";
}

TEST_F(Programs, ListFollowsWhoIsThere) {
  ASSERT_EQ(op("op1", {"up"}).exit_code, 0);
  {
    Process robot = agent();
    EXPECT_TRUE(eventually([&] { return listed("op1", "r1").value("kind", "") == "wheeled"; }, Seconds(3)))
        << "appears";
    robot.signal(SIGKILL);
    robot.wait(Seconds(5));
  }
  EXPECT_TRUE(eventually([&] { return listed("op1", "r1").value("lost", false); }, Seconds(3)))
      << "falls silent";
  // On one machine the port distinguishes addresses: another process has the old one now.
  const Foreigner squatter(*net_, "squatter", "r1");
  const std::string config = folder_.write("r1.yaml", "name: r1\nplatform: tracked\n");
  const Process back({"robot_agent", "--config", config, "--domain", std::to_string(domain()),
                      "--robot-domain", std::to_string(domain(1))},
                     folder_.environment());
  EXPECT_TRUE(eventually(
      [&] {
        const auto row = listed("op1", "r1");
        return !row.value("lost", true) && row.value("kind", "") == "tracked";
      },
      Seconds(3)))
      << "returns under another address, with other capabilities";
}

}  // namespace
}  // namespace adit::live
