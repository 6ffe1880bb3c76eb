// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "basestation/station/station.hpp"
#include "core/time/random.hpp"
#include "sim/rehearsal/robot_machine.hpp"
#include "sim/truth/map_truth.hpp"

namespace adit::sim {

/// One operator's computer with his station. The station can crash; it comes back with the same identity, and
/// with what was on its disk.
class StationMachine {
 public:
  StationMachine(Stage& stage, const StationSpec& spec, Random random);
  ~StationMachine();
  Result<void> start();
  /// Types a command line; nothing happens while the station is dead.
  void type(const std::string& line);
  /// The station's process dies in this instant and is started again after 0.5 s.
  void crash();
  /// The computer's clock goes on by so much at once.
  void jump_clock(Duration by);
  /// His joystick hangs, pushed, on that robot for so long.
  Result<void> stick_hangs(const std::string& robot, Duration duration);
  const Result<void>& health() const { return health_; }
  /// Of the newest answer this operator got, from a robot or from his station.
  std::optional<Reason> last_answer() const;
  const station::Id& id() const { return id_; }
  /// His station; null while it is dead.
  const station::Station* station() const;
  /// What his station has of all robots; nothing while it is dead.
  std::optional<std::size_t> findings() const;
  /// The map that his station has; null while it is dead.
  const station::ChunkStore* chunks() const;
  /// The map that his station holds of all robots, map frame, merged once for each revision of it; null while
  /// it is dead or knows none.
  std::shared_ptr<const MapVoxels> map() const;

 private:
  struct Process;
  Result<void> start_process();

  Stage& stage_;
  const StationSpec& spec_;
  Eigen::Vector3d place_{Eigen::Vector3d::Zero()};  ///< World frame, m
  Random random_;
  Duration clock_offset_;
  station::Id id_{};
  std::shared_ptr<store::MemoryDisk> disk_;
  std::optional<Reason> answer_before_crash_{};
  std::unique_ptr<Process> process_{};
  Result<void> health_{};
  mutable std::shared_ptr<const MapVoxels> merged_{};
  mutable std::uint64_t merged_revision_{};
};

}  // namespace adit::sim
