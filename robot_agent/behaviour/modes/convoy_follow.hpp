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

  explicit ConvoyFollowMode(const ModeContext& context) : context_(context) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<ConvoyFollowMode>(context);
  }
  static ModeRow row();

  void note(Facts& facts, Time now) const override;
  void enter(Time now) override { free_since_ = now; }
  /// Another mode was requested: the robot leaves the convoy.
  void clear() override;
  void tick(bool passes, Time now) override;
  void navigated(const Progress& progress) override { navigated_ = progress; }
  ModeProgress progress(bool passes) const override;
  void store(KeptBehaviour& kept) const override;
  void restore(const KeptBehaviour& kept) override;

 private:
  ModeContext context_;
  Progress navigated_{};
  Time free_since_{};
  bool impassable_{};
};

}  // namespace adit::agent
