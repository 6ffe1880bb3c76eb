// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/time/time.hpp"
#include "nav/areas/area.hpp"
#include "robot_agent/common/exploration.hpp"

namespace adit::agent {

struct ConvoyOrder;

/// The interface through which accepted commands act on the robot. Every call takes effect before it returns,
/// so that the output is zero before a stop is acknowledged.
class Requests {
 public:
  virtual ~Requests() = default;
  /// Requests a mode. Errors: the first condition of the mode table that does not hold.
  virtual Result<void> request_mode(const std::string& mode, Time now) = 0;
  /// Requests a goal, map frame, m.
  virtual Result<void> request_goal(const Eigen::Vector3d& goal, Time now) = 0;
  /// Limits the metres that the robot may drive while the ground at the goal, which was just accepted, is not
  /// seen; infinite: no limit; NaN: the larger of 20 m and 1.5 times the straight line.
  virtual void limit_unknown(double metres) = 0;
  /// Requests an exploration. Errors: as for a mode.
  virtual Result<void> request_explore(const ExploreRequest& request, Time now) = 0;
  /// Sets the robot's pose, map frame; moves nothing. Errors: wrong_mode outside hold, out_of_range,
  /// no_localisation.
  virtual Result<void> set_pose(const Pose2& pose, Time now) = 0;
  /// Adds an area of the map, or replaces the one of its name. Errors: those of nav::checked() and
  /// nav::AreaSet::add(), and outside_area if a part of the body would be on forbidden ground.
  virtual Result<void> add_area(const nav::Area& area, Time now) = 0;
  /// Removes an area. Errors: bad_argument if there is none of that name.
  virtual Result<void> remove_area(const std::string& name, Time now) = 0;
  /// Takes a place in a convoy; a follower enters convoy_follow, the leader stays in its mode. Errors: those
  /// of Convoy::start(), and the first condition that does not hold.
  virtual Result<void> join_convoy(const ConvoyOrder& order, Time now) = 0;
  /// Leaves the convoy; a follower falls to hold. Errors: not_in_convoy.
  virtual Result<void> leave_convoy(Time now) = 0;
  /// Allows the robot to make way for others, or no longer; it then stays where it is. Errors:
  /// mode_not_installed, where the robot has no router.
  virtual Result<void> allow_yield(bool allowed, Time now) = 0;
  virtual void stop_changed(bool stopped, Time now) = 0;
  /// Called when the holder changed, also when it released the robot.
  virtual void holder_changed(Time now) = 0;
  /// Called when the holder's station was restarted: its stick samples are discarded.
  virtual void holder_restarted(Time now) = 0;
  /// Passes on a fresh sample of the holder's stick. Errors: wrong_mode if the stick is pushed and the mode
  /// does not accept it.
  virtual Result<void> stick(const Twist2& twist, Time now) = 0;
};

}  // namespace adit::agent
