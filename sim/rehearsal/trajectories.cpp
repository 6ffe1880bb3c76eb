// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/trajectories.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace adit::sim {
namespace {

Error unwritable(const std::string& file) {
  return {Reason::cannot_write, file + ": cannot be written; check the folder and the space left"};
}

void write_pose(std::ofstream& file, Duration at, const Pose3& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  file << fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", seconds(at), p.x(), p.y(),
                      p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

struct Trajectories::Robot {
  TrajectoryFiles names{};
  std::ofstream truth{}, odometry{}, map{};
  Duration map_written{-1};
};

Trajectories::Trajectories() = default;
Trajectories::~Trajectories() = default;

Result<std::unique_ptr<Trajectories>> Trajectories::open(const std::string& folder,
                                                         const std::vector<std::string>& robots) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return unwritable(folder);
  std::unique_ptr<Trajectories> out(new Trajectories);
  for (const std::string& id : robots) {
    Robot& robot = out->robots_[id];
    const auto name = [&](const char* kind) {
      return (std::filesystem::path(folder) / (id + "_" + kind + ".tum")).string();
    };
    robot.names = {name("truth"), name("odometry"), name("map")};
    robot.truth.open(robot.names.truth);
    robot.odometry.open(robot.names.odometry);
    robot.map.open(robot.names.map);
    if (!robot.truth || !robot.odometry || !robot.map) return unwritable(robot.names.truth);
  }
  return out;
}

void Trajectories::add(const Simulation& simulation, const Witness& witness, Duration now) {
  for (std::size_t n = 0; n < simulation.size(); ++n) {
    Robot& robot = robots_.at(simulation.id(n));
    write_pose(robot.truth, now, simulation.truth(n).pose);
    const Odometry& odometry = simulation.odometry(n);
    const Pose2& pose = odometry.pose();
    write_pose(robot.odometry, now, {{pose.x, pose.y, simulation.altitude(n)}, odometry.orientation()});
    const RobotWord& word = witness.word(simulation.id(n));
    if (!word.pose || word.pose_sent == robot.map_written) continue;
    robot.map_written = word.pose_sent;
    write_pose(robot.map, word.pose_sent, *word.pose);
  }
}

Result<std::map<std::string, TrajectoryFiles>> Trajectories::close() {
  std::map<std::string, TrajectoryFiles> out;
  for (auto& [id, robot] : robots_) {
    for (std::ofstream* file : {&robot.truth, &robot.odometry, &robot.map}) {
      file->close();
      if (!*file) return unwritable(robot.names.truth);
    }
    out[id] = robot.names;
  }
  return out;
}

}  // namespace adit::sim
