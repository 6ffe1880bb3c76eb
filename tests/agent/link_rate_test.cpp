// SPDX-License-Identifier: Apache-2.0
// The agent's periodic messages follow what its link gives.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/wire/cost.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

const wire::LinkProfile kMesh100k{.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1};

class LinkRate : public testing::Test {
 protected:
  explicit LinkRate(int stations = 5) {
    for (int i = 1; i <= stations; ++i) ops.push_back(&bench.join("op" + std::to_string(i)));
    bench.network().set_tap([this](const wire::SampleEvent& frame) {
      if (frame.kind != wire::SampleEvent::Kind::sent || frame.from_name != "r1" || frame.domain != 77)
        return;
      if (frame.topic == "adit/robot_state") ++states;
      offered += static_cast<double>(wire::WireCost::sample(frame.bytes.size(), 500) * ops.size());
    });
    bench.run(3s);
  }
  void link(const wire::LinkProfile& profile) {
    for (auto* op : ops) bench.network().set_link("r1", op->name, profile);
  }
  /// States a second over so long.
  double rate(Duration time) {
    states = 0;
    offered = 0;
    bench.run(time);
    return states / seconds(time);
  }

  AgentBench bench{};
  std::vector<AgentBench::Operator*> ops{};
  int states{};
  double offered{};  // bytes that r1 wrote, times its readers
};

TEST_F(LinkRate, TenTimesASecondWhereThereIsRoom) {
  EXPECT_NEAR(rate(10s), 10.0, 0.11);
  EXPECT_EQ(ops[0]->link.state_rate(), 10.0F);
  EXPECT_EQ(ops[0]->link.link(), "lan");
}

TEST_F(LinkRate, FallsToWhatAThinLinkCarriesAndComesBackWithIt) {
  link(kMesh100k);
  bench.run(5s);
  const double thin = rate(20s);
  EXPECT_LT(thin, 8.0);
  EXPECT_GE(thin, 0.95);
  EXPECT_LT(offered * 8.0 / 20.0, 90e3);
  EXPECT_EQ(ops[0]->link.link(), "lan");  // of the machine's own profile; what is set by pairs is the world's
  EXPECT_LT(ops[0]->link.state_rate(), 9.0F);
  link({});
  bench.run(8s);
  EXPECT_NEAR(rate(5s), 10.0, 0.21);
}

TEST_F(LinkRate, CommandsKeepTheirLatencyOnAFullLink) {
  link({.bandwidth = 40e3, .latency = 0.05});
  bench.run(10s);
  std::vector<double> took;
  for (int i = 0; i < 20; ++i) {
    const std::uint64_t seq = bench.send(*ops[0], radio::CMD_STOP);
    const Duration begin = bench.elapsed();
    const auto answered = [&] {
      return std::any_of(ops[0]->answers.begin(), ops[0]->answers.end(),
                         [&](const auto& a) { return a.seq() == seq && a.station_id() == ops[0]->id; });
    };
    while (!answered() && bench.elapsed() - begin < 5s) bench.run(10ms);
    took.push_back(seconds(bench.elapsed() - begin));
    bench.run(500ms);
  }
  // Twice 50 ms, the frame on the air (100 ms at 500 B), and the answer's own airtime to each of five.
  EXPECT_LT(*std::max_element(took.begin(), took.end()), 0.6);
}

TEST_F(LinkRate, AStickInUseHoldsFiveStatesASecond) {
  auto& op = *ops[0];
  ASSERT_EQ(bench.ask(op, radio::CMD_TAKE), Reason::none);
  link({.bandwidth = 12e3, .latency = 0.02});
  bench.run(20s);
  EXPECT_LT(rate(10s), 2.0);
  bench.stream(op, 0.0, 2s);
  states = 0;
  bench.stream(op, 0.0, 4s);
  EXPECT_GE(states, 19);
  bench.run(3s);
  EXPECT_LT(rate(5s), 3.0);
}

TEST_F(LinkRate, PeriodicStatusIsStretchedNotStopped) {
  link({.bandwidth = 12e3, .latency = 0.02});
  bench.run(20s);
  int reports = 0;
  bench.network().set_tap([&](const wire::SampleEvent& frame) {
    reports +=
        frame.kind == wire::SampleEvent::Kind::sent && frame.from_name == "r1" && frame.topic == "adit/link";
  });
  bench.run(24s);
  EXPECT_GE(reports, 3);
  EXPECT_LE(reports, 6);
}

}  // namespace
}  // namespace adit::agent
