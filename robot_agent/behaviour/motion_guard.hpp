// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/behaviour/decision.hpp"

namespace adit::agent {

/// Enforces the mode table in front of the mux, whatever the behaviour tree decides (rules 4, 6 and 7).
///
/// A request admits a mode if its commander may request it and all its conditions hold. From then on the
/// tree's decision can only restrict: the admitted mode passes or nothing does, and only while all continuous
/// conditions of its row hold in the same tick. The admission ends when a condition fails that ends the mode,
/// when the tree decides for another mode, or when the row does not survive a change of holder; only another
/// request admits a mode again. The guard reads neither tree nor configuration.
class MotionGuard {
 public:
  /// Starts in `hold`. `table` must outlive this.
  explicit MotionGuard(const ModeTable& table);

  /// Admits `row` if `by` may request it and every condition holds; requesting the manual mode that is
  /// already admitted needs no centred stick. Returns the reason of the refusal, or none.
  Reason admit(const ModeRow& row, Commander by, const Facts& facts);
  /// Admits `row` without its entry conditions, after a restart. A mode that does not pause (manual modes,
  /// `external`) needs a request: `hold` is admitted instead.
  void readmit(const ModeRow& row);
  /// Admits `hold`.
  void hold() { admitted_ = hold_; }
  /// Ends a mode that does not survive a change of holder. Returns whether it ended.
  bool holder_changed();

  /// Returns the decision in force: the tree's decision `wanted`, or a more restricted one.
  Decision judge(const Decision& wanted, const Facts& facts);

  const ModeRow& admitted() const { return *admitted_; }

 private:
  Decision fall(Reason reason);

  const ModeRow* hold_;
  const ModeRow* admitted_;
};

}  // namespace adit::agent
