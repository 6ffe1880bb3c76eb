#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/time/time.hpp"

namespace adit::agent {

/// What a robot does by itself in an autonomous mode. Manual modes always fall to hold (their stick is
/// silent).
enum class OnLoss { go_on, hold, back };

struct LinkLossParams {
  OnLoss action{OnLoss::go_on};
  Duration after{10s};          ///< without a sign of life from the holder, [1 s, 1 h]
  Eigen::Vector2d start{0, 0};  ///< where the robot started, map frame, m
};

/// Notices that the holder is no longer heard (rule 9) and says what to do. `back` leads to the last place
/// where he was heard, and to the start when he is not heard there either. Only an autonomous mode is ever
/// changed: a robot that holds is not made to move. A pure state machine.
class LinkLoss {
 public:
  struct Inputs {
    bool held{};                             ///< somebody holds the robot
    bool autonomous{};                       ///< the mode follows goals by itself
    bool arrived{};                          ///< at the goal
    Time heard{};                            ///< the holder, last
    std::optional<Eigen::Vector2d> place{};  ///< of the robot, map frame, m; nothing while not localised
  };
  struct Step {
    bool lost{}, found{};  ///< it has just begun, it has just ended
    bool hold{};
    std::optional<Eigen::Vector2d> go_to{};
    Duration silence{};  ///< of the holder
  };

  explicit LinkLoss(LinkLossParams params) : params_(params) {}

  /// Once a second or more often. A step that could not be taken (`refused`) is asked for again a second
  /// later.
  Step tick(const Inputs& in, Time now);
  void refused(Time now) { retry_ = now + 1s; }
  bool lost() const { return lost_; }

 private:
  enum class Way { none, to_link, to_start };
  LinkLossParams params_;
  bool lost_{}, acted_{};
  Way way_{Way::none};
  Time since_{};                             ///< on the way, or at its end
  std::optional<Time> retry_{};              ///< the step was refused
  std::optional<Eigen::Vector2d> linked_{};  ///< last place where the holder was heard
};

}  // namespace adit::agent
