// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "core/geometry/staircase.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/team_robot.hpp"
#include "robot_agent/stairs/stairs_tracker.hpp"

namespace adit::perception {
class StairsDetector;
}

namespace adit::agent {

/// A scan in which staircases are sought.
struct StairsJob {
  std::shared_ptr<const Scan> scan{};
  std::vector<TeamRobot> team{};  ///< Robots in view, which are no part of a staircase.
  std::uint32_t odom_epoch{};     ///< Of the scan's odometry frame.
  Time made{};
};

/// All confirmed staircases after a search, in the odometry frame; none between searches.
struct StairsStep {
  std::vector<StairsTracker::Tracked> stairs{};
  std::vector<std::uint64_t> withdrawn{};  ///< Those that are gone since the last search, by their id.
  std::uint32_t odom_epoch{};
};
using StairsService = Service<std::shared_ptr<const StairsJob>, StairsStep>;

struct StairsParams {
  std::uint32_t instance{};      ///< Of the component since the start of the agent.
  Eigen::Vector3d eye{0, 0, 0};  ///< Of the lidar, base_link, m.
  Duration window{1500ms};       ///< Scans are accumulated for so long.
  /// In the window: at 10 Hz they span 0.7 s. The odometry's errors blur eight scans of 1.4 s more: 40 % of
  /// the searches of stairs_found.yaml at 1.2 m/s found the flight (88 of 218), with these 44 % (58 of 132).
  std::size_t most_scans{8};
  /// Way of the robot since the last search, m: from nearer, a sight counts as one of the same place.
  double least_way{StairsTracker::kApart};
  Duration modelled{6ms};  ///< Duration of a search in rehearsal.
};

/// The component that seeks staircases in the scans of the last seconds, on a strand of its own.
class StairsPart : public Component {
 public:
  StairsPart(StairsParams params, Executor& strand, Log log, StairsService& service);

 protected:
  Result<void> on_start() override;

 private:
  void take(const std::shared_ptr<const StairsJob>& job, const Reply<StairsStep>& reply);
  bool is_due(const StairsJob& job) const;

  StairsParams params_;
  StairsService& service_;
  std::deque<std::shared_ptr<const StairsJob>> scans_{};
  std::shared_ptr<perception::StairsDetector> detector_{};
  StairsTracker tracker_;
  bool searching_{false};                         ///< One search at a time uses the detector.
  std::optional<Eigen::Vector3d> sought_from_{};  ///< Place of the last search, m.
};

/// The points of scans, odometry frame, the oldest first: without what moves, and without other robots.
struct StairsCloud {
  std::vector<Eigen::Vector3f> points{};
  std::vector<perception::StairsRays> rays{};  ///< Views into `points`.
};
/// `eye`: of the lidar whose points have no origin of their own, base_link, m.
StairsCloud accumulated(std::span<const std::shared_ptr<const StairsJob>> scans, const Eigen::Vector3d& eye);

}  // namespace adit::agent
