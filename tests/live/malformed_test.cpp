// SPDX-License-Identifier: Apache-2.0
// Samples that are none, on every topic, to a robot_agent and a basestation that run.
#include "tests/live/programs.hpp"
#include "tests/wire/samples.hpp"

namespace adit::live {
namespace {

using namespace std::chrono_literals;

/// What a broken or hostile writer makes of a good sample.
std::vector<std::vector<std::uint8_t>> damaged(const wire::Example& example) {
  std::vector<std::vector<std::uint8_t>> all;
  auto truncated = example.bytes;
  while (truncated.size() > 8 && (truncated.size() % 4 != 0 || example.decodes(truncated)))
    truncated.pop_back();
  all.push_back(truncated);
  auto encapsulation = example.bytes;
  encapsulation[1] = 0x42;
  all.push_back(encapsulation);
  // Lengths beyond the data, and bools of 255: wherever they are.
  for (std::size_t at = 4; at < example.bytes.size(); at += 4) {
    auto long_one = example.bytes;
    for (std::size_t i = at; i < std::min(at + 4, long_one.size()); ++i) long_one[i] = 0xff;
    if (!example.decodes(long_one)) all.push_back(std::move(long_one));
  }
  return all;
}

int malformed_of(const nlohmann::json& net, const std::string& agent) {
  if (net.is_object())
    for (const auto& row : net.value("agents", nlohmann::json::array()))
      if (row.value("agent", "") == agent) return row.value("malformed", 0);
  return -1;
}

TEST_F(Programs, MalformedSamplesOnEveryTopicAreSurvivedAndCounted) {
  PlainDriver driver(*net_);
  folder_.write(
      "body.yaml",
      "name: body\ndrive: differential\nlength: 0.6\nwidth: 0.5\nheight: 0.5\nmax_speed: 2\nmax_turn: 1.5\n"
      "max_acceleration: 1.5\nstep: 0.08\nlidar_height: 0.5\nsensors: {imu: {x: 0, y: 0, z: 0.2}}\n");
  Process robot = agent({}, folder_.write("r1.yaml", "name: r1\nplatform: body.yaml\n"));
  ASSERT_EQ(op("op1", {"take", "r1"}).exit_code, 0);
  const auto radio = net_->join_radio("vandal"), inner = net_->join_robot("vandal");
  int topics = 0;
  const auto counted = [&](const std::string& agent) { return malformed_of(json("op1", {"net"}), agent); };
  for (const auto& example : wire::examples()) {
    SCOPED_TRACE(example.topic.name);
    const std::string topic = example.topic.name;
    if (topic == "rt/cmd_vel") continue;  // a driver reads it, neither of the two
    const bool addressed = topic == "adit/command" || topic == "adit/joystick";
    const bool inside = topic.starts_with("rt/");
    const int before = inside ? counted("r1") : 0;
    auto& on = inside ? *inner : *radio;
    const auto writer = std::move(on.make_writer(example.topic, addressed ? "r1" : "")).value();
    ASSERT_TRUE(net_->until([&] { return writer->matched() > 0; }));
    for (const auto& bytes : damaged(example)) {
      (void)writer->write(bytes);  // some are refused by our own wire already
      net_->pass(2ms);
    }
    net_->pass(50ms);
    ++topics;
    if (inside) {
      EXPECT_TRUE(eventually([&] { return counted("r1") > before; }, Seconds(6)));
    }
  }
  EXPECT_EQ(topics, 17);
  EXPECT_TRUE(robot.running()) << robot.err();
  EXPECT_EQ(op("op1", {"goto", "r1", "1", "0"}).exit_code, 0);
  EXPECT_EQ(op("op1", {"stop", "r1"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return counted("r1") >= 7 && counted("op1") >= 8; }, Seconds(8)))
      << json("op1", {"net"}).dump();
}

}  // namespace
}  // namespace adit::live
