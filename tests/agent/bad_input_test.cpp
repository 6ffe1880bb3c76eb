// SPDX-License-Identifier: Apache-2.0
// Wrong samples of the sensors to a complete agent: each has a reason that the operator reads, and the robot
// stands where its surroundings or its attitude cannot be known. Once the sensors are right, it drives again.
#include <gmock/gmock.h>

#include <functional>

#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using sensor_msgs::msg::PointCloud2;

struct BadInput {
  const char* name;
  std::function<void(AgentBench&)> spoil;
  const char* code;
  Reason reason;
  const char* text;  ///< Part of what the operator reads.
  bool stands;       ///< The robot must stand.
};

float& z_of(PointCloud2& cloud, std::size_t n) {
  return *reinterpret_cast<float*>(cloud.data().data() + n * cloud.point_step() + 8);
}

void each_z(PointCloud2& cloud, const std::function<float(float)>& change) {
  for (std::size_t n = 0; n < cloud.width(); ++n) z_of(cloud, n) = change(z_of(cloud, n));
}

/// Adds a time to each point, equally spaced over `span` (of whatever unit).
void add_times(PointCloud2& cloud, float span) {
  std::vector<float> numbers;
  for (std::size_t n = 0; n < cloud.width(); ++n) {
    const auto* at = reinterpret_cast<const float*>(cloud.data().data() + n * cloud.point_step());
    numbers.insert(numbers.end(), at, at + 3);
    numbers.push_back(span * static_cast<float>(n) / static_cast<float>(cloud.width()));
  }
  const auto header = cloud.header();
  cloud = cloud_of(numbers, 4);
  cloud.header(header);
  sensor_msgs::msg::PointField field;
  field.name("t");
  field.offset(12);
  field.datatype(7);
  field.count(1);
  cloud.fields().push_back(field);
}

const float kNotANumber = std::numeric_limits<float>::quiet_NaN();

const std::vector<BadInput>& cases() {
  static const std::vector<BadInput> all{
      {"NoNumbers",
       [](AgentBench& b) { b.spoil = [](auto& c) { each_z(c, [](float) { return kNotANumber; }); }; },
       "sensor_refused", Reason::scan_empty, "1080 points", true},
      {"NoPoints",
       [](AgentBench& b) {
         b.spoil = [](auto& c) {
           c.width(0);
           c.data().clear();
         };
       },
       "sensor_refused", Reason::scan_empty, "none of the scan's 0 points", true},
      {"AForeignFrame", [](AgentBench& b) { b.spoil = [](auto& c) { c.header().frame_id("velodyne"); }; },
       "sensor_refused", Reason::frame_unknown, "'velodyne'", true},
      {"AFieldIsMissing", [](AgentBench& b) { b.spoil = [](auto& c) { c.fields()[2].name("h"); }; },
       "sensor_refused", Reason::malformed, "float32 z", true},
      {"TimesThatAreNoSweep", [](AgentBench& b) { b.spoil = [](auto& c) { add_times(c, 0.8f); }; },
       "sensor_refused", Reason::sensor_times, "no unit", true},
      {"TimesInMilliseconds", [](AgentBench& b) { b.spoil = [](auto& c) { add_times(c, 90.0f); }; }, "",
       Reason::none, "", false},
      {"ScansOutOfOrder",
       [](AgentBench& b) {
         b.spoil = [odd = false](auto& c) mutable {
           odd = !odd;
           if (odd) c.header().stamp().nanosec(0);
         };
       },
       "sensor_refused", Reason::sensor_times, "come after newer ones", false},
      {"ALidarUnderTheFloor",
       [](AgentBench& b) {
         b.send_frame("velodyne", -0.3);
         b.spoil = [](auto& c) { c.header().frame_id("velodyne"); };
       },
       "sensor_refused", Reason::lidar_mounting, "under the floor", true},
      {"ALidarThatHangsUpsideDown",
       [](AgentBench& b) { b.spoil = [](auto& c) { each_z(c, [](float z) { return 1 - z; }); }; },
       "sensor_refused", Reason::lidar_mounting, "no ground below", true},
      {"AnImuUpsideDown",
       [](AgentBench& b) {
         b.force = {0, 0, -9.81};
       },
       "sensor_refused", Reason::imu_mounting, "180 degrees", true},
      {"AnImuInFeet",
       [](AgentBench& b) {
         b.force = {0, 0, 32.2};
       },
       "sensor_refused", Reason::imu_mounting, "neither", true},
      {"AnImuInG",
       [](AgentBench& b) {
         b.force = {0, 0, 1};
       },
       "imu_in_g", Reason::none, "scaled", false},
      {"AnImuWithoutNumbers",
       [](AgentBench& b) {
         b.force = {0, 0, std::nan("")};
       },
       "sensor_refused", Reason::malformed, "no number", false},
      {"AnImuWithoutStamps",
       [](AgentBench& b) {
         b.force = {0, 0, 9.81};
         b.spoil_imu = [](auto& sample) { sample.header().stamp({}); };
       },
       "sensor_refused", Reason::sensor_times, "'imu/data' have no stamp", false},
      {"OdometryWithoutAnOrientation",
       [](AgentBench& b) { b.spoil_odometry = [](auto& o) { o.pose().pose().orientation({}); }; },
       "sensor_refused", Reason::malformed, "its orientation 0 0 0 0 is no quaternion", true},
      {"OdometryFarAway",
       [](AgentBench& b) { b.spoil_odometry = [](auto& o) { o.pose().pose().position().x(5e6); }; },
       "sensor_refused", Reason::malformed, "within 1000 km", true},
      {"OdometryWithoutStamps",
       [](AgentBench& b) { b.spoil_odometry = [](auto& o) { o.header().stamp({}); }; }, "not_deskewed",
       Reason::sensor_times, "odometry on /odom has no stamps", false},
      {"ALidarOfAnotherClock",
       [](AgentBench& b) {
         b.spoil = [](auto& c) { c.header().stamp().sec(c.header().stamp().sec() + 100); };
       },
       "not_deskewed", Reason::sensor_times, "100.0 s ahead of the odometry", false},
      {"AChargeInPercent", [](AgentBench& b) { b.charge = 17.0f; }, "sensor_refused", Reason::out_of_range,
       "charge on /battery_state is 17, as if it were percent", false},
      {"AnImuThatIsSilent", [](AgentBench&) {}, "sensor_silent", Reason::sensor_silent, "'imu/data'", false},
  };
  return all;
}

AgentParams with_sensors() {
  AgentParams params{};
  params.platform.lidars = {LidarConfig{.mounting = {.z = 0.5}}};
  params.platform.imu = ImuConfig{.mounting = {.z = 0.2}};
  return params;
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsReportedAndSurvived) {
  const BadInput& bad = GetParam();
  AgentBench bench{with_sensors()};
  AgentBench::Operator& op1 = bench.join("op1");
  bench.run(1500ms);
  ASSERT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none);
  bench.stream(op1, 0.0, 300ms);
  ASSERT_EQ(bench.ask(op1, radio::CMD_MODE, "smart_joystick"), Reason::none);
  bench.stream(op1, 0.5, 1s);
  ASSERT_GT(bench.command.vx, 0.2);

  bad.spoil(bench);
  bench.stream(op1, 0.5, 2500ms);
  if (bad.stands)
    EXPECT_EQ(bench.command, Twist2{});
  else
    EXPECT_GT(bench.command.vx, 0.2);
  const auto reported = std::find_if(op1.notices.begin(), op1.notices.end(), [&](const auto& n) {
    return n.code() == bad.code && n.reason() == static_cast<std::uint16_t>(bad.reason);
  });
  const bool expected = *bad.code != 0;
  if (expected) {
    ASSERT_NE(reported, op1.notices.end());
    EXPECT_THAT(reported->text(), testing::HasSubstr(bad.text));
  } else {
    EXPECT_THAT(op1.notice_codes(), testing::Not(testing::Contains("sensor_refused")));
  }

  bench.spoil = {};
  bench.spoil_odometry = {};
  bench.spoil_imu = {};
  bench.charge = {};
  bench.force = {0, 0, 9.81};
  bench.run(2s);
  bench.stream(op1, 0.0, 300ms);
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "smart_joystick"), Reason::none) << "once all is right again";
  bench.stream(op1, 0.5, 1s);
  EXPECT_GT(bench.command.vx, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Sensors, BadInputTest, testing::ValuesIn(cases()),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace adit::agent
