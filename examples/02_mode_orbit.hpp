// SPDX-License-Identifier: Apache-2.0
// Example 2: a mode. This file is the complete mode `orbit`: its module, its row in the mode table and its
// line in the behaviour tree. docs/adding_a_mode.md explains it; 02_mode_orbit.cpp rehearses it.
#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "core/store/pack.hpp"
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// The mode `orbit`: drives counter-clockwise around a centre, through eight places on the circle. The centre
/// is the point 3 m to the left of the robot when the mode is entered.
class OrbitMode : public ModeModule {
 public:
  static constexpr double kRadius = 3.0;                 ///< m
  static constexpr double kStep = std::numbers::pi / 4;  ///< From one place to the next, rad.
  static constexpr double kNear = 1.0;  ///< The next place follows when the robot is nearer than this, m.

  explicit OrbitMode(const ModeContext& context) : context_(context) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<OrbitMode>(context);
  }
  static ModeRow row();

  void note(Facts& facts, Time) const override {
    const auto centre = centre_ ? centre_ : centre_here();
    if (centre && context_.goal_free(*centre)) facts.also.push_back("orbit_centre_free");
  }
  void enter(Time) override {
    if (!centre_) centre_ = centre_here();
    target_.reset();
  }
  void clear() override { centre_.reset(); }

  void tick(bool, Time now) override {
    const auto pose = context_.pose();
    if (!pose || !centre_) return;
    const Eigen::Vector2d here(pose->x, pose->y);
    if (!target_ || (here - *target_).norm() < kNear) {
      const Eigen::Vector2d from_centre = (target_ ? *target_ : here) - *centre_;
      const double angle = std::atan2(from_centre.y(), from_centre.x()) + kStep;
      target_ = *centre_ + kRadius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    context_.output.write(GoTo{{target_->x(), target_->y(), std::nan("")}}, now);
  }

  ModeProgress progress(bool passes) const override {
    if (!centre_) return {};
    return {.state = passes ? GoalState::active : GoalState::kept,
            .goal_id = 1,
            .goal = {centre_->x(), centre_->y(), 0.0}};
  }

  void store(StoredBehaviour& stored) const override {
    if (centre_)
      stored.modes.push_back({"orbit", store::Packer{}.put(centre_->x()).put(centre_->y()).bytes()});
  }
  void restore(const StoredBehaviour& stored) override {
    const store::Bytes* bytes = stored.of("orbit");
    if (!bytes) return;
    store::Unpacker in(*bytes);
    const double x = in.number(), y = in.number();
    if (in.done() && std::isfinite(x) && std::isfinite(y)) centre_ = {x, y};
  }

 private:
  std::optional<Eigen::Vector2d> centre_here() const {
    const auto pose = context_.pose();
    if (!pose) return std::nullopt;
    return *pose * Eigen::Vector2d(0.0, kRadius);
  }

  ModeContext context_;
  std::optional<Eigen::Vector2d> centre_{}, target_{};  // map frame, m
};

inline ModeRow OrbitMode::row() {
  using namespace conditions;
  static constexpr Condition centre_free{"OrbitCentreFree", Reason::goal_unreachable,
                                         [](const Facts& f) { return f.has("orbit_centre_free"); },
                                         Scope::on_entry};
  return {.name = "orbit",
          .commanded_by = {.holder = true},
          .goal = GoalOnLeaving::cleared,
          .on_failure = OnFailure::pauses,
          .conditions = {kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, centre_free},
          .make = OrbitMode::make,
          .output_lifetime = 500ms,
          .optional = true};
}

/// The shipped tree (config/trees/robot.xml) with `orbit`: one line above `<Run name="hold" mode="hold"/>`.
inline std::string with_orbit(std::string tree) {
  return tree.insert(tree.find("<Run name=\"hold\""), "<Mode mode=\"orbit\"/>\n      ");
}

/// The shipped modes and `orbit`.
inline std::shared_ptr<const ModeTable> modes_with_orbit() {
  std::vector<ModeRow> rows = ModeTable::shipped().rows();
  rows.push_back(OrbitMode::row());
  return std::make_shared<const ModeTable>(std::move(rows));
}

}  // namespace adit::agent
