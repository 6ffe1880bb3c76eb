// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/record/channels.hpp"
#include "core/record/mcap_writer.hpp"
#include "core/record/output.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/sensor_messages.hpp"
#include "sim/driver/messages.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/perctool/recorded_topics.hpp"
#include "sim/rehearsal/agent_factory.hpp"
#include "sim/rehearsal/program/report_error.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace adit::sim::perctool {
namespace {

std::string place(const Mounting& m) {
  return fmt::format("x: {}, y: {}, z: {}, roll: {}, pitch: {}, yaw: {}", m.x, m.y, m.z, m.roll, m.pitch,
                     m.yaw);
}

/// The `sensors:` part of a platform's file, for who reads the recording.
std::string sensors_text(const Platform& platform) {
  const LidarConfig lidar = platform.lidar();
  const ImuConfig imu = platform.imu.value_or(ImuConfig{.mounting = {.z = 0.2}});
  return fmt::format(
      "lidar: {{{}, topic: {}, frame: {}, rings: {}, rate: {}, min_range: {}, max_range: {}, noise: {}}}\n"
      "imu: {{{}, topic: {}, frame: {}, rate: {}}}\n",
      place(lidar.mounting), lidar.topic, lidar.frame, lidar.rings, lidar.rate, lidar.min_range,
      lidar.max_range, lidar.noise, place(imu.mounting), imu.topic, imu.frame, imu.rate);
}

/// Writes what one robot's driver sends, and where the robot truly is.
class SensorRecorder {
 public:
  SensorRecorder(record::Output& output, std::string robot)
      : writer_(output, {1 << 20, true, "adit perctool"}), robot_(std::move(robot)) {}

  void about(const record::Text& entries) { state_ = writer_.add_metadata(kAboutRecording, entries); }

  void see(const wire::SampleEvent& frame) {
    if (frame.kind != wire::SampleEvent::Kind::sent || frame.from_name != Witness::driver_machine(robot_))
      return;
    if (frame.topic == wire::topics::kPoints.name)
      write(0, frame.topic, frame.type, frame.at, frame.bytes);
    else if (frame.topic == wire::topics::kOdom.name)
      see_odometry(frame);
    else if (frame.topic == wire::topics::kImu.name)
      write(2, frame.topic, frame.type, frame.at, frame.bytes);
  }

  void truth(Duration at, const Pose3& pose) {
    if (!clock_) return;
    nav_msgs::msg::Odometry message;
    message.header(message_header(Time{} + at + *clock_, "world"));
    message.child_frame_id("base_link");
    auto& to = message.pose().pose();
    to.position().x(pose.position.x());
    to.position().y(pose.position.y());
    to.position().z(pose.position.z());
    to.orientation().x(pose.orientation.x());
    to.orientation().y(pose.orientation.y());
    to.orientation().z(pose.orientation.z());
    to.orientation().w(pose.orientation.w());
    wire::encode(message, buffer_);
    write(3, kTruthTopic, wire::topics::kOdom.type, at, buffer_);
  }

  std::uint64_t messages() const { return writer_.messages(); }
  Result<void> close() {
    if (const auto closed = writer_.close(); state_) state_ = closed;
    return state_;
  }

 private:
  /// The driver's clock is ahead of the run's by what its odometry says; late samples say less.
  void see_odometry(const wire::SampleEvent& frame) {
    nav_msgs::msg::Odometry odometry;
    if (wire::decode(frame.bytes, odometry)) {
      const Duration ahead = Duration(agent::nanoseconds_of(odometry.header())) - frame.at;
      clock_ = clock_ ? std::max(*clock_, ahead) : ahead;
    }
    write(1, frame.topic, frame.type, frame.at, frame.bytes);
  }
  void write(record::ChannelId id, std::string_view topic, std::string_view type, Duration at,
             record::ByteSpan bytes) {
    if (!state_) return;
    const record::ChannelInfo info{std::string(topic), std::string(type), {{"robot", robot_}}};
    state_ = writer_.write(channels_.get(id, info), static_cast<std::uint64_t>(at.count()), bytes);
  }

  record::McapWriter writer_;
  record::Channels channels_{writer_};
  std::string robot_;
  std::optional<Duration> clock_{};
  std::vector<std::uint8_t> buffer_{};
  Result<void> state_{};
};

}  // namespace

int record(const RecordOptions& options) {
  const auto scenario = load_scenario(options.scenario);
  if (!scenario) return report_error("perctool", scenario.error());
  const RobotSpec* robot = scenario->robot(options.robot);
  if (!robot)
    return report_error("perctool",
                        Error{Reason::unknown_robot, options.scenario + ": no robot " + options.robot});
  auto world = make_world(scenario->world);
  if (!world) return report_error("perctool", world.error());
  auto factory = make_agent_factory("");
  if (!factory) return report_error("perctool", factory.error());
  auto output = record::open_file(options.out, true);
  if (!output) return report_error("perctool", output.error());
  SensorRecorder recorder(**output, options.robot);
  RunParams params;
  params.seed = options.seed.value_or(scenario->seed);
  params.make_agent = *factory;
  params.on_frame = [&recorder](const wire::SampleEvent& frame) { recorder.see(frame); };
  params.on_truth = [&recorder, &options](Duration at, const Simulation& simulation) {
    recorder.truth(at, simulation.truth(simulation.find(options.robot).value()).pose);
  };
  recorder.about({{"scenario", scenario->name},
                  {"robot", options.robot},
                  {"seed", std::to_string(params.seed)},
                  {"sensors", sensors_text(robot->settings.platform)}});
  const auto outcome = rehearse(*scenario, *world, params);
  if (!outcome) return report_error("perctool", outcome.error());
  if (const auto closed = recorder.close(); !closed) return report_error("perctool", closed.error());
  std::printf("%s: %llu messages, %.0f s\n", options.out.c_str(),
              static_cast<unsigned long long>(recorder.messages()), outcome->report.virtual_s);
  return 0;
}

}  // namespace adit::sim::perctool
