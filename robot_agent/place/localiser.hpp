// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/component/component.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/pose_correction.hpp"
#include "robot_agent/motion/scans.hpp"
#include "robot_agent/notices/notices.hpp"
#include "robot_agent/perception/keyframe_store.hpp"
#include "robot_agent/perception/place_agreement.hpp"
#include "robot_agent/perception/place_check.hpp"

namespace adit::perception {
struct RecognisedPlace;
}

namespace adit::agent {

/// What is known of the robot's place and outlives the component that uses it.
struct PlaceMemory {
  PlaceCheck place{};
  PoseCorrection::Account odometry{};          ///< As of the last report.
  std::unique_ptr<KeyframeStore> keyframes{};  ///< Null with `perception: off`.
  FoundPlaceService found_place{"found place", 2};
};

/// Keeps the robot's frames by the driver's odometry and by its own, gives each scan its poses, and finds the
/// place of a robot that was restarted or is lost, by the stored keyframes. Runs on the command strand.
class Localiser : public Component {
 public:
  struct Outputs {
    std::function<void(Reason)> hold{};  ///< Ends the mode: nothing may drive by the present pose.
    /// The odometry frame began again: what was stored in it is elsewhere now.
    std::function<void()> frame_began{};
    std::function<void()> keep{};  ///< Stores the state that must survive a restart, at once.
    /// What moves around the robot, see Scan::movers.
    std::function<std::vector<Eigen::Vector3f>()> movers{};
    /// A scan with its poses. `lidar`: the sample that it was made from, without points.
    std::function<void(std::shared_ptr<Scan> scan, const LidarScan& lidar)> scan{};
  };

  /// `params`, `frames`, `memory` and `notices` must outlive it.
  Localiser(const AgentParams& params, Executor& strand, Log log, Frames& frames, PlaceMemory& memory,
            const Notices& notices, Outputs outputs);

  /// Takes a sample of the driver's odometry.
  void odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received);
  /// Takes a scan. It waits for odometry as new as its stamp, or for the next scan.
  void scan(LidarScan lidar);
  /// Reports to the holder when the odometry becomes weak or lost, and when it is well again.
  void watch(Time at);
  /// Sets the robot's pose in the map, on an operator's request. Errors: no_localisation.
  Result<void> set_pose(const Pose2& pose);
  /// Corrects T_map_odom. Errors: those of Frames::correct().
  Result<MapFrame> correct_map(const MapFrame& corrected);

  /// Restores frames and odometry after a restart; the robot then recognises its surroundings, or holds.
  /// `first`: the agent itself was restarted, not this component alone.
  void restore(const StoredFrames& stored, bool first);
  StoredFrames stored() const;

  /// See PoseCorrection; the identity without an odometry of its own.
  Pose3 T_odom_driver() const { return localises() ? correction_.T_odom_driver() : Pose3{}; }
  /// Health of the robot's own odometry.
  Localisation health(Time at) const;
  /// Standard deviation of the position, m; infinite: the robot does not know where it is.
  double sigma() const;
  /// Whether autonomous modes may use the pose.
  bool known(Time at) const { return unknown_because(at) == Reason::none; }
  /// Why they may not; none: they may, once odometry has arrived.
  Reason unknown_because(Time at) const;
  /// Whether the surroundings are those of the stored keyframes, or there is nothing to compare with.
  bool recognised() const { return memory_.place.known(); }

 private:
  /// Whether the robot has an odometry of its own beside the driver's.
  bool localises() const { return params_.perception != PerceptionLevel::off; }
  /// Whether the stamp is slightly newer than the odometry, so that the next sample gives the pose at that
  /// time.
  bool is_ahead(std::uint64_t stamp) const;
  void release_scan();
  /// Handles odometry that began again elsewhere.
  void jumped();
  void make_keyframe(const std::shared_ptr<const Scan>& scan);
  /// Compares a scan with the stored keyframes after a restart.
  void compare(const std::shared_ptr<const Scan>& scan);
  void compared(const Result<perception::RecognisedPlace>& found);
  /// Compares a scan of a lost robot with all that it saw nearby, once a second.
  void search(const std::shared_ptr<const Scan>& scan);
  /// `sigma`: of the guess but for what moved it unseen, m.
  void searched(const Result<perception::RecognisedPlace>& found, const Pose3& guess, double sigma);
  /// Moves the own odometry by a correction in the odometry frame.
  void correct_odometry(const Pose3& correction, double sigma, double sigma_heading);
  /// An operator said where a lost robot is: its odometry goes on from there.
  void place_set();
  /// Zero and hold until an operator sets the pose.
  void place_unknown(const std::string& why);

  const AgentParams& params_;
  Frames& frames_;
  PlaceMemory& memory_;
  const Notices& notices_;
  Outputs outputs_;
  PoseCorrection correction_;
  std::optional<LidarScan> waiting_{};  ///< Waits for odometry as new as its stamp.
  Localisation reported_{Localisation::starting};
  Time changed_at_{};  ///< Since then the odometry has a health that was not reported.
  std::optional<Time> jump_reported_{};
  std::optional<Time> search_began_{};  ///< When the last search began.
  bool not_searched_{};                 ///< The place may be too far away to search; that was reported.
  PlaceAgreement agreement_{};          ///< Of the results of the search so far.
  int comparisons_{};                   ///< Scans that did not fit the stored keyframes.
};

}  // namespace adit::agent
