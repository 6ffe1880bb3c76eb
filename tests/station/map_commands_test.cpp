// SPDX-License-Identifier: Apache-2.0
// The map at a station: received from robots, saved, drawn and described by commands.
#include <filesystem>

#include "basestation/map/chunk_store.hpp"
#include "core/transfer/piece.hpp"
#include "perception/stream/piece.hpp"
#include "tests/station/fake_robot.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class MapCommandsTest : public StationTest {
 protected:
  MapCommandsTest() {
    robot_ = &add("r1");
    add("r2");
    start();
    run_for(6s);
  }

  static radio::BulkPiece piece(const std::string& robot, std::uint32_t id, transfer::Kind kind,
                                const std::vector<std::uint8_t>& data) {
    radio::BulkPiece out;
    out.robot(robot);
    out.session(3);
    out.id(id);
    out.kind(static_cast<std::uint8_t>(kind));
    out.waiting(4);
    out.data(data);
    return out;
  }
  /// A floor with a wall, seen by the robot of that name.
  void send_map(const std::string& robot) {
    std::vector<perception::BlockUpdate> blocks;
    for (int x = 0; x < 12; ++x)
      blocks.push_back({{{x, 0, 0}, ~std::uint64_t{0}, x < 10 ? 0xffffU : ~std::uint64_t{0}}, 1});
    const perception::SubmapKey key{robot, 8, 0};
    robot_->send(piece(robot, 1, transfer::Kind::map_poses,
                       perception::encode(perception::SubmapPoses{{{key, Pose3{}, 1}}})));
    robot_->send(piece(robot, 2, transfer::Kind::map_blocks, perception::pack(key, blocks, 1200).bytes));
    run_for(2s);
  }
  std::string file(const std::string& name) const { return folder_.path(name); }

  store::ScratchFolder folder_{};
  FakeRobot* robot_{};
};

TEST_F(MapCommandsTest, WithoutAMapEachSaysSo) {
  for (const std::string& line : {"map save " + file("a.bt"), "map picture " + file("a.png")}) {
    const Outcome outcome = execute(line);
    EXPECT_EQ(outcome.exit_code, 1) << line;
    EXPECT_EQ(outcome.json["reason"], "map_empty") << line;
  }
  EXPECT_EQ(execute("map status").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(MapCommandsTest, APieceIsStoredAndAcknowledged) {
  send_map("r1");
  EXPECT_EQ(op_->map().blocks(), 12U);
  ASSERT_FALSE(robot_->piece_acks().empty());
  const radio::BulkAck& ack = robot_->piece_acks().back();
  EXPECT_EQ(ack.station(), "op1");
  EXPECT_EQ(ack.station_id(), kId);
  ASSERT_EQ(ack.receipts().size(), 1U);
  EXPECT_EQ(ack.receipts()[0].session(), 3U);
  EXPECT_EQ(ack.receipts()[0].newest(), 2U);
  EXPECT_EQ(ack.receipts()[0].received()[0], 3U);
  const Outcome outcome = execute("map status");
  EXPECT_THAT(outcome.text, HasSubstr("r1"));
  EXPECT_NEAR(outcome.json["m2"].get<double>(), 12 * 0.64, 1e-6);
}

TEST_F(MapCommandsTest, ARobotSpeaksForItselfAlone) {
  send_map("r2");  // r1's participant says that it is r2.
  EXPECT_EQ(op_->map().blocks(), 0U);
  send_map("r9");
  EXPECT_EQ(op_->map().blocks(), 0U);
}

TEST_F(MapCommandsTest, ShowsARobotThatItIsThereWithoutAnyPiece) {
  const std::size_t before = robot_->piece_acks().size();
  EXPECT_GE(before, 1U);
  run_for(20s);
  EXPECT_GE(robot_->piece_acks().size(), before + 8);
  EXPECT_LE(robot_->piece_acks().size(), before + 13);
}

TEST_F(MapCommandsTest, EveryKindOfFileIsWritten) {
  send_map("r1");
  for (const char* kind : {"bt", "ot", "pcd", "ply", "pgm"}) {
    const Outcome outcome = execute("map save " + file(std::string("site.") + kind));
    EXPECT_EQ(outcome.exit_code, 0) << kind << ": " << outcome.error;
    EXPECT_TRUE(std::filesystem::exists(file(std::string("site.") + kind))) << kind;
  }
  EXPECT_TRUE(std::filesystem::exists(file("site.yaml")));
  EXPECT_EQ(execute("map picture " + file("site.png")).exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST_F(MapCommandsTest, RefusesWhatItCannotWriteWithAReason) {
  send_map("r1");
  EXPECT_EQ(execute("map save " + file("no/such/folder.bt")).json["reason"], "cannot_write");
  const Outcome unknown = execute("map save " + file("site.dwg"));
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.error, HasSubstr(".bt, .ot, .pcd, .ply or .pgm"));
  EXPECT_EQ(execute("map save --robot r2 " + file("site.bt")).json["reason"], "map_empty");
  EXPECT_EQ(execute("map save --robot r1 " + file("site.bt")).exit_code, 0);
  EXPECT_EQ(execute("map picture " + file("site.jpg")).exit_code, 1);
}

TEST_F(MapCommandsTest, AMapThatWasSavedCanBeLoadedElsewhere) {
  send_map("r1");
  ASSERT_EQ(execute("map save " + file("site.bt")).exit_code, 0);
  Station& other = start("op2");
  run_for(8s);
  Outcome loaded;
  other.execute("map load " + file("site.bt"), [&](const Outcome& outcome) { loaded = outcome; });
  run_for(3s);
  EXPECT_EQ(loaded.exit_code, 0) << loaded.error;
  Outcome drawn{.exit_code = 9};
  other.execute("map picture " + file("prior.png"), [&](const Outcome& outcome) { drawn = outcome; });
  run_for(3s);
  EXPECT_EQ(drawn.exit_code, 0) << drawn.error;
  EXPECT_EQ(execute("map load " + file("none.bt")).json["reason"], "cannot_read");
}

TEST_F(MapCommandsTest, WhatTheOperatorLooksAtGoesToTheRobotsForSomeSeconds) {
  op_->look_at({1.5, -2, 20});
  run_for(4s);
  EXPECT_EQ(robot_->piece_acks().back().look(), (std::vector<float>{1.5F, -2, 20}));
  run_for(12s);
  EXPECT_TRUE(robot_->piece_acks().back().look().empty());
}

TEST_F(MapCommandsTest, AMapThatIsForgottenIsAskedForAgain) {
  send_map("r1");
  EXPECT_EQ(op_->map().blocks(), 12U);
  const std::uint32_t start = robot_->piece_acks().back().start();
  EXPECT_EQ(execute("map forget").exit_code, 0);
  EXPECT_EQ(op_->map().blocks(), 0U);
  run_for(5s);
  EXPECT_NE(robot_->piece_acks().back().start(), start) << "so robots send all again";
}

TEST_F(MapCommandsTest, AStationThatOnlyStopsTakesNothingAndAcknowledgesNothing) {
  op_.reset();  // It ended, and `basestation stop` stops robots by itself, under its name.
  run_for(1s);
  const std::size_t before = robot_->piece_acks().size();
  Station stopper({.name = "op1", .id = kId, .content = false}, *strand_, *wire_);
  ASSERT_TRUE(stopper.start().ok());
  run_for(6s);
  send_map("r1");
  run_for(6s);
  EXPECT_EQ(robot_->piece_acks().size(), before);
  EXPECT_EQ(stopper.map().blocks(), 0U);
}

}  // namespace
}  // namespace adit::station
