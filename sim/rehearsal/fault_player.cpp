// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/fault_player.hpp"

namespace adit::sim {

void FaultPlayer::schedule(const Fault& fault) {
  stage_.scheduler.at(fault.at, [this, fault] { happen(fault); });
}

void FaultPlayer::happen(const Fault& fault) {
  if (!std::holds_alternative<Find>(fault.what) && !std::holds_alternative<Steer>(fault.what))
    ++counts_[kind_of(fault)];
  stage_.witness.fault(stage_.scheduler.elapsed(), to_yaml(fault));
  std::visit([this](const auto& what) { play(what); }, fault.what);
}

void FaultPlayer::later(Duration duration, Task task) {
  stage_.scheduler.at(stage_.scheduler.elapsed() + duration, std::move(task));
}

Traction& FaultPlayer::traction(const std::string& robot) {
  return stage_.simulation.traction(stage_.simulation.find(robot).value());
}

RobotDriver& FaultPlayer::driver(const std::string& robot) { return robots_.at(robot)->driver(); }

void FaultPlayer::note(Result<void> result) {
  if (health_ && !result) health_ = std::move(result);
}

void FaultPlayer::disturb(wire::Disturbance disturbance, Duration duration) {
  const wire::DisturbanceId id = stage_.network.disturb(std::move(disturbance));
  later(duration, [this, id] { stage_.network.end_disturbance(id); });
}

void FaultPlayer::play(const Crash& fault) {
  if (!fault.component.empty())
    note(robots_.at(fault.victim)->inject(fault.component, ComponentFault::crash));
  else if (const auto robot = robots_.find(fault.victim); robot != robots_.end())
    robot->second->crash();
  else
    stations_.at(fault.victim)->crash();
}

void FaultPlayer::play(const Hang& fault) {
  note(robots_.at(fault.robot)->inject(fault.component, ComponentFault::hang));
}

void FaultPlayer::play(const CutLink& fault) {
  wire::Disturbance cut{.from = {fault.a}, .to = {fault.b}};
  cut.both_ways = !fault.one_way;
  cut.cut = true;
  disturb(std::move(cut), fault.duration);
}

void FaultPlayer::play(const DegradeLink& fault) {
  wire::Disturbance worse{.from = {fault.a}, .to = {fault.b}};
  worse.loss = fault.loss;
  worse.delay = from_seconds(fault.delay);
  disturb(std::move(worse), fault.duration);
}

void FaultPlayer::play(const Partition& fault) {
  wire::Disturbance apart;
  apart.groups = fault.groups;
  apart.cut = true;
  disturb(std::move(apart), fault.duration);
}

void FaultPlayer::play(const Reorder& fault) {
  wire::Disturbance mixed{.from = {fault.a}, .to = {fault.b}};
  mixed.reorder = fault.chance;
  mixed.reorder_by = from_seconds(fault.by);
  disturb(std::move(mixed), fault.duration);
}

void FaultPlayer::play(const Duplicate& fault) {
  wire::Disturbance twice{.from = {fault.a}, .to = {fault.b}};
  twice.duplicate = fault.chance;
  disturb(std::move(twice), fault.duration);
}

void FaultPlayer::play(const ClockJump& fault) {
  for (const auto& [who, by] : fault.by) {
    if (const auto robot = robots_.find(who); robot != robots_.end())
      robot->second->jump_clock(by);
    else
      stations_.at(who)->jump_clock(by);
  }
}

void FaultPlayer::play(const SensorSilent& fault) {
  during(fault.duration,
         [to = &driver(fault.robot), sensor = fault.sensor](bool begins) { to->silence(sensor, begins); });
}

void FaultPlayer::play(const StuckDrive& fault) {
  during(fault.duration, [to = &traction(fault.robot)](bool begins) { to->jam(begins); });
}

void FaultPlayer::play(const Slip& fault) {
  const Twist2 wheels{fault.vx, 0.0, fault.wz};
  during(fault.duration, [to = &traction(fault.robot), wheels](bool begins) { to->slip(wheels, begins); });
}

void FaultPlayer::play(const TurnSlip& fault) {
  during(fault.duration,
         [to = &traction(fault.robot), share = fault.share](bool begins) { to->turn_slip(share, begins); });
}

void FaultPlayer::play(const DriverClock& fault) {
  during(fault.duration, [to = &driver(fault.robot), fault](bool begins) {
    to->jump_clock(fault.sensor, begins ? fault.jump : -fault.jump);
  });
}

void FaultPlayer::play(const NoStamp& fault) {
  during(fault.duration, [to = &driver(fault.robot), sensor = fault.sensor](bool begins) {
    to->drop_stamps(sensor, begins);
  });
}

void FaultPlayer::play(const DriverRestart& fault) {
  stage_.simulation.reset_odometry(stage_.simulation.find(fault.robot).value(), fault.origin);
}

void FaultPlayer::play(const LoseColumns& fault) {
  during(fault.duration,
         [to = &driver(fault.robot), loss = fault.loss](bool begins) { to->lose_columns(loss, begins); });
}

void FaultPlayer::play(const Cover& fault) {
  during(fault.duration, [to = &driver(fault.robot)](bool begins) { to->cover(begins); });
}

void FaultPlayer::play(const BrokenJpeg& fault) {
  during(fault.duration, [to = &driver(fault.robot)](bool begins) { to->break_jpegs(begins); });
}

void FaultPlayer::play(const Close& fault) {
  const std::size_t number = stage_.simulation.close(fault.box);
  later(fault.duration, [this, number] { stage_.simulation.open(number); });
}

void FaultPlayer::play(const DiskFull& fault) {
  RobotMachine* robot = robots_.at(fault.robot).get();
  during(fault.duration, [robot](bool begins) { robot->fill_disk(begins); });
}

void FaultPlayer::play(const Forge& fault) {
  forgers_.push_back(std::make_unique<Forger>(stage_, fault, stations_.at(fault.as)->id()));
  note(forgers_.back()->start());
}

void FaultPlayer::play(const StuckStick& fault) {
  note(stations_.at(fault.by)->stick_hangs(fault.robot, fault.duration));
}

void FaultPlayer::play(const Steer& steer) {
  note(robots_.at(steer.robot)->steer(steer.velocity, steer.duration));
}

void FaultPlayer::play(const OdometryReset& fault) {
  stage_.simulation.reset_odometry(stage_.simulation.find(fault.robot).value());
}

void FaultPlayer::play(const Twin& fault) { note(robots_.at(fault.robot)->add_twin(fault.duration)); }

void FaultPlayer::play(const Find& find) {
  if (find.photo > 0) return note(robots_.at(find.robot)->report(find.kind, find.photo));
  const Eigen::Vector3d place =
      stage_.simulation.truth(stage_.simulation.find(find.robot).value()).pose.position;
  findings::Finding finding{};
  finding.kind = find.kind;
  finding.importance = static_cast<std::uint8_t>(find.importance);
  finding.position = {place.x(), place.y(), place.z()};
  note(robots_.at(find.robot)->find(std::move(finding)));
}

}  // namespace adit::sim
