// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>

#include "sim/rehearsal/forger.hpp"
#include "sim/rehearsal/station_machine.hpp"

namespace adit::sim {

using RobotMachines = std::map<std::string, std::unique_ptr<RobotMachine>>;
using StationMachines = std::map<std::string, std::unique_ptr<StationMachine>>;

/// Makes the faults of a rehearsal happen. Faults overlap freely: each ends only itself.
class FaultPlayer {
 public:
  /// All outlive the player; the machines run when the first fault happens.
  FaultPlayer(Stage& stage, RobotMachines& robots, StationMachines& stations)
      : stage_(stage), robots_(robots), stations_(stations) {}

  void schedule(const Fault& fault);
  /// Those that happened, by kind.
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }
  /// The first fault that could not be made to happen, if one.
  const Result<void>& health() const { return health_; }

 private:
  void happen(const Fault& fault);
  void play(const Crash& fault);
  void play(const Hang& fault);
  void play(const CutLink& fault);
  void play(const DegradeLink& fault);
  void play(const Partition& fault);
  void play(const Reorder& fault);
  void play(const Duplicate& fault);
  void play(const ClockJump& fault);
  void play(const SensorSilent& fault);
  void play(const StuckDrive& fault);
  void play(const DiskFull& fault);
  void play(const Forge& fault);
  void play(const StuckStick& fault);
  void play(const Find& find);
  void play(const Steer& steer);
  void play(const OdometryReset& fault);
  void play(const Twin& fault);
  void play(const Slip& fault);
  void play(const TurnSlip& fault);
  void play(const DriverClock& fault);
  void play(const NoStamp& fault);
  void play(const DriverRestart& fault);
  void play(const LoseColumns& fault);
  void play(const Cover& fault);
  void play(const BrokenJpeg& fault);
  void play(const Close& fault);
  void disturb(wire::Disturbance disturbance, Duration duration);
  void later(Duration duration, Task task);
  /// Calls `change(true)` now and `change(false)` after `duration`, unless that is 0.
  template <class Change>
  void during(Duration duration, Change change) {
    change(true);
    if (duration > Duration{}) later(duration, [change] { change(false); });
  }
  Traction& traction(const std::string& robot);
  RobotDriver& driver(const std::string& robot);
  void note(Result<void> result);

  Stage& stage_;
  RobotMachines& robots_;
  StationMachines& stations_;
  std::vector<std::unique_ptr<Forger>> forgers_{};
  std::map<std::string, std::uint64_t> counts_{};
  Result<void> health_{};
};

}  // namespace adit::sim
