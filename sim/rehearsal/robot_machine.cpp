// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/robot_machine.hpp"

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "robot_agent/motion/velocity_writer.hpp"
#include "sim/rehearsal/drawn_jpeg.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit::sim {

Result<void> RehearsedAgent::inject(const std::string& component, ComponentFault) {
  return {Reason::not_supported, "this agent takes no faults in its component " + component};
}

Result<void> RehearsedAgent::find(findings::Finding) {
  return {Reason::not_supported, "this agent keeps no findings"};
}

namespace {

constexpr Duration kParentNotices{20ms};
constexpr Duration kZeroPeriod{50ms};
constexpr Duration kRestartAfter{500ms};
constexpr Duration kReporterStarts{1s};
constexpr std::uint32_t kFirstRobotDomain = 101;
constexpr std::uint32_t kFirstTwinDomain = 10001;

}  // namespace

/// What stays when the agent dies: sends zero until a new one runs.
struct RobotMachine::Parent {
  std::unique_ptr<Runtime> runtime{};
  std::shared_ptr<Executor> strand{};
  std::unique_ptr<wire::Participant> wire{};
  agent::VelocityWriter cmd_vel{};
  Timer zero{};

  void send_zero() { cmd_vel.write({}); }
};

struct RobotMachine::Agent {
  std::unique_ptr<Runtime> runtime{};
  std::unique_ptr<wire::Participant> radio{}, robot{};
  std::unique_ptr<RehearsedAgent> program{};
};

/// A program on the robot that steers by itself, or reports.
struct RobotMachine::Program {
  std::unique_ptr<Runtime> runtime{};
  std::shared_ptr<Executor> strand{};
  std::unique_ptr<wire::Participant> wire{};
  wire::Writer<geometry_msgs::msg::Twist> velocity{};
  wire::Writer<visualization_msgs::msg::Marker> reports{};
  Timer timer{};
  std::vector<Timer> later{};
};

RobotMachine::RobotMachine(Stage& stage, std::size_t index, const RobotSpec& spec, Random random)
    : stage_(stage),
      index_(index),
      spec_(spec),
      random_(random),
      clock_offset_(from_seconds(random_.uniform(10.0, 100000.0))),
      domain_(kFirstRobotDomain + static_cast<std::uint32_t>(index)),
      disk_(std::make_shared<store::MemoryDisk>(random_.next())) {}

RobotMachine::~RobotMachine() = default;

Result<void> RobotMachine::start() {
  const std::string driver = Witness::driver_machine(spec_.id);
  driver_runtime_ = stage_.scheduler.machine(driver, clock_offset_);
  driver_strand_ = driver_runtime_->strand("driver");
  driver_wire_ = stage_.network.join(domain_, driver);
  DriverParams params = make_driver_params(spec_);
  // Scans of different robots do not all fall into the same instant.
  params.first_scan = 100ms + 5ms * static_cast<int>(index_);
  driver_ = std::make_unique<RobotDriver>(stage_.simulation, index_, *driver_strand_, *driver_wire_, params);
  if (auto started = driver_->start(); !started) return started;

  parent_ = std::make_unique<Parent>();
  const std::string name = Witness::parent_machine(spec_.id);
  parent_->runtime = stage_.scheduler.machine(name, clock_offset_);
  parent_->strand = parent_->runtime->strand("parent");
  parent_->wire = stage_.network.join(domain_, name);
  if (stage_.parent_wire) parent_->wire = stage_.parent_wire(std::move(parent_->wire));
  auto writer = agent::VelocityWriter::make(*parent_->wire, spec_.settings.velocity);
  if (!writer) return writer.error();
  parent_->cmd_vel = std::move(*writer);
  return start_agent();
}

Result<void> RobotMachine::start_agent() {
  auto agent = std::make_unique<Agent>();
  agent->runtime = stage_.scheduler.machine(spec_.id, clock_offset_);
  agent->radio = stage_.network.join(Witness::kRadioDomain, spec_.id);
  agent->robot = stage_.network.join(domain_, spec_.id);
  stage_.witness.agent_started(spec_.id, stage_.scheduler.elapsed(), agent->radio->id());
  auto program = stage_.make_agent({spec_, stage_.simulation.platform(index_), random_.next(),
                                    *agent->runtime, *agent->radio, *agent->robot, disk_,
                                    [this](const std::string&) {
                                      // Not on the agent's own strand: that goes with it.
                                      stage_.scheduler.at(stage_.scheduler.elapsed(), [this] { crash(); });
                                    },
                                    stage_.simulation.start_ground(index_)});
  if (!program) return program.error();
  agent->program = std::move(*program);
  agent_ = std::move(agent);
  return {};
}

void RobotMachine::crash() {
  if (!agent_) return;
  // Silent first: whatever the object's end would still say is not heard, as with a killed process.
  stage_.network.crash(spec_.id);
  agent_->program.reset();
  agent_.reset();
  const Duration now = stage_.scheduler.elapsed();
  stage_.witness.agent_died(spec_.id, now);
  stage_.scheduler.at(now + kParentNotices, [this] {
    parent_->strand->post([this] {
      parent_->send_zero();
      parent_->zero = parent_->strand->every(kZeroPeriod, [this] { parent_->send_zero(); });
    });
  });
  stage_.scheduler.at(now + kRestartAfter, [this] {
    parent_->zero.cancel();
    health_ = start_agent();
  });
}

Result<void> RobotMachine::inject(const std::string& component, ComponentFault fault) {
  if (!agent_) return {};
  stage_.witness.component_faulted(spec_.id, stage_.scheduler.elapsed(), component);
  return agent_->program->inject(component, fault);
}

Result<void> RobotMachine::find(findings::Finding finding) {
  if (!agent_) return {};
  return agent_->program->find(std::move(finding));
}

std::unique_ptr<RobotMachine::Program> RobotMachine::start_program(const std::string& name) {
  auto program = std::make_unique<Program>();
  const std::string machine = spec_.id + "/" + name;
  program->runtime = stage_.scheduler.machine(machine, clock_offset_);
  program->strand = program->runtime->strand(name);
  program->wire = stage_.network.join(domain_, machine);
  return program;
}

Result<void> RobotMachine::report(const std::string& kind, int kilobytes) {
  if (!reporter_) {
    auto program = start_program("reporter");
    auto writer = wire::Writer<visualization_msgs::msg::Marker>::make(*program->wire, wire::topics::kReports);
    if (!writer) return writer.error();
    program->reports = std::move(*writer);
    reporter_ = std::move(program);
  }
  visualization_msgs::msg::Marker marker;
  marker.ns(kind);
  marker.id(++reports_);
  marker.header().frame_id("base_link");
  marker.texture().format("jpeg");
  marker.texture().data() = drawn_jpeg(static_cast<std::size_t>(kilobytes) * 1024,
                                       random_.fork(static_cast<std::uint64_t>(reports_)).next());
  // It takes the photo once the agent's reader is known.
  reporter_->later.push_back(
      reporter_->strand->after(kReporterStarts, [p = reporter_.get(), marker]() mutable {
        const std::uint64_t now = to_stamp(p->strand->now());
        marker.header().stamp().sec(static_cast<std::int32_t>(now / 1'000'000'000));
        marker.header().stamp().nanosec(static_cast<std::uint32_t>(now % 1'000'000'000));
        (void)p->reports.write(marker);  // A failed write is counted by the wire.
      }));
  return {};
}

Result<void> RobotMachine::steer(const Twist2& velocity, Duration duration) {
  auto program = start_program("program");
  auto writer = wire::Writer<geometry_msgs::msg::Twist>::make(*program->wire, wire::topics::kExternalCmdVel);
  if (!writer) return writer.error();
  program->velocity = std::move(*writer);
  geometry_msgs::msg::Twist twist;
  twist.linear().x(velocity.vx);
  twist.linear().y(velocity.vy);
  twist.angular().z(velocity.wz);
  // A failed write is counted by the wire; the next follows.
  program->timer =
      program->strand->every(50ms, [p = program.get(), twist] { (void)p->velocity.write(twist); });
  program_ = std::move(program);
  stage_.scheduler.at(stage_.scheduler.elapsed() + duration, [this, p = program_.get()] {
    if (program_.get() == p) program_.reset();
  });
  return {};
}

Result<void> RobotMachine::add_twin(Duration duration) {
  const std::string machine = Witness::twin_machine(spec_.id);
  const std::uint32_t domain = kFirstTwinDomain + static_cast<std::uint32_t>(index_);
  auto twin = std::make_unique<Agent>();
  twin->runtime = stage_.scheduler.machine(machine, clock_offset_ + 1h);
  twin->radio = stage_.network.join(Witness::kRadioDomain, machine);
  twin->robot = stage_.network.join(domain, machine);
  auto program = stage_.make_agent({spec_,
                                    stage_.simulation.platform(index_),
                                    random_.next(),
                                    *twin->runtime,
                                    *twin->radio,
                                    *twin->robot,
                                    std::make_shared<store::MemoryDisk>(random_.next()),
                                    {}});
  if (!program) return program.error();
  twin->program = std::move(*program);
  twin_ = std::move(twin);
  stage_.scheduler.at(stage_.scheduler.elapsed() + duration, [this, t = twin_.get()] {
    if (twin_.get() == t) twin_.reset();
  });
  return {};
}

void RobotMachine::jump_clock(Duration by) {
  clock_offset_ += by;
  stage_.scheduler.jump_clock(*driver_runtime_, by);
  stage_.scheduler.jump_clock(*parent_->runtime, by);
  stage_.witness.clock_jumped(spec_.id, stage_.scheduler.elapsed(), by);
  if (agent_) stage_.scheduler.jump_clock(*agent_->runtime, by);
}

void RobotMachine::fill_disk(bool full) {
  disk_full_ += full ? 1 : -1;
  disk_->set_full(disk_full_ > 0);
  stage_.witness.disk_changed(spec_.id, stage_.scheduler.elapsed(), disk_full_ > 0);
}

}  // namespace adit::sim
