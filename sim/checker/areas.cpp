// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "nav/areas/area_set.hpp"
#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

/// A robot that was driven by hand towards a border may need this to brake when its mode changes.
constexpr Duration kBraking = 1s;
/// Distance from the border in standard deviations of the place.
constexpr double kBorderSigmas = 3.0;
/// A body that was nearer than that may get its middle so much nearer, or farther out, on its way back, m. A
/// turn on the spot takes its corners farther.
constexpr double kSlack = 0.15;

/// Rule 10: areas are hard limits. In an autonomous mode no part of the body leaves the ground that the
/// accepted areas permit. Judged by the true pose if the robot's odometry has no error, otherwise by the
/// robot's own. Where the true pose is known, it is also judged that the body keeps three of the standard
/// deviations that the robot states from forbidden ground, and that one that is nearer or outside already, as
/// after driving by hand, gets no farther out on its way back.
class AreasAreHard : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    // What a failed disk lost does not bind any more.
    if (std::get_if<AgentStarted>(&event) && robot.disk_failed()) areas_ = {};
    if (const auto* ack = std::get_if<AckSent>(&event)) on_answer(robot, *ack);
    if (const auto* state = std::get_if<StateSent>(&event)) {
      height_ = state->pose.position.z();
      if (kBorderSigmas * state->sigma > needed_)
        kept_.reset();  // Where the body is now was near enough before.
      needed_ = kBorderSigmas * state->sigma;
      if (!robot.facts().knows_its_place) judge(robot, state->pose.planar(), report_violation);
    }
    if (const auto* motion = std::get_if<Motion>(&event); motion && robot.facts().knows_its_place)
      judge(robot, motion->pose, report_violation);
  }

 private:
  void on_answer(const RobotModel& robot, const AckSent& ack) {
    const RobotModel::Pending* pending = robot.answered_by(ack);
    if (!pending || !ack.accepted || robot.first_answer(RobotModel::key(pending->command))) return;
    const CommandHeard& command = pending->command;
    if (command.verb == Verb::area_remove || command.verb == Verb::area_add) kept_.reset();
    if (command.verb == Verb::area_remove) areas_.remove(command.text);
    if (command.verb == Verb::area_add) add(command);
    // Both can shrink the ground in front of the robot.
    if (command.verb != Verb::area_add && command.verb != Verb::area_remove) return;
    const Twist2& v = robot.truth().velocity;
    braked_by_ = robot.now() + rest_limit(std::hypot(v.vx, v.vy) / robot.facts().max_acceleration);
  }

  void add(const CommandHeard& command) {
    if (command.words.size() < 2) return;
    nav::Area area{.name = command.words[0], .kind = nav::AreaKind::prefer};
    if (command.words[1] == name(nav::AreaKind::keep_in)) area.kind = nav::AreaKind::keep_in;
    if (command.words[1] == name(nav::AreaKind::keep_out)) area.kind = nav::AreaKind::keep_out;
    std::vector<double> numbers = command.numbers;
    if ((command.options & 2U) != 0 && !numbers.empty()) numbers.pop_back();  // The weight.
    if ((command.options & 1U) != 0 && numbers.size() >= 2) {
      area.z_max = numbers.back();
      numbers.pop_back();
      area.z_min = numbers.back();
      numbers.pop_back();
    }
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
      area.corners.emplace_back(numbers[i], numbers[i + 1]);
    if (const auto valid = nav::checked(area)) (void)areas_.add(*valid);
  }

  void judge(const RobotModel& robot, const Pose2& pose, const ReportViolation& report_violation) {
    if (areas_.empty()) return;
    const double x = robot.facts().length / 2, y = robot.facts().width / 2;
    const std::array<Eigen::Vector2d, 4> body{pose * Eigen::Vector2d(x, y), pose * Eigen::Vector2d(-x, y),
                                              pose * Eigen::Vector2d(-x, -y), pose * Eigen::Vector2d(x, -y)};
    const bool was_within = within_;
    within_ = areas_.permits(body, height_);
    const std::string& mode = robot.mode();
    const bool autonomous = robot.alive() && !mode.empty() && mode != "hold" && !robot.in_manual_mode();
    const bool brakes = robot.age(robot.mode_changed()) < kBraking || robot.now() < braked_by_;
    if (!autonomous || brakes) return kept_.reset();
    char text[128];
    std::snprintf(text, sizeof text, "left the ground that its areas permit at %.2f %.2f in ", pose.x,
                  pose.y);
    if (!within_ && was_within) report_violation(text + mode);
    if (!robot.facts().knows_its_place) return;
    const std::array<Eigen::Vector2d, 1> middle{pose.position()};
    Clearance is{areas_.clearance(body, height_), areas_.clearance(middle, height_)};
    kept_ = kept_ ? Clearance{std::max(kept_->body, is.body), std::max(kept_->middle, is.middle)} : is;
    const bool kept = kept_->body >= needed_;
    const double clearance = kept ? is.body : is.middle;
    const double limit = kept ? needed_ : kept_->middle - kSlack;
    if (clearance >= limit || (!within_ && was_within)) return;
    std::snprintf(text, sizeof text, "%s %.2f m from forbidden ground, where at least %.2f m were due, in ",
                  kept ? "the body" : "its middle", clearance, limit);
    report_violation(text + mode);
    kept_ = is;  // Reported once.
  }

  nav::AreaSet areas_{};
  double height_{};
  bool within_{true};
  Duration braked_by_{};  ///< A robot that moved when the ground shrank may need so long to brake.
  double needed_{};       ///< Distance from forbidden ground by the stated deviation, m.
  /// Distances from forbidden ground, m; negative on it.
  struct Clearance {
    double body{}, middle{};
  };
  std::optional<Clearance> kept_{};  ///< Greatest ones since the mode began or more was needed.
};

}  // namespace

std::unique_ptr<Rule> make_areas_rule() { return std::make_unique<AreasAreHard>(); }

}  // namespace adit::sim
