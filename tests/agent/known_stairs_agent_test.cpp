// SPDX-License-Identifier: Apache-2.0
// Which staircases an agent gives to its router, and where. A wheeled robot in a closed room with a staircase
// plans a route to a place above it: the refusal names the staircase that the router knows.
#include <gmock/gmock.h>

#include "core/findings/stairs_data.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A floor of 17 x 9 m with a point each 0.15 m, and walls around it with one each 0.1 m.
PointCloud closed_room() {
  constexpr float kX0 = -5.0f, kX1 = 12.0f, kY = 4.5f;  // m
  PointCloud points;
  for (float x = kX0; x <= kX1; x += 0.15f)
    for (float y = -kY; y <= kY; y += 0.15f) points.emplace_back(x, y, 0.0f);
  for (float z = 0.2f; z < 2.0f; z += 0.2f) {
    for (float x = kX0; x <= kX1; x += 0.1f)
      for (const float y : {-kY, kY}) points.emplace_back(x, y, z);
    for (float y = -kY; y <= kY; y += 0.1f)
      for (const float x : {kX0, kX1}) points.emplace_back(x, y, z);
  }
  return points;
}

class KnownStairsOfAnAgent : public testing::Test {
 protected:
  void SetUp() override {
    AgentParams params;
    params.boot = 1;
    params.disk = disk;
    params.platform.router = "graph";
    params.perception = PerceptionLevel::slam;
    bench = std::make_unique<AgentBench>(params);
    bench->obstacles = closed_room();
    op = &bench->join("op1");
    bench->run(1500ms);
    ASSERT_EQ(bench->ask(*op, radio::CMD_TAKE), Reason::none);
    bench->run(2s);
    ASSERT_EQ(static_cast<Localisation>(op->state.localisation()), Localisation::ok);
    bench->agent().report(stairs(1000, {5, 0, 0.08}));
    bench->run(1s);
  }
  /// Twelve steps of 0.16 m up along x, 1.92 m high.
  static findings::Finding stairs(std::uint64_t id, const std::array<double, 3>& foot) {
    const Staircase twelve{
        .foot = {foot[0], foot[1], foot[2]},
        .heading = 0.0,
        .rise = 0.16,
        .run = 0.25,
        .width = 1.4,
        .steps = 12,
        .sigma = {.place = 0.02, .heading = 0.01, .rise = 0.004, .run = 0.005, .width = 0.05}};
    findings::Finding finding;
    finding.key.id = id;
    finding.kind = findings::kStairs;
    finding.importance = 5;
    finding.position = foot;
    finding.data = findings::encode_stairs(twelve);
    return finding;
  }
  /// What `plan` answers for the floor above.
  std::string plan_above() {
    radio::Command command;
    command.robot("r1");
    command.station(op->name);
    command.station_id(op->id);
    command.epoch(op->authority.epoch());
    command.seq(++op->seq);
    command.kind(radio::CMD_PLAN);
    command.numbers({20.0, 0.0, 1.92});
    (void)op->command.write(command);
    bench->run(1s);
    for (const auto& answer : op->answers)
      if (answer.seq() == op->seq) return answer.text();
    return "no answer";
  }
  /// The process dies and another one is started.
  void restart() {
    bench->stop_agent();
    bench->command = {};
    bench->run(500ms);
    bench->start_agent();
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op{};
};

TEST_F(KnownStairsOfAnAgent, AreWhereACorrectedMapHasThem) {
  EXPECT_THAT(plan_above(), HasSubstr("whose foot is at 5.0 0.0"));
  std::optional<Result<MapFrame>> corrected;
  bench->agent().map_frame(bench->strand(), [&](const Result<MapFrame>& frame) {
    ASSERT_TRUE(frame.ok());
    MapFrame to = *frame;
    to.T_map_odom.position.y() += 0.5;
    bench->agent().correct_map(bench->strand(), to, [&](const Result<MapFrame>& done) { corrected = done; });
  });
  bench->run(2s);
  ASSERT_TRUE(corrected && corrected->ok());
  EXPECT_THAT(plan_above(), HasSubstr("whose foot is at 5.0 0.5"));
}

TEST_F(KnownStairsOfAnAgent, TheNearestOnesReachTheRouter) {
  for (std::uint64_t id = 1; id <= 40; ++id)
    bench->agent().report(stairs(id, {100.0 + 4.0 * static_cast<double>(id), 80.0, 0.08}));
  bench->run(1s);
  EXPECT_THAT(plan_above(), HasSubstr("whose foot is at 5.0 0.0"));
}

TEST_F(KnownStairsOfAnAgent, OfAnEarlierStartCountOnceTheRobotKnowsItsPlace) {
  // The lidar shows too little to compare.
  bench->spoil = [](sensor_msgs::msg::PointCloud2& cloud) {
    constexpr std::uint32_t kPoints = 60;
    cloud.data().resize(std::size_t{kPoints} * cloud.point_step());
    cloud.width(kPoints);
    cloud.row_step(kPoints * cloud.point_step());
  };
  restart();
  bench->run(4s);
  EXPECT_THAT(plan_above(), Not(HasSubstr("steps of"))) << "it may be elsewhere";
  bench->spoil = {};
  bench->run(4s);
  EXPECT_THAT(plan_above(), HasSubstr("12 steps of 0.16 m"));
}

}  // namespace
}  // namespace adit::agent
