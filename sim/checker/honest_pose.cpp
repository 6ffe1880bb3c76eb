// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr double kSigmas = 5.0;
constexpr double kMargin = 0.1;         ///< m
constexpr Duration kPatience = 2s;      ///< An error beyond its limit for longer is a violation.
constexpr double kWay = 20.0;           ///< Over which the growth of the error is judged, m.
constexpr double kGrowth = 0.05;        ///< Share of that way.
constexpr Duration kAge = 200ms;        ///< Of the measurement behind a stated pose, at most.
constexpr Duration kPoseTaken = 300ms;  ///< After a `pose` command was accepted, states give the new pose.

/// Rule 11: honest poses. A robot whose pose comes from perception states with it how wrong it may be: its
/// error is not above five standard deviations and 0.1 m for longer than 2 s, and its health is not `ok`
/// while the error grew by more than 5 % of the way over the last 20 m. Errors count from the first pose
/// stated, and from what a `pose` command set: an error in those is not the robot's.
class HonestPose : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event, const ReportViolation& report) override {
    if (const auto* motion = std::get_if<Motion>(&event)) on_motion(robot, motion->pose);
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack);
    if (const auto* state = std::get_if<StateSent>(&event)) on_state(robot, *state, report);
  }

 private:
  struct Past {
    Duration at{};
    Pose2 pose{};
  };
  struct Mark {
    double way{};    ///< Driven until then, m.
    double error{};  ///< m
  };

  void on_motion(const RobotModel& robot, const Pose2& pose) {
    if (!past_.empty()) way_ += (pose.position() - past_.back().pose.position()).norm();
    past_.push_back({robot.now(), pose});
    while (robot.now() - past_.front().at > kAge) past_.pop_front();
  }

  void on_answer(const RobotModel& robot, const AckSent& ack) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || !ack.accepted || pending->command.verb != Verb::pose) return;
    forget();
    set_at_ = robot.now();
  }

  void forget() {
    reference_.reset();
    beyond_since_.reset();
    marks_.clear();
    grown_ = false;
  }

  void on_state(const RobotModel& robot, const StateSent& state, const ReportViolation& report) {
    const Localisation health = state.localisation;
    if (past_.empty() || health == Localisation::off) return;
    if (set_at_ && robot.now() - *set_at_ < kPoseTaken) return;
    // Until it is located it states no pose of its own.
    if (health == Localisation::starting) {
      beyond_since_.reset();
      return;
    }
    if (!reference_) reference_ = past_.back().pose * state.pose.planar().inverse();
    const Pose2 stated = *reference_ * state.pose.planar();
    // The measurement may be of any instant since kAge.
    Eigen::Vector2d error = stated.position() - past_.front().pose.position();
    for (const Past& past : past_)
      if (const Eigen::Vector2d e = stated.position() - past.pose.position(); e.norm() < error.norm())
        error = e;
    judge_sigma(robot, state, error.norm(), report);
    judge_growth(state, error.norm(), report);
  }

  void judge_sigma(const RobotModel& robot, const StateSent& state, double error,
                   const ReportViolation& report) {
    if (error <= kSigmas * state.sigma + kMargin) {
      beyond_since_.reset();
      reported_ = false;
      return;
    }
    if (!beyond_since_) beyond_since_ = robot.now();
    if (reported_ || robot.now() - *beyond_since_ <= kPatience) return;
    reported_ = true;
    char text[128];
    std::snprintf(text, sizeof text,
                  "was %.2f m from where it said for 2 s, with a standard deviation of %.3f m", error,
                  state.sigma);
    report(text);
  }

  void judge_growth(const StateSent& state, double error, const ReportViolation& report) {
    constexpr double kMarkEvery = 0.5;  // m
    if (marks_.empty() || way_ - marks_.back().way >= kMarkEvery) marks_.push_back({way_, error});
    while (marks_.size() > 1 && way_ - marks_[1].way >= kWay) marks_.pop_front();
    const double driven = way_ - marks_.front().way;
    const double growth = error - marks_.front().error;
    const bool grown = driven >= kWay && growth > kGrowth * driven && state.localisation == Localisation::ok;
    if (grown && !grown_) {
      char text[128];
      std::snprintf(text, sizeof text, "said that its pose is ok while the error grew by %.2f m over %.1f m",
                    growth, driven);
      report(text);
    }
    grown_ = grown;
  }

  std::deque<Past> past_{};           ///< True poses since kAge ago.
  double way_{};                      ///< Driven, m.
  std::optional<Pose2> reference_{};  ///< From the map frame of the robot to the world.
  std::optional<Duration> set_at_{};  ///< When a `pose` command was accepted.
  std::optional<Duration> beyond_since_{};
  bool reported_{}, grown_{};
  std::deque<Mark> marks_{};
};

}  // namespace

std::unique_ptr<Rule> make_honest_pose_rule() { return std::make_unique<HonestPose>(); }

}  // namespace adit::sim
