#pragma once
#include <optional>

#include "robot_agent/motion/mux.hpp"

namespace adit::agent {

/// The mode `external`: a program on the robot domain steers, one that speaks only ROS 2 types. What it
/// writes to /external/cmd_vel passes while the tree enables it, within the platform's limits and behind the
/// collision monitor, as every source does.
class External {
 public:
  static constexpr Duration kFresh{500ms};  ///< rule 6: a planner

  explicit External(Mux& mux) : output_(mux.connect("external", kFresh)) {}

  /// Body frame. Not finite: as good as silence.
  void heard(const Twist2& velocity, Time now);
  bool fresh(Time now) const { return last_ && now - *last_ <= kFresh; }

 private:
  Mux::Output output_;
  std::optional<Time> last_{};
};

}  // namespace adit::agent
