// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::sim {

inline constexpr double kGravity = 9.81;         // m/s2
inline constexpr double kDegree = M_PI / 180.0;  // rad

/// Height and tilt of a body.
struct Attitude {
  double z{};      ///< Height of base_link, world, m.
  double roll{};   ///< About the body's x axis, rad; positive: the left side is up.
  double pitch{};  ///< About the body's y axis, rad; positive: the nose is down (REP-103).

  /// Rotation from the body to the world at a heading (rad): yaw, then pitch, then roll.
  Eigen::Quaterniond orientation(double yaw) const;
};

/// Attitude of a rigid body on its four contact points: the plane that fits them best. They are the ends of
/// its axles or tracks, or its feet, at `kContactLength` and `kContactWidth` of the footprint. Nothing where
/// the world has no ground.
std::optional<Attitude> ground_attitude(const StandingMap& ground, const Platform& platform,
                                        const Pose2& pose);
inline constexpr double kContactLength = 0.8;  // Share of the footprint's length between the axles.
inline constexpr double kContactWidth = 0.9;   // Share of its width between the wheels of an axle.

/// A body on its suspension: it follows the ground and leans under acceleration as a damped oscillator.
///
/// The lean follows from the body itself: an acceleration `a` at the height `h` of the centre of mass turns a
/// box with radius of gyration `r` on springs of angular frequency `w` by a h / (w r)^2, 2 to 3 degrees when
/// a standard platform brakes. A legged body also bobs and sways with its gait while it walks. A flying body
/// leans into its acceleration, as far as its thrust must.
class Chassis {
 public:
  explicit Chassis(const Platform& platform);

  /// Puts the body at rest.
  void start(const Attitude& ground);
  /// Moves the body by `dt` seconds. `ground`: attitude of the contact points, for a flying body only its
  /// height; `acceleration`: of base_link along the body's x and y, m/s2; `speed`: m/s.
  void advance(const Attitude& ground, const Eigen::Vector2d& acceleration, double speed, double dt);
  /// The attitude now.
  Attitude attitude() const;

 private:
  struct Spring {
    double at{}, speed{};
    void advance(double target, double frequency, double damping, double dt);
  };

  bool flies_, walks_;
  double frequency_;   ///< Of the springs, or of the control loop of a flying body, rad/s.
  double damping_;     ///< Damping ratio.
  double compliance_;  ///< Lean per acceleration, rad s2/m; a flying body's follows from gravity.
  double limit_;       ///< Acceleration beyond which no body leans further, m/s2.
  Spring z_{}, roll_{}, pitch_{};
  double gait_{};   ///< Share of the full gait, [0, 1].
  double phase_{};  ///< Of the gait, rad.
};

}  // namespace adit::sim
