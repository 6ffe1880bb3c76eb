// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace adit::station {

/// The trails of robots, as they reported. Of each robot a bounded number of points is stored: when they are
/// full, every second one is dropped and the points get farther apart.
class Trails {
 public:
  static constexpr std::size_t kMaxPoints = 4000;
  static constexpr std::size_t kMaxRobots = 64;

  struct Trail {
    std::vector<Pose2> points{};  ///< Map frame, by time.
    double spacing{0.25};         ///< m
    Pose2 now{};                  ///< The last pose reported.
  };

  void add(const std::string& robot, const Pose2& T_map_base) {
    if (!trails_.contains(robot) && trails_.size() >= kMaxRobots) return;
    Trail& trail = trails_[robot];
    trail.now = T_map_base;
    if (!trail.points.empty() &&
        (trail.points.back().position() - T_map_base.position()).norm() < trail.spacing)
      return;
    trail.points.push_back(T_map_base);
    if (trail.points.size() < kMaxPoints) return;
    for (std::size_t i = 0; 2 * i < trail.points.size(); ++i) trail.points[i] = trail.points[2 * i];
    trail.points.resize((trail.points.size() + 1) / 2);
    trail.spacing *= 2;
  }
  const std::map<std::string, Trail>& all() const { return trails_; }

 private:
  std::map<std::string, Trail> trails_{};
};

}  // namespace adit::station
