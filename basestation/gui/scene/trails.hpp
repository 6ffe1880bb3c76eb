// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// Where robots were, and how often they report, both read from successive snapshots.
class Trails {
 public:
  static constexpr std::size_t kMaxPoints = 1200;  ///< Of one robot.
  static constexpr double kStep = 0.15;            ///< Distance between points of a trail, m.
  static constexpr double kJump = 3.0;      ///< A trail breaks where its robot moved farther at once, m.
  static constexpr double kMaxAge = 600.0;  ///< Trails end this long ago, s.

  struct Stamped {
    Point place{};
    double time{};  ///< As given to add().
    bool begins{};  ///< No line leads here from the point before.
    double z{};     ///< Map frame, m.
  };
  /// What of a state says where the next one should be. Map frame, m and rad; speeds in the body frame.
  struct Motion {
    float x{}, y{}, z{}, yaw{}, vx{}, vy{}, wz{};
    std::uint8_t map_revision{};
  };
  struct Trail {
    std::deque<Stamped> points{};
    double last_state{-1.0};  ///< Time of the last state, s.
    Motion last{};            ///< As it was then.
    double period{0.1};       ///< Between two states, s, smoothed.
  };

  /// Where a robot's place in the map was corrected, its trail is moved with it: the newest part as far as
  /// the robot, the oldest not at all. `now`: steady time, s.
  void add(const station::World& world, double now);
  /// The trail of a robot; null before its first place.
  const Trail* of(const std::string& robot) const;
  /// A robot's values are stale after 3 of its periods, and not before 1 s.
  double stale_after(const std::string& robot) const;

 private:
  std::map<std::string, Trail> trails_{};
};

}  // namespace adit::gui
