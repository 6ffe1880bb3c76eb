// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// The mode `convoy_follow`: drives along the path of the convoy's leader, behind the robot before this one.
/// Convoy decides where to; the leader has a place in the order, but stays in its own mode.
class ConvoyFollowMode : public ModeModule {
 public:
  /// Time without a path to the next place until the leader's path counts as impassable for this robot.
  static constexpr Duration kImpassableAfter = 5s;
  /// Another place beside the path is tried after so long.
  static constexpr Duration kTriesAfter = 2s;
  /// Time without motion, although it should move, until the operator is notified.
  static constexpr Duration kStandsAfter = 10s;

  explicit ConvoyFollowMode(const ModeContext& context) : context_(context) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<ConvoyFollowMode>(context);
  }
  static ModeRow row();

  void note(Facts& facts, Time now) const override;
  void enter(Time now) override;
  /// Another mode was requested: the robot leaves the convoy.
  void clear() override;
  void tick(bool passes, Time now) override;
  void navigated(const Progress& progress) override { navigated_ = progress; }
  ModeProgress progress(bool passes) const override;
  void store(StoredBehaviour& stored) const override;
  void restore(const StoredBehaviour& stored) override;

 private:
  /// Why the robot does not follow; none: it does, or has no reason to move.
  Reason watch(bool passes, Time now);

  ModeContext context_;
  Progress navigated_{};
  GoTo next_{};
  Time tried_{};        ///< When another place was tried last.
  Time free_since_{};   ///< When there was a path to the next place.
  Time moved_since_{};  ///< When the robot moved, or had no reason to.
  std::optional<Eigen::Vector2d> moved_at_{};
  Reason reason_{Reason::none};                   ///< Why it does not follow.
  std::optional<Eigen::Vector2d> reported_at_{};  ///< Where its operator was notified of that.
  Reason reported_{Reason::none};
};

}  // namespace adit::agent
