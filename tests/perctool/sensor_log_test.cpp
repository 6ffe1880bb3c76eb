// SPDX-License-Identifier: Apache-2.0
// Recorded sensor data, whole and broken.
#include "sim/perctool/sensor_log.hpp"

#include <gtest/gtest.h>

#include "tests/sim/scratch.hpp"

namespace adit::sim::perctool {
namespace {

struct Log : SensorSink {
  void on_imu(const perception::ImuSample& sample) override { order += 'i', last_imu = sample; }
  void on_wheels(const perception::BodyMotion& sample) override { order += 'w', last_wheels = sample; }
  Result<void> on_sweep(perception::Sweep&& sweep) override {
    order += 'S';
    stamps.push_back(sweep.stamp);
    return {};
  }
  std::string order{};
  perception::ImuSample last_imu{};
  perception::BodyMotion last_wheels{};
  std::vector<std::uint64_t> stamps{};
};

TEST(SensorLog, PlaysCloudsImuAndWheelsInTheOrderOfTime) {
  const Scratch scratch;
  for (const char* name : {"0.bin", "1.bin", "2.bin"}) scratch.write(name, std::string(16, '\0'));
  scratch.write("imu.csv", "stamp_s,gx,gy,gz,ax,ay,az\n0.00,1,2,3,4,5,6\n0.3,0,0,0.5,0,0,9.81\r\n");
  scratch.write("wheels.tum", "0.1 1 0 0 0 0 0 1\n");
  Log log;
  const auto played = play_log({.clouds = scratch.path("").string(),
                                .rate = 10.0,
                                .imu = scratch.path("imu.csv").string(),
                                .wheels = scratch.path("wheels.tum").string()},
                               log);
  ASSERT_TRUE(played.ok()) << played.error().text;
  EXPECT_EQ(log.order, "iSwSSi");
  EXPECT_EQ(log.stamps.back(), kLogStart + 200'000'000);
  EXPECT_EQ(log.last_imu.stamp, kLogStart + 300'000'000);
  EXPECT_EQ(log.last_imu.accel.z(), 9.81);
  EXPECT_EQ(log.last_wheels.pose.position.x(), 1.0);
}

TEST(SensorLog, MotionBesideTheTimeOfTheCloudsIsRefused) {
  const Scratch scratch;
  for (const char* name : {"0.bin", "1.bin", "2.bin"}) scratch.write(name, std::string(16, '\0'));
  scratch.write("imu.csv", "1700000000.00,1,2,3,4,5,6\n1700000000.3,0,0,0.5,0,0,9.81\n");
  scratch.write("wheels.tum", "1700000000.1 1 0 0 0 0 0 1\n");
  scratch.write("early.tum", "-9.5 1 0 0 0 0 0 1\n");
  const SensorLogOptions clouds{.clouds = scratch.path("").string()};
  for (const char* name : {"imu.csv", "wheels.tum", "early.tum"}) {
    SensorLogOptions options = clouds;
    (name[0] == 'i' ? options.imu : options.wheels) = scratch.path(name).string();
    Log log;
    const auto played = play_log(options, log);
    ASSERT_EQ(played.reason(), Reason::out_of_range) << name;
    EXPECT_NE(played.error().text.find("those of the clouds from 0 to 0.300 s"), std::string::npos)
        << played.error().text;
    EXPECT_EQ(played.error().text.find("since 1970") != std::string::npos, name[0] != 'e');
    EXPECT_TRUE(log.order.empty());
  }
}

TEST(SensorLog, BrokenImuFilesNameTheirLine) {
  const Scratch scratch;
  for (const char* line : {"0,1,2,3,4,5", "0,1,2,3,4,5,6,7", "0;1;2;3;4;5;6", "0,1,2,3,4,5,nan",
                           "-1,1,2,3,4,5,6", "x,1,2,3,4,5,6", "1e300,1,2,3,4,5,6"}) {
    scratch.write("imu.csv", std::string("0,1,2,3,4,5,6\n") + line + "\n");
    const auto read = read_imu_csv(scratch.path("imu.csv"));
    ASSERT_FALSE(read.ok()) << line;
    EXPECT_NE(read.error().text.find("imu.csv:2:"), std::string::npos) << read.error().text;
  }
  EXPECT_EQ(read_imu_csv(scratch.path("none.csv")).reason(), Reason::cannot_read);
}

TEST(SensorLog, ARecordingThatIsNoneOrCutIsAnError) {
  const Scratch scratch;
  scratch.write("a.mcap", "no recording");
  Log log;
  EXPECT_FALSE(play_log({.clouds = scratch.path("a.mcap").string()}, log).ok());
  EXPECT_FALSE(play_log({.clouds = scratch.path("none.mcap").string()}, log).ok());
  EXPECT_FALSE(play_log({.clouds = scratch.path("a.mcap").string(), .imu = "imu.csv"}, log).ok());
}

}  // namespace
}  // namespace adit::sim::perctool
