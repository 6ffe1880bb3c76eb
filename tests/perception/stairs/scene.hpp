// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/staircase.hpp"
#include "core/time/random.hpp"

/// Staircases, and what looks like one, as a lidar sees them. Unlike rehearsal's worlds, whose boxes begin
/// and end on multiples of 5 cm, boxes are exact here.
namespace adit::perception::scenes {

/// A spinning lidar without times.
struct Lidar {
  int rings{32}, columns{900};
  double lowest{-45.0}, highest{15.0};  ///< Degrees; these are the platform `legged`'s.
  double height{0.65};                  ///< m
  double min_range{0.4}, max_range{30.0};
  double noise{0.02};  ///< Standard deviation of a range, m.
};

/// A solid: a box turned about its own y axis (a ramp) and then about z.
struct Solid {
  Eigen::Vector3d centre{}, half{};  ///< m
  double yaw{}, pitch{};             ///< Radians; pitch > 0 lowers its +x end.
  double passes{0.0};                ///< Share of the rays that go through it, as through a grating, [0, 1].
  bool mirror{false};                ///< Rays go on from it, mirrored, and it is not seen itself.
};

/// A world and the way of a robot in it, in the world's frame.
struct Scene {
  std::vector<Solid> solids{};
  double floor{0.0};  ///< Height of an endless plane; -infinity: none.
  std::optional<Staircase> truth{};
  Pose2 start{};       ///< Of the robot at the last sweep.
  double ground{0.0};  ///< Under it, m.
};

/// Cloud of one robot, in its level base_link at the last sweep.
struct Cloud {
  std::vector<Eigen::Vector3f> points{};
  std::vector<Eigen::Vector3f> last{};  ///< Those of the last sweep.
  Eigen::Vector3f eye{};                ///< Place of the lidar.
};

struct Sensing {
  Lidar lidar{};
  int sweeps{15};     ///< At 10 Hz, on the way to `start`.
  double speed{0.7};  ///< m/s
  double tilt{0.0};   ///< Error of the attitude, rad, about an axis that is drawn.
};

void add_box(Scene& scene, double x0, double x1, double y0, double y1, double z0, double z1);
Cloud sense(const Scene& scene, const Sensing& sensing, Random& random);
/// The truth in the cloud's frame.
Staircase seen_from(const Scene& scene, const Staircase& stairs);

enum class Row {
  open,
  walled,
  down,
  winding,  ///< Its upper steps turn; the truth is the straight part.
  clutter,  ///< Boxes, people, pallets and rubble stand on it.
  half,     ///< A wall hides half of its width.
  door,     ///< Behind a door of 0.9 m.
  grating,  ///< Treads without risers through which half of the rays pass.
  mirror,   ///< Beside a wall that mirrors.
};
inline constexpr std::array kRows{"open", "walled", "down",    "winding", "clutter",
                                  "half", "door",   "grating", "mirror"};
/// A staircase that climbs along +x from the origin, and a robot before its foot or at its upper edge.
Scene staircase(Row row, Random& random);
/// What is no staircase: by `n`, one of kNotStairs kinds.
inline constexpr std::array kNotStairs{"ramp",   "kerb",  "shelf", "pallets",   "stripes", "rubble",
                                       "person", "table", "slope", "two_kerbs", "room"};
Scene not_stairs(std::size_t n, Random& random);

}  // namespace adit::perception::scenes
