// SPDX-License-Identifier: Apache-2.0
// What arrives on the robot domain from drivers that are not as the agent expects: other types, other units,
// and two of them.
#include <gmock/gmock.h>

#include <limits>

#include "geometry_msgs/msg/TwistStamped.h"
#include "robot_agent/motion/charge_input.hpp"
#include "robot_agent/motion/input_faults.hpp"
#include "robot_agent/motion/one_source.hpp"
#include "robot_agent/motion/topic_types.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr wire::ParticipantId kA{1}, kB{2};

TEST(OneSourceTest, KeepsToTheFirstWhileItIsHeard) {
  OneSource source;
  Time at{10s};
  EXPECT_EQ(source.take(kA, at), OneSource::Use::yes);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(source.take(kB, at += 20ms), OneSource::Use::no);
  }
  EXPECT_EQ(source.take(kA, at += 20ms), OneSource::Use::besides);
  EXPECT_THAT(source.describe(), HasSubstr("participant 010000"));
  EXPECT_THAT(source.describe(), HasSubstr("participant 020000"));
  EXPECT_EQ(source.take(kA, at += 5s), OneSource::Use::yes) << "the other one is gone";
  EXPECT_EQ(source.take(kB, at += 600ms), OneSource::Use::yes) << "the first one is gone";
}

TEST(OneSourceTest, ADriverThatIsRestartedIsNoSecondOne) {
  OneSource source;
  Time at{10s};
  EXPECT_EQ(source.take(kA, at), OneSource::Use::yes);
  for (int i = 0; i < 25; ++i) EXPECT_EQ(source.take(kB, at += 20ms), OneSource::Use::no);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(source.take(kB, at += 20ms), OneSource::Use::yes);
}

TEST(ChargeInputTest, PercentIsUnknownAndStaysSo) {
  ChargeInput input;
  EXPECT_FLOAT_EQ(input.take(0.5f, kA).value(), 0.5f);
  EXPECT_FLOAT_EQ(input.take(1.005f, kA).value(), 1.0f) << "full, with the sensor's error";
  EXPECT_EQ(input.take(std::numeric_limits<float>::quiet_NaN(), kA).value(), ChargeInput::kUnknown);
  EXPECT_EQ(input.take(-0.2f, kA).reason(), Reason::out_of_range);
  EXPECT_FLOAT_EQ(input.take(0.4f, kA).value(), 0.4f);
  EXPECT_EQ(input.take(17.0f, kA).reason(), Reason::out_of_range);
  EXPECT_EQ(input.take(0.8f, kA).reason(), Reason::out_of_range) << "0.8 % or 80 %";
  EXPECT_EQ(input.take(std::numeric_limits<float>::infinity(), kB).reason(), Reason::out_of_range);
  EXPECT_FLOAT_EQ(input.take(0.8f, kA).value(), 0.8f) << "another driver";
}

TEST(InputFaultsTest, EachFaultIsToldOnceAndWhenItReturns) {
  std::vector<Notice> told;
  std::vector<contract::ComponentHealth> rows;
  InputFaults faults("r1", {[&](const Notice& notice) { told.push_back(notice); },
                            [&](const contract::ComponentHealth& row) { rows.push_back(row); }});
  const InputFault odometry{"odom", "sensor_refused", Severity::error, {Reason::malformed, "no quaternion"}};
  const InputFault battery{"battery", "sensor_refused", Severity::warning, {Reason::out_of_range, "percent"}};
  Time at{1s};
  for (int i = 0; i < 1000; ++i) {
    faults.report(odometry, at += 20ms);
    faults.tick(at);
  }
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].text, "r1: no quaternion");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_FALSE(rows[0].healthy);
  faults.report(battery, at);
  EXPECT_EQ(rows.back().text, "no quaternion; percent");
  faults.tick(at += InputFaults::kQuiet);
  EXPECT_TRUE(rows.back().healthy);
  EXPECT_EQ(rows.back().text, "");
  faults.report(odometry, at);
  EXPECT_EQ(told.size(), 3U);
}

TEST(InputFaultsTest, TheNumberOfFaultsIsBounded) {
  int told = 0;
  InputFaults faults("r1", {[&](const Notice&) { ++told; }, [](const contract::ComponentHealth&) {}});
  for (int i = 0; i < 1000; ++i)
    faults.report({std::to_string(i), "sensor_refused", Severity::error, {Reason::malformed, "x"}}, Time{1s});
  EXPECT_LE(told, 32);
}

TEST(TopicTypesTest, TypesAreNamedAsRosDoes) {
  EXPECT_EQ(ros_type("geometry_msgs::msg::dds_::TwistStamped_"), "geometry_msgs/msg/TwistStamped");
  EXPECT_EQ(ros_type("Strange"), "Strange");
  EXPECT_EQ(ros_type(""), "");
}

/// A bench with an operator that holds the robot, and a further participant on the robot domain.
class Inputs : public testing::Test {
 protected:
  void begin(AgentParams params = {}) {
    bench = std::make_unique<AgentBench>(std::move(params));
    op1 = &bench->join("op1");
    other = bench->network().join(100, "other");
    bench->run(1500ms);
    ASSERT_EQ(bench->ask(*op1, radio::CMD_TAKE), Reason::none);
  }
  ~Inputs() override { other.reset(); }
  std::string health(const std::string& name) const {
    for (const auto& row : op1->health.components())
      if (row.name() == name) return row.text();
    return "no row";
  }
  std::string text_of(const std::string& code) const {
    for (const auto& notice : op1->notices)
      if (notice.code() == code) return notice.text();
    return "no notice";
  }

  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op1{};
  std::unique_ptr<wire::Participant> other{};
};

TEST_F(Inputs, AnotherTypeOfVelocitiesIsToldAtOnce) {
  AgentParams params{};
  params.velocity = VelocityType::twist_stamped;
  begin(std::move(params));
  bench->run(2s);
  EXPECT_THAT(text_of("type_differs"), HasSubstr("reads geometry_msgs/msg/Twist, but the agent sends "
                                                 "geometry_msgs/msg/TwistStamped, which nobody reads: set "
                                                 "`cmd_vel: twist` in the robot's file"));
  EXPECT_THAT(health("inputs"), HasSubstr("geometry_msgs/msg/TwistStamped"));
  EXPECT_THAT(op1->notice_codes(), Not(Contains("velocities_unread"))) << "one cause, one notice";
}

TEST_F(Inputs, ATopicOfAnotherTypeIsToldByBothNames) {
  begin();
  const wire::TopicInfo strange{
      "rt/points", "sensor_msgs::msg::dds_::PointCloud_", wire::QosClass::sensor, 1, wire::topics::kUnkeyed,
      1024};
  auto writer = other->make_writer(strange, "");
  bench->run(2s);
  EXPECT_THAT(text_of("type_differs"), HasSubstr("sends sensor_msgs/msg/PointCloud, but the agent reads "
                                                 "sensor_msgs/msg/PointCloud2"));
  op1->notices.clear();
  bench->run(30s);
  EXPECT_THAT(op1->notice_codes(), Not(Contains("type_differs"))) << "told once";
  EXPECT_THAT(health("inputs"), HasSubstr("PointCloud2"));
  writer = Error{Reason::none, ""};
  bench->run(15s);
  EXPECT_EQ(health("inputs"), "");
}

TEST_F(Inputs, ExternalTakesStampedVelocitiesToo) {
  begin();
  for (const bool stamped : {true, false}) {
    auto plain =
        stamped
            ? wire::Writer<geometry_msgs::msg::Twist>{}
            : wire::Writer<geometry_msgs::msg::Twist>::make(*other, wire::topics::kExternalCmdVel).value();
    auto with_header = stamped ? wire::Writer<geometry_msgs::msg::TwistStamped>::make(
                                     *other, wire::topics::kExternalCmdVelStamped)
                                     .value()
                               : wire::Writer<geometry_msgs::msg::TwistStamped>{};
    const Timer timer = bench->strand().every(50ms, [&] {
      geometry_msgs::msg::TwistStamped velocity;
      velocity.twist().linear().x(0.3);
      if (plain) (void)plain.write(velocity.twist());
      if (with_header) (void)with_header.write(velocity);
    });
    bench->run(3s);
    EXPECT_EQ(bench->ask(*op1, radio::CMD_MODE, "external"), Reason::none) << stamped;
    bench->run(2s);
    EXPECT_GT(bench->command.vx, 0.2) << stamped;
    EXPECT_THAT(op1->notice_codes(), Not(Contains("type_differs")));
    plain = {};
    with_header = {};
    bench->run(3s);
    EXPECT_EQ(bench->command.vx, 0.0);
  }
}

TEST_F(Inputs, ASecondSourceOfOdometryIsLeftOutAndTold) {
  begin();
  auto odometry = wire::Writer<nav_msgs::msg::Odometry>::make(*other, wire::topics::kOdom).value();
  const Timer timer = bench->strand().every(20ms, [&] {
    nav_msgs::msg::Odometry sample;
    sample.header().stamp().sec(1);
    sample.pose().pose().position().x(-7);
    sample.pose().pose().orientation().w(1);
    (void)odometry.write(sample);
  });
  bench->run(3s);
  EXPECT_THAT(op1->notice_codes(), Not(Contains("odometry_jumped")));
  EXPECT_THAT(text_of("two_sources"), HasSubstr("two participants send /odom: participant "));
  EXPECT_THAT(health("inputs"), HasSubstr("two participants send /odom"));
  EXPECT_NEAR(op1->state.x(), 0.0, 0.1);
  bench->stream(*op1, 0.0, 300ms);
  ASSERT_EQ(bench->ask(*op1, radio::CMD_MODE, "smart_joystick"), Reason::none);
  bench->stream(*op1, 0.5, 1s);
  EXPECT_GT(bench->command.vx, 0.2);
}

// A driver sends them once, and a component that is made again has none of its own.
TEST_F(Inputs, FixedFramesOutliveTheSensorsComponent) {
  begin();
  bench->send_frame("velodyne", 0.01);
  bench->lidar_frame = "velodyne";
  bench->run(1s);
  for (int restarts = 0; restarts < 2; ++restarts) {
    bench->stream(*op1, 0.0, 300ms);
    ASSERT_EQ(bench->ask(*op1, radio::CMD_MODE, "smart_joystick"), Reason::none) << restarts;
    bench->stream(*op1, 0.5, 1s);
    EXPECT_GT(bench->command.vx, 0.1) << restarts;
    ASSERT_EQ(bench->ask(*op1, radio::CMD_RESTART, "sensors"), Reason::none);
    bench->run(3s);
  }
  EXPECT_THAT(op1->notice_codes(), Not(Contains("sensor_refused")));
}

TEST_F(Inputs, AChargeInPercentIsUnknown) {
  AgentParams params{};
  begin(std::move(params));
  bench->charge = 12.0f;
  bench->run(5s);
  EXPECT_LT(op1->state.battery(), 0.0f);
  bench->charge = 0.9f;
  bench->run(5s);
  EXPECT_LT(op1->state.battery(), 0.0f) << "0.9 %";
}

}  // namespace
}  // namespace adit::agent
