// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "sim/rehearsal/report.hpp"
#include "sim/rehearsal/witness.hpp"
#include "sim/world/simulation.hpp"

namespace adit::sim {

/// Writes the trajectories of a run as TUM files, three for each robot: ROBOT_truth.tum, ROBOT_odometry.tum
/// and ROBOT_map.tum.
class Trajectories {
 public:
  /// Makes the folder and the files. Reason::cannot_write names what cannot be written.
  static Result<std::unique_ptr<Trajectories>> open(const std::string& folder,
                                                    const std::vector<std::string>& robots);
  ~Trajectories();

  /// Writes the poses now. A robot's own estimate is written once per message, at the time it was sent.
  void add(const Simulation& simulation, const Witness& witness, Duration now);
  /// Closes the files and names them by robot. Reason::cannot_write: one is not complete.
  Result<std::map<std::string, TrajectoryFiles>> close();

 private:
  struct Robot;
  Trajectories();
  std::map<std::string, Robot> robots_;
};

}  // namespace adit::sim
