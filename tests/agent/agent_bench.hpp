// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav/planners/falco/falco_planner.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/agent.hpp"
#include "sensor_msgs/msg/BatteryState.h"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tests/folders/folders.hpp"
#include "tests/point_cloud.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::agent {

/// An agent in a rehearsal of its own: a driver that obeys exactly, in an empty plain, and operators that
/// send raw messages.
class AgentBench {
 public:
  /// A basestation reduced to its messages.
  struct Operator {
    std::string name{};
    Id id{};
    std::unique_ptr<wire::Participant> wire{};
    wire::Writer<radio::Presence> presence{};
    wire::Writer<radio::Command> command{};
    wire::Writer<radio::Joystick> joystick{};
    std::vector<std::unique_ptr<wire::RawReader>> readers{};
    std::vector<radio::Acknowledgement> answers{};
    std::vector<radio::Notification> notices{};
    radio::AuthorityStatus authority{};
    radio::BehaviourState behaviour{};
    radio::RobotState state{};
    radio::Capabilities capabilities{};
    radio::Health health{};
    radio::LinkReport link{};
    /// Of several robots with one name: the participant whose state is stored; none: the last sender.
    std::optional<wire::ParticipantId> follows{};
    std::uint64_t seq{}, stick_seq{};
    bool up{true};
    Timer beat{};

    std::vector<std::string> notice_codes() const {
      std::vector<std::string> codes;
      for (const auto& n : notices)
        if (n.operator_name() == name || n.operator_name().empty()) codes.push_back(n.code());
      return codes;
    }
  };

  /// Puts something between the agent and its runtime.
  using Wrap = std::function<std::unique_ptr<Runtime>(std::unique_ptr<Runtime>)>;

  explicit AgentBench(AgentParams params = {}, std::uint64_t seed = 1,
                      const std::string& tree = source_folder() + "/config/trees/robot.xml",
                      const Wrap& wrap = {}, const wire::LinkProfile& link = {})
      : params_(std::move(params)), scheduler_(seed), network_(scheduler_, {.seed = seed, .link = link}) {
    network_.set_link("r1", "driver", {});
    params_.tree = tree;
    if (!params_.library) params_.library = nav::PlannerLibrary::shared;
    machine_ = scheduler_.machine("r1", 77777s);
    if (wrap) machine_ = wrap(std::move(machine_));
    world_ = scheduler_.machine("world", 3s);
    strand_ = world_->strand("bench");
    driver_wire_ = network_.join(100, "driver");
    odom_ = wire::Writer<nav_msgs::msg::Odometry>::make(*driver_wire_, wire::topics::kOdom).value();
    points_ = wire::Writer<sensor_msgs::msg::PointCloud2>::make(*driver_wire_, wire::topics::kPoints).value();
    imu_ = wire::Writer<sensor_msgs::msg::Imu>::make(*driver_wire_, wire::topics::kImu).value();
    battery_ =
        wire::Writer<sensor_msgs::msg::BatteryState>::make(*driver_wire_, wire::topics::kBattery).value();
    frames_ = wire::Writer<tf2_msgs::msg::TFMessage>::make(*driver_wire_, wire::topics::kTfStatic).value();
    cmd_vel_ = wire::make_reader(*driver_wire_, wire::topics::kCmdVel, *strand_,
                                 [this](const geometry_msgs::msg::Twist& t, const wire::SampleInfo&) {
                                   command = {t.linear().x(), t.linear().y(), t.angular().z()};
                                   commands.push_back(command);
                                   command_at = scheduler_.elapsed();
                                 })
                   .value();
    odom_timer_ = strand_->every(20ms, [this] { drive(); });
    points_timer_ = strand_->every(100ms, [this] { scan(); });
    imu_timer_ = strand_->every(10ms, [this] { inertia(); });
    battery_timer_ = strand_->every(1s, [this] { report_charge(); });
    start_agent();
  }
  ~AgentBench() { stop_agent(); }

  void start_agent() {
    radio_ = network_.join(77, "r1");
    robot_ = network_.join(100, "r1");
    ++params_.seed;
    agent_ = std::make_unique<Agent>(params_, *machine_, *radio_, *robot_);
    const auto started = agent_->start();
    if (!started) throw std::runtime_error(started.error().text);
  }
  void stop_agent() {
    agent_.reset();
    radio_.reset();
    robot_.reset();
  }

  Operator& join(const std::string& name) {
    Operator& op = *operators_.emplace_back(std::make_unique<Operator>());
    op.name = name;
    for (std::size_t i = 0; i < name.size(); ++i) op.id[i] = static_cast<std::uint8_t>(name[i]);
    connect(op);
    return op;
  }
  /// A new process of the same operator: other participant, numbers from 1.
  void restart(Operator& op) {
    op.readers.clear();
    op.presence = {};
    op.command = {};
    op.joystick = {};
    op.wire.reset();
    op.seq = op.stick_seq = 0;
    connect(op);
  }

  std::uint64_t send(Operator& op, radio::CommandKind kind, const std::string& text = {}, double x = 0,
                     double y = 0, bool flag = false) {
    radio::Command c;
    c.robot("r1");
    c.station(op.name);
    c.station_id(op.id);
    c.epoch(op.authority.epoch());
    c.seq(++op.seq);
    c.kind(kind);
    if (!text.empty()) c.words().push_back(text);
    if (kind == radio::CMD_POLICY) c.words().push_back(flag ? "auto" : "manual");
    if (kind == radio::CMD_GOTO || kind == radio::CMD_PLAN) c.numbers({x, y});
    if (kind == radio::CMD_POSE) c.numbers({x, y, 0.0});
    if (kind == radio::CMD_AREA_ADD) {  // A strip across the robot's way, from x to y.
      c.words().push_back("keep_out");
      c.numbers({x, -5.0, y, 5.0});
    }
    if (kind == radio::CMD_RESET && flag) c.options(1);
    last_command = c;
    (void)op.command.write(c);
    return op.seq;
  }
  /// Sends, lets half a second pass, and gives the answer's reason; Reason::no_answer when there was none.
  Reason ask(Operator& op, radio::CommandKind kind, const std::string& text = {}, double x = 0, double y = 0,
             bool flag = false) {
    const std::uint64_t seq = send(op, kind, text, x, y, flag);
    run(300ms);
    for (const auto& a : op.answers)
      if (a.seq() == seq && a.station_id() == op.id) return static_cast<Reason>(a.reason());
    return Reason::no_answer;
  }
  void stick(Operator& op, double vx, double wz = 0) {
    radio::Joystick j;
    j.robot("r1");
    j.station_id(op.id);
    j.epoch(op.authority.epoch());
    j.seq(++op.stick_seq);
    j.echo(op.state.stamp());
    j.vx(static_cast<float>(vx));
    j.wz(static_cast<float>(wz));
    (void)op.joystick.write(j);
  }
  /// Streams the stick at 20 Hz for so long.
  void stream(Operator& op, double vx, Duration time) {
    for (Duration t{}; t < time; t += 50ms) {
      stick(op, vx);
      run(50ms);
    }
  }
  void run(Duration time) { scheduler_.run_until(scheduler_.elapsed() + time); }
  void at(Duration after, Task task) { scheduler_.at(scheduler_.elapsed() + after, std::move(task)); }
  Duration elapsed() const { return scheduler_.elapsed(); }

  Twist2 command{};
  std::vector<Twist2> commands{};
  Duration command_at{};
  Pose2 pose{};  ///< Pose by the driver, odometry frame.
  bool driver_alive{true}, lidar_alive{true};
  std::string lidar_frame{"base_link"};
  PointCloud obstacles{};  ///< Odometry frame; added to the plain.
  /// Changes each cloud before it is sent; none: it is sent as it is.
  std::function<void(sensor_msgs::msg::PointCloud2&)> spoil{};
  std::function<void(nav_msgs::msg::Odometry&)> spoil_odometry{};  ///< The same for the odometry.
  /// Specific force that the IMU measures, 100 Hz; none: there is no IMU.
  std::optional<Eigen::Vector3d> force{};
  std::function<void(sensor_msgs::msg::Imu&)> spoil_imu{};
  std::optional<float> charge{};  ///< What the driver sends as percentage, 1 Hz; none: nothing.
  void send_frame(const std::string& child, double z) {
    tf2_msgs::msg::TFMessage message;
    message.transforms().resize(1);
    auto& each = message.transforms()[0];
    each.header().frame_id("base_link");
    each.child_frame_id(child);
    each.transform().translation().z(z);
    each.transform().rotation().w(1.0);
    (void)frames_.write(message);
  }
  radio::Command last_command{};
  wire::SimulatedNetwork& network() { return network_; }
  const wire::Participant& radio() const { return *radio_; }
  Agent& agent() { return *agent_; }
  AgentParams& params() { return params_; }  ///< Of the next start of the agent.
  /// Of the driver and the operators, outside of the agent.
  Executor& strand() { return *strand_; }
  std::unique_ptr<Runtime> machine(const std::string& name) { return scheduler_.machine(name, 9s); }

 private:
  void connect(Operator& op) {
    op.wire = network_.join(77, op.name);
    op.presence = wire::Writer<radio::Presence>::make(*op.wire, wire::topics::kPresence).value();
    op.command = wire::Writer<radio::Command>::make(*op.wire, wire::topics::kCommand, "r1").value();
    op.joystick = wire::Writer<radio::Joystick>::make(*op.wire, wire::topics::kJoystick, "r1").value();
    Operator* o = &op;
    keep(op, wire::topics::kAcknowledgement,
         [o](const radio::Acknowledgement& a) { o->answers.push_back(a); });
    keep(op, wire::topics::kNotification, [o](const radio::Notification& n) { o->notices.push_back(n); });
    follow(op, wire::topics::kAuthority, [o](const radio::AuthorityStatus& a) { o->authority = a; });
    follow(op, wire::topics::kBehaviour, [o](const radio::BehaviourState& b) { o->behaviour = b; });
    follow(op, wire::topics::kRobotState, [o](const radio::RobotState& s) { o->state = s; });
    keep(op, wire::topics::kCapabilities, [o](const radio::Capabilities& c) { o->capabilities = c; });
    keep(op, wire::topics::kHealth, [o](const radio::Health& h) { o->health = h; });
    keep(op, wire::topics::kLinkReport, [o](const radio::LinkReport& l) { o->link = l; });
    const auto announce = [o] {
      if (!o->up) return;
      radio::Presence p;
      p.kind(radio::AGENT_STATION);
      p.name(o->name);
      p.id(o->id);
      p.protocol(1);
      (void)o->presence.write(p);
    };
    announce();
    op.beat = strand_->every(500ms, announce);
  }
  template <class T, class F>
  void keep(Operator& op, const wire::Topic<T>& topic, F store) {
    op.readers.push_back(
        wire::make_reader(*op.wire, topic, *strand_, [store](const T& s, const wire::SampleInfo&) {
          store(s);
        }).value());
  }
  template <class T, class F>
  void follow(Operator& op, const wire::Topic<T>& topic, F store) {
    op.readers.push_back(wire::make_reader(*op.wire, topic, *strand_,
                                           [o = &op, store](const T& s, const wire::SampleInfo& info) {
                                             if (!o->follows || *o->follows == info.sender) store(s);
                                           })
                             .value());
  }
  void drive() {
    pose = pose * Pose2{command.vx * 0.02, command.vy * 0.02, command.wz * 0.02};
    if (!driver_alive) return;
    nav_msgs::msg::Odometry o;
    stamp(o.header());
    o.pose().pose().position().x(pose.x);
    o.pose().pose().position().y(pose.y);
    o.pose().pose().orientation().z(std::sin(pose.yaw / 2));
    o.pose().pose().orientation().w(std::cos(pose.yaw / 2));
    o.twist().twist().linear().x(command.vx);
    o.twist().twist().angular().z(command.wz);
    if (spoil_odometry) spoil_odometry(o);
    (void)odom_.write(o);
  }
  void scan() {
    if (!lidar_alive) return;
    PointCloud cloud;
    for (int i = 0; i < 360; ++i)
      for (const float r : {1.0f, 2.0f, 4.0f}) {
        const float a = static_cast<float>(i) * 0.0174533f;
        cloud.push_back({r * std::cos(a), r * std::sin(a), 0.0f});
      }
    const Pose2 back = pose.inverse();
    for (const Eigen::Vector3f& o : obstacles) {
      const Eigen::Vector2d p = back * Eigen::Vector2d(o.x(), o.y());
      cloud.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), o.z()});
    }
    sensor_msgs::msg::PointCloud2 c = cloud_of({cloud.data()->data(), 3 * cloud.size()});
    stamp(c.header());
    c.header().frame_id(lidar_frame);
    if (spoil) spoil(c);
    (void)points_.write(c);
  }
  void inertia() {
    if (!force) return;
    sensor_msgs::msg::Imu sample;
    stamp(sample.header());
    sample.header().frame_id("imu");
    sample.linear_acceleration().x(force->x());
    sample.linear_acceleration().y(force->y());
    sample.linear_acceleration().z(force->z());
    if (spoil_imu) spoil_imu(sample);
    (void)imu_.write(sample);
  }
  void report_charge() {
    if (!charge) return;
    sensor_msgs::msg::BatteryState battery;
    battery.percentage(*charge);
    (void)battery_.write(battery);
  }
  void stamp(std_msgs::msg::Header& h) {
    const auto ns = strand_->now().time_since_epoch().count();
    h.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    h.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }

  AgentParams params_;
  VirtualScheduler scheduler_;
  wire::SimulatedNetwork network_;
  std::unique_ptr<Runtime> machine_, world_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> driver_wire_, radio_, robot_;
  wire::Writer<nav_msgs::msg::Odometry> odom_{};
  wire::Writer<sensor_msgs::msg::PointCloud2> points_{};
  wire::Writer<sensor_msgs::msg::Imu> imu_{};
  wire::Writer<tf2_msgs::msg::TFMessage> frames_{};
  std::unique_ptr<wire::RawReader> cmd_vel_{};
  wire::Writer<sensor_msgs::msg::BatteryState> battery_{};
  Timer odom_timer_{}, points_timer_{}, imu_timer_{}, battery_timer_{};
  std::vector<std::unique_ptr<Operator>> operators_{};
  std::unique_ptr<Agent> agent_{};
};

}  // namespace adit::agent
