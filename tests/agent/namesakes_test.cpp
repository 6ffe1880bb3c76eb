// SPDX-License-Identifier: Apache-2.0
// Two robots with one name: one stays in service, the other gives way, and every station hears of both.
#include <gmock/gmock.h>

#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::Not;

/// A second robot that calls itself r1, with a driver that obeys exactly.
class Twin {
 public:
  explicit Twin(AgentBench& bench, Id id = {7}) : bench_(bench) {
    machine_ = bench.machine("twin");
    world_ = bench.machine("twin's world");
    strand_ = world_->strand("driver");
    driver_wire_ = bench.network().join(101, "twin's driver");
    radio_ = bench.network().join(77, "twin");
    robot_ = bench.network().join(101, "twin");
    odom_ = wire::Writer<nav_msgs::msg::Odometry>::make(*driver_wire_, wire::topics::kOdom).value();
    cmd_vel_ = wire::make_reader(*driver_wire_, wire::topics::kCmdVel, *strand_,
                                 [this](const geometry_msgs::msg::Twist& t, const wire::SampleInfo&) {
                                   moved = moved || t.linear().x() != 0 || t.angular().z() != 0;
                                 })
                   .value();
    timer_ = strand_->every(20ms, [this] {
      nav_msgs::msg::Odometry o;
      const auto ns = strand_->now().time_since_epoch().count();
      o.header().stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
      o.header().stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
      o.pose().pose().orientation().w(1.0);
      (void)odom_.write(o);
    });
    AgentParams params{};
    params.id = id;
    params.seed = 5;
    params.tree = source_folder() + "/config/trees/robot.xml";
    agent_ = std::make_unique<Agent>(params, *machine_, *radio_, *robot_);
    if (const auto started = agent_->start(); !started) throw std::runtime_error(started.error().text);
  }
  ~Twin() { agent_.reset(); }

  wire::ParticipantId participant() const { return radio_->id(); }
  bool moved{};

 private:
  AgentBench& bench_;
  std::unique_ptr<Runtime> machine_, world_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> driver_wire_, radio_, robot_;
  wire::Writer<nav_msgs::msg::Odometry> odom_{};
  std::unique_ptr<wire::RawReader> cmd_vel_{};
  Timer timer_{};
  std::unique_ptr<Agent> agent_{};
};

/// Somebody on the radio who says that he is r1, and a held one.
class Forger {
 public:
  explicit Forger(AgentBench& bench, const Id& id) : machine_(bench.machine("forger")) {
    strand_ = machine_->strand("forger");
    wire_ = bench.network().join(77, "forger");
    presence_ = wire::Writer<radio::Presence>::make(*wire_, wire::topics::kPresence).value();
    capabilities_ = wire::Writer<radio::Capabilities>::make(*wire_, wire::topics::kCapabilities).value();
    authority_ = wire::Writer<radio::AuthorityStatus>::make(*wire_, wire::topics::kAuthority).value();
    timer_ = strand_->every(250ms, [this, id] {
      radio::Presence p;
      p.name("r1"), p.kind(radio::AGENT_ROBOT), p.id(id), p.protocol(1), p.seq(1'000'000 + seq_);
      (void)presence_.write(p);
      radio::AuthorityStatus a;
      a.robot("r1"), a.epoch().start(0), a.holder("op1"), a.seq(++seq_);
      (void)authority_.write(a);
      radio::Capabilities c;
      c.name("r1"), c.kind(radio::AGENT_ROBOT), c.id(id), c.protocol(1);
      (void)capabilities_.write(c);
    });
  }

 private:
  std::unique_ptr<Runtime> machine_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  wire::Writer<radio::Presence> presence_{};
  wire::Writer<radio::Capabilities> capabilities_{};
  wire::Writer<radio::AuthorityStatus> authority_{};
  std::uint64_t seq_{};
  Timer timer_{};
};

class NamesakesTest : public testing::Test {
 protected:
  /// Reasons of all answers to a command; both robots hear it.
  std::vector<Reason> ask_both(radio::CommandKind kind, double x = 0, double y = 0) {
    op1.answers.clear();
    const auto seq = bench.send(op1, kind, {}, x, y);
    bench.run(300ms);
    std::vector<Reason> reasons;
    for (const auto& a : op1.answers)
      if (a.seq() == seq) reasons.push_back(static_cast<Reason>(a.reason()));
    std::sort(reasons.begin(), reasons.end());
    return reasons;
  }
  AgentBench bench{};
  AgentBench::Operator& op1 = bench.join("op1");
  AgentBench::Operator& op2 = bench.join("op2");
};

const std::vector<Reason> kOneObeys{Reason::none, Reason::name_taken};

TEST_F(NamesakesTest, TheOneThatAStationHeardFirstStaysAndTheOtherRefuses) {
  bench.run(6s);
  op1.follows = bench.radio().id();
  Twin twin(bench);
  op2.follows = twin.participant();
  bench.run(5s);
  EXPECT_EQ(ask_both(radio::CMD_TAKE), kOneObeys);
  EXPECT_EQ(op1.authority.holder(), "op1");
  EXPECT_EQ(op2.authority.holder(), "");
  EXPECT_EQ(ask_both(radio::CMD_GOTO, 3.0, 0.0), kOneObeys);
  bench.run(3s);
  EXPECT_GT(bench.pose.x, 0.5);
  EXPECT_FALSE(twin.moved);
  EXPECT_EQ(op2.behaviour.mode(), "hold");
  EXPECT_EQ(static_cast<Reason>(op2.behaviour.reason()), Reason::name_taken);
  for (const AgentBench::Operator* op : {&op1, &op2}) {
    const auto codes = op->notice_codes();
    EXPECT_EQ(std::count(codes.begin(), codes.end(), "name_taken"), 2) << op->name;
  }
}

TEST_F(NamesakesTest, ARobotWithTheSameIdGivesWayAsWell) {
  bench.run(6s);
  op1.follows = bench.radio().id();
  Twin twin(bench, op1.capabilities.id());
  bench.run(5s);
  EXPECT_EQ(ask_both(radio::CMD_TAKE), kOneObeys);
  EXPECT_EQ(op1.authority.holder(), "op1");
}

TEST_F(NamesakesTest, OfTwoThatStartTogetherTheLowerStartIdStays) {
  Twin twin(bench);
  op1.follows = bench.radio().id();
  op2.follows = twin.participant();
  bench.run(8s);
  const bool first_is_lower = op1.authority.epoch().start() < op2.authority.epoch().start();
  EXPECT_EQ(ask_both(radio::CMD_TAKE), kOneObeys);
  EXPECT_EQ(op1.authority.holder(), first_is_lower ? "op1" : "");
  EXPECT_EQ(op2.authority.holder(), first_is_lower ? "" : "op1");
}

TEST_F(NamesakesTest, AStopIsObeyedByBoth) {
  bench.run(6s);
  op1.follows = bench.radio().id();
  Twin twin(bench);
  op2.follows = twin.participant();
  bench.run(5s);
  EXPECT_EQ(ask_both(radio::CMD_STOP), (std::vector<Reason>{Reason::none, Reason::none}));
  EXPECT_TRUE(op1.behaviour.stopped());
  EXPECT_TRUE(op2.behaviour.stopped());
}

TEST_F(NamesakesTest, AStrangerCannotPutAHeldRobotOutOfWork) {
  bench.run(2s);
  op1.follows = bench.radio().id();
  ASSERT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none);
  ASSERT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 30.0, 0.0), Reason::none);
  bench.run(2s);
  Forger forger(bench, op1.capabilities.id());
  bench.run(5s);
  const double before = bench.pose.x;
  bench.run(3s);
  EXPECT_GT(bench.pose.x, before + 1.0);
  EXPECT_EQ(op1.behaviour.mode(), "waypoint");
  EXPECT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 40.0, 0.0), Reason::none);
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "hold"), Reason::none);
  EXPECT_THAT(op2.notice_codes(), Contains("name_taken"));
}

TEST_F(NamesakesTest, ARestartIsNoNamesake) {
  bench.run(6s);
  bench.stop_agent();
  bench.run(300ms);
  bench.start_agent();
  bench.run(6s);
  EXPECT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none);
  EXPECT_THAT(op1.notice_codes(), Not(Contains("name_taken")));
}

TEST_F(NamesakesTest, ReturnsToServiceWhenTheOtherHasLeft) {
  bench.run(6s);
  Twin twin(bench);
  op1.follows = op2.follows = twin.participant();
  bench.run(5s);
  bench.stop_agent();
  bench.run(3s);
  EXPECT_EQ(static_cast<Reason>(op2.behaviour.reason()), Reason::none);
  EXPECT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none);
}

}  // namespace
}  // namespace adit::agent
