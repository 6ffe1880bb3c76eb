// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/time/time.hpp"

namespace adit::agent {

/// The action of a robot in an autonomous mode after the loss of its link. Manual modes always fall to hold,
/// because their stick is silent.
enum class OnLoss { go_on, hold, back };

struct LinkLossParams {
  OnLoss action{OnLoss::go_on};
  Duration after{10s};          ///< Silence of the holder until the link counts as lost, [1 s, 1 h].
  Eigen::Vector2d start{0, 0};  ///< Start position of the robot, map frame, m.
};

/// Detects that the holder is no longer heard (rule 9) and chooses an action. `back` leads to the last place
/// where the holder was heard, and then to the start if the holder is not heard there either. Only autonomous
/// modes are changed: a robot in hold does not move. A pure state machine.
class LinkLoss {
 public:
  struct Inputs {
    bool held{};        ///< The robot has a holder.
    bool autonomous{};  ///< The mode follows goals by itself.
    bool arrived{};     ///< The robot is at the goal.
    Time heard{};       ///< Time of the holder's last heartbeat.
    /// Position of the robot, map frame, m; unset while not localised.
    std::optional<Eigen::Vector2d> place{};
  };
  struct Step {
    bool lost{}, found{};  ///< The loss began, or ended, in this step.
    bool hold{};
    std::optional<Eigen::Vector2d> go_to{};
    Duration silence{};  ///< Of the holder.
  };

  explicit LinkLoss(LinkLossParams params) : params_(params) {}

  /// Call it at least once a second. A step for which refused() was called is returned again a second later.
  Step tick(const Inputs& in, Time now);
  void refused(Time now) { retry_ = now + 1s; }
  bool lost() const { return lost_; }

 private:
  enum class Way { none, to_link, to_start };
  LinkLossParams params_;
  bool lost_{}, acted_{};
  Way way_{Way::none};
  Time since_{};                             ///< Start of the wait at the end of the drive.
  std::optional<Time> retry_{};              ///< Time of the next attempt after a refusal.
  std::optional<Eigen::Vector2d> linked_{};  ///< Last position where the holder was heard.
};

}  // namespace adit::agent
