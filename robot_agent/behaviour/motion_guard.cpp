// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/motion_guard.hpp"

namespace adit::agent {

MotionGuard::MotionGuard(const ModeTable& table) : hold_(&table.hold()), admitted_(hold_) {}

Reason MotionGuard::admit(const ModeRow& row, Commander by, const Facts& facts) {
  if (!row.commanded_by.allows(by)) return Reason::not_holder;
  const bool goes_on = &row == admitted_ && row.manual();
  if (!goes_on)
    if (const Reason reason = entry_refusal(row, facts); reason != Reason::none) return reason;
  admitted_ = &row;
  return Reason::none;
}

void MotionGuard::readmit(const ModeRow& row) {
  admitted_ = row.on_failure == OnFailure::pauses ? &row : hold_;
}

bool MotionGuard::holder_changed() {
  if (admitted_->on_handover == OnHandover::continues) return false;
  hold();
  return true;
}

Decision MotionGuard::judge(const Decision& wanted, const Facts& facts) {
  if (admitted_ == hold_) return {hold_, wanted.mode == hold_ && wanted.runs, wanted.reason};
  if (const Condition* failed = admitted_->ended_by(facts)) return fall(failed->failure(facts));
  if (wanted.mode != admitted_ || (!wanted.runs && admitted_->on_failure != OnFailure::pauses))
    return fall(wanted.mode == hold_ && wanted.reason != Reason::none ? wanted.reason : Reason::tree_refused);
  if (const Condition* failed = admitted_->paused_by(facts))
    return {admitted_, false, failed->failure(facts)};
  return {admitted_, wanted.runs, wanted.reason};
}

Decision MotionGuard::fall(Reason reason) {
  hold();
  return {hold_, false, reason};
}

}  // namespace adit::agent
