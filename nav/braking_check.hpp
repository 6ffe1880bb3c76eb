#pragma once
#include <array>
#include <span>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav {

struct BrakingCheckParams {
  double margin{0.01};    ///< around the footprint, m, [0, 0.2]
  double reaction{0.15};  ///< the command goes on this long before braking begins, s, [0, 1]
};

/// The last look before a velocity leaves: would the robot, going on like this for its reaction time and then
/// braking, touch an obstacle? The same limits as the platform's; knows nothing of paths.
class BrakingCheck {
 public:
  explicit BrakingCheck(const Platform& platform, const BrakingCheckParams& params = {});

  /// Takes the obstacles (odometry frame, m) that can matter to a robot at `pose`.
  void look(std::span<const Eigen::Vector2f> obstacles, const Pose2& pose);
  /// Whether `velocity` (body frame) can be braked to zero before the footprint touches what was looked at.
  /// What is inside the margin already may not come deeper.
  bool safe(const Twist2& velocity) const;

 private:
  static constexpr std::size_t kMax = 1024;
  Platform platform_;
  BrakingCheckParams params_;
  std::array<Eigen::Vector2f, kMax> near_{};  ///< body frame
  std::size_t count_{0};
};

}  // namespace adit::nav
