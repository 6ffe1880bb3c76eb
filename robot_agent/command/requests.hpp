#pragma once
#include <Eigen/Core>
#include <string>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// What the command interface lets through to the robot: the way in. Everything takes effect before the
/// call returns, so that the output is zero before a stop is acknowledged.
class Requests {
 public:
  virtual ~Requests() = default;
  /// Refused with the first condition of the mode table that does not hold.
  virtual Result<void> request_mode(const std::string& mode, Time now) = 0;
  /// `goal`: map frame, m.
  virtual Result<void> request_goal(const Eigen::Vector3d& goal, Time now) = 0;
  /// `pose`: map frame. The robot is there; moves nothing. Errors: wrong_mode outside hold, out_of_range,
  /// no_localisation.
  virtual Result<void> set_pose(const Pose2& pose, Time now) = 0;
  virtual void stop_changed(bool stopped, Time now) = 0;
  /// Also when the holder let go.
  virtual void holder_changed(Time now) = 0;
  /// The holder's station was started again: what its stick said is forgotten.
  virtual void holder_restarted(Time now) = 0;
  /// A fresh sample of the holder's stick. Refused with wrong_mode when it is pushed and the mode does not
  /// take it.
  virtual Result<void> stick(const Twist2& twist, Time now) = 0;
};

}  // namespace adit::agent
