// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "nav/explore/explorer.hpp"
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/common/exploration.hpp"

namespace adit::agent {

/// The mode `explore`: navigation drives to the places that the router's explorer names, one after the other,
/// until nothing new can be seen from any of them. The mode then ends in `hold`.
class ExploreMode : public ModeModule {
 public:
  static constexpr Duration kAskPeriod = 200ms;  ///< The router takes a scan as often.
  static constexpr Duration kAnswerLost = 2s;    ///< A later answer is not awaited.
  static constexpr double kFar = 16.0;           ///< m
  static constexpr double kOtherGoal = 0.5;      ///< From here on a place is another goal, m.

  explicit ExploreMode(ModeContext context) : context_(std::move(context)) {}
  /// Robots that fly, and those without a router, have no explorer.
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return context.explore ? std::make_unique<ExploreMode>(context) : nullptr;
  }

  void note(Facts& facts, Time now) const override;
  void enter(Time now) override;
  void leave(Time) override { active_ = false; }
  void tick(bool passes, Time now) override;
  void set_exploration(const ExploreRequest& request) override;
  void navigated(const Progress& progress) override { navigated_ = progress; }
  ModeProgress progress(bool) const override {
    return {.finished = is_over(), .exploration = active_ || is_over() ? view_ : contract::Exploration{}};
  }
  void store(StoredBehaviour& stored) const override;
  void restore(const StoredBehaviour& stored) override;

 private:
  bool is_over() const {
    using enum contract::ExplorationPhase;
    return view_.phase == done || view_.phase == ended;
  }
  void begin();
  void ask(Time now);
  void answered(const nav::ExploreStep& step);
  /// Ends the search for new places and begins the last leg.
  void conclude(Reason reason, const std::string& text);
  void begin_return();
  void finish();
  void return_to(std::optional<Eigen::Vector2d> place);
  void tick_return();
  std::string summary() const;

  ModeContext context_;
  ExploreRequest request_{};
  contract::Exploration view_{};
  bool active_{};                          ///< The mode was not left.
  std::optional<Eigen::Vector3d> goal_{};  ///< Map frame, m.
  std::uint32_t goal_id_{};
  Progress navigated_{};
  std::optional<Time> asked_{};  ///< The answer is awaited since.
  std::optional<Time> last_asked_{};
  std::uint32_t run_{};                                ///< Answers of an earlier exploration are discarded.
  std::optional<Time> ends_{};                         ///< Of the request's limit.
  bool begins_{true};                                  ///< The router does not know of this exploration yet.
  Reason why_{Reason::none};                           ///< Why the exploration ended, during the last leg.
  bool complete_{};                                    ///< It ended because everything was seen.
  mutable std::optional<Eigen::Vector2d> heard_at_{};  ///< Where the robot was when its holder was heard.
};

}  // namespace adit::agent
