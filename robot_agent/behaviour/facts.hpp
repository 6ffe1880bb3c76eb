#pragma once
#include <algorithm>
#include <string_view>
#include <vector>

namespace adit::agent {

/// What the conditions of the modes look at.
struct Facts {
  bool stopped{};
  bool driver_alive{};   ///< odometry within the last 0.5 s
  bool localised{};      ///< start pose known and odometry heard
  bool terrain_fresh{};  ///< lidar points within the last 0.5 s
  bool stick_fresh{};    ///< a sample within the last 0.3 s
  bool stick_kept{};     ///< a sample within the last 1 s
  bool stick_centred{};
  bool goal_known{};
  bool goal_free{};      ///< no obstacle that is known covers it
  bool program_fresh{};  ///< the program that steers from outside spoke within the last 0.5 s
  /// Further facts that hold, for conditions of modes that need others; the mode's module adds them.
  std::vector<std::string_view> also{};

  bool has(std::string_view fact) const { return std::find(also.begin(), also.end(), fact) != also.end(); }
};

}  // namespace adit::agent
