// SPDX-License-Identifier: Apache-2.0
// What an agent with an odometry of its own knows of its place after a restart (rules 7 and 11).
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// An upright wall from (x0, y0) to (x1, y1), 2 m high, with a point each 0.1 m.
void add_wall(PointCloud& points, float x0, float y0, float x1, float y1) {
  const Eigen::Vector2f from(x0, y0), to(x1, y1);
  const int steps = static_cast<int>((to - from).norm() / 0.1f);
  for (int n = 0; n <= steps; ++n)
    for (float z = 0.2f; z < 2.0f; z += 0.2f) {
      const Eigen::Vector2f at = from + (to - from) * static_cast<float>(n) / static_cast<float>(steps);
      points.emplace_back(at.x(), at.y(), z);
    }
}

PointCloud room() {
  PointCloud points;
  add_wall(points, -5, -4, 12, -4);
  add_wall(points, -5, 4, 12, 4);
  add_wall(points, -5, -4, -5, 4);
  add_wall(points, 12, -4, 12, 4);
  add_wall(points, 3, 2.5f, 5, 2.5f);
  return points;
}

PointCloud another_room() {
  PointCloud points;
  add_wall(points, -3, -6, 3, -8);
  add_wall(points, 3, -8, 7, 0);
  add_wall(points, 7, 0, 2, 5);
  add_wall(points, 2, 5, -3, -6);
  return points;
}

class PlaceOfAnAgent : public testing::Test {
 protected:
  void SetUp() override {
    AgentParams params;
    params.boot = 1;
    params.disk = disk;
    params.perception = PerceptionLevel::odometry;
    bench = std::make_unique<AgentBench>(params);
    bench->obstacles = room();
    op = &bench->join("op1");
    bench->run(1500ms);
    ASSERT_EQ(bench->ask(*op, CMD_TAKE), Reason::none);
    bench->run(2s);
    ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::ok);
  }
  /// The process dies; another one is to be started half a second later.
  void crash() {
    bench->stop_agent();
    bench->command = {};  // Its parent sends zero.
    bench->run(500ms);
    op->notices.clear();
  }
  /// Each scan shows no more than `count` points.
  void show_only(std::uint32_t count) {
    bench->spoil = [count](sensor_msgs::msg::PointCloud2& cloud) {
      // The last ones are of walls.
      const std::size_t bytes = std::size_t{count} * cloud.point_step();
      std::vector<std::uint8_t> end(cloud.data().end() - static_cast<std::ptrdiff_t>(bytes),
                                    cloud.data().end());
      cloud.data() = std::move(end);
      cloud.width(count);
      cloud.row_step(static_cast<std::uint32_t>(bytes));
    };
  }
  std::string notice(const std::string& code) const {
    for (const auto& each : op->notices)
      if (each.code() == code) return each.text();
    return {};
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op{};
};

TEST_F(PlaceOfAnAgent, IsNotConfirmedByAScanThatShowsTooLittle) {
  crash();
  bench->obstacles = another_room();
  show_only(150);
  bench->start_agent();
  bench->run(2s);
  EXPECT_EQ(notice("not_localised_here"), "");
  EXPECT_EQ(bench->ask(*op, CMD_GOTO, "", 5, 0), Reason::just_restarted);
  bench->spoil = {};
  bench->run(2s);
  EXPECT_NE(notice("not_localised_here"), "");
  EXPECT_EQ(bench->ask(*op, CMD_GOTO, "", 5, 0), Reason::not_localised_here);
}

TEST_F(PlaceOfAnAgent, IsConfirmedByABetterScanThatComesLater) {
  crash();
  show_only(150);
  bench->start_agent();
  bench->run(5s);
  bench->spoil = {};
  bench->run(2s);
  EXPECT_EQ(notice("not_localised_here"), "");
  EXPECT_EQ(bench->ask(*op, CMD_GOTO, "", 5, 0), Reason::none);
}

TEST_F(PlaceOfAnAgent, IsRefusedWhenTheLidarShowsTooLittleForTenSeconds) {
  crash();
  show_only(150);
  bench->start_agent();
  bench->run(9s);
  EXPECT_EQ(notice("not_localised_here"), "");
  bench->run(3s);
  EXPECT_THAT(notice("not_localised_here"), HasSubstr("its lidar shows too little"));
  EXPECT_EQ(op->behaviour.mode(), "hold");
}

TEST_F(PlaceOfAnAgent, StaysLostWhenItsSensorsAreRestarted) {
  bench->obstacles = another_room();
  bench->run(3s);
  ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::lost);
  const double sigma = op->state.sigma();
  for (const char* component : {"sensors", "command", "sensors"}) {
    ASSERT_EQ(bench->ask(*op, CMD_RESTART, component), Reason::none) << component;
    for (int n = 0; n < 30; ++n) {
      bench->run(100ms);
      const auto health = static_cast<Localisation>(op->state.localisation());
      ASSERT_TRUE(health == Localisation::lost || health == Localisation::starting)
          << component << " " << n << " " << static_cast<int>(health);
      ASSERT_GE(op->state.sigma(), 0.99 * sigma) << component << " " << n;
    }
  }
  EXPECT_EQ(bench->ask(*op, CMD_GOTO, "", 5, 0), Reason::localisation_lost);
  ASSERT_EQ(bench->ask(*op, CMD_MODE, "hold"), Reason::none);
  ASSERT_EQ(bench->ask(*op, CMD_POSE, "", 1, 0), Reason::none);
  bench->run(1s);
  EXPECT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::ok);
  EXPECT_LT(op->state.sigma(), 100);  // mm
}

TEST_F(PlaceOfAnAgent, IsFoundAfterItsSensorsWereRestartedWhileItWasLost) {
  const PointCloud room_before = bench->obstacles;
  bench->obstacles = another_room();
  bench->run(3s);
  ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::lost);
  ASSERT_EQ(bench->ask(*op, CMD_RESTART, "sensors"), Reason::none);
  bench->run(1s);
  ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::lost);
  bench->obstacles = room_before;
  ASSERT_EQ(bench->ask(*op, CMD_RESTART, "sensors"), Reason::none);
  bench->run(4s);
  EXPECT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::ok);
  EXPECT_NEAR(op->state.x(), 0.0, 0.1);
  EXPECT_LT(op->state.sigma(), 300);  // mm
}

TEST_F(PlaceOfAnAgent, IsNotKnownBetterAfterARestart) {
  ASSERT_EQ(bench->ask(*op, CMD_GOTO, "", 8, 0), Reason::none);
  bench->run(12s);
  const double before = op->state.sigma();
  ASSERT_GT(before, 0.0);
  crash();
  bench->start_agent();
  bench->run(3s);
  ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::ok);
  EXPECT_GE(op->state.sigma(), before);
  ASSERT_EQ(bench->ask(*op, CMD_MODE, "hold"), Reason::none);
  ASSERT_EQ(bench->ask(*op, CMD_POSE, "", 8, 0), Reason::none);
  bench->run(500ms);
  EXPECT_LT(op->state.sigma(), 0.5 * before);
}

}  // namespace
}  // namespace adit::agent
