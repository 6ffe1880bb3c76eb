// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// The mode `get_out`: drives to a place out of another robot's way, and waits there. RightOfWay decides
/// when, and for whom; no operator requests it.
class GetOutMode : public ModeModule {
 public:
  explicit GetOutMode(const ModeContext& context) : context_(context) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<GetOutMode>(context);
  }
  static ModeRow row();

  void note(Facts& facts, Time now) const override;
  void enter(Time) override { navigated_ = {}; }
  void tick(bool passes, Time now) override;
  void navigated(const Progress& progress) override { navigated_ = progress; }
  ModeProgress progress(bool) const override { return {.navigation = navigated_}; }
  void store(StoredBehaviour& stored) const override;
  void restore(const StoredBehaviour& stored) override;

 private:
  ModeContext context_;
  Progress navigated_{};
};

}  // namespace adit::agent
