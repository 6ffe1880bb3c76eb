// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/recovery.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

std::string_view name(RecoveryState state) {
  switch (state) {
    case RecoveryState::drive:
      return "drive";
    case RecoveryState::wait:
      return "wait";
    case RecoveryState::nudge:
      return "nudge";
    case RecoveryState::back_up:
      return "back_up";
    case RecoveryState::replan:
      return "replan";
    case RecoveryState::give_up:
      return "give_up";
  }
  return "?";
}

void Recovery::enter(RecoveryState state, const RecoveryInput& in) {
  state_ = state;
  since_ = in.stamp_s;
  from_ = in.at;
  blocked_since_.reset();
  free_since_.reset();
  if (state == RecoveryState::drive) reason_ = Reason::none;
  if (state == RecoveryState::nudge || state == RecoveryState::back_up || state == RecoveryState::replan)
    spent_at_ = in.at;
  if (state == RecoveryState::nudge) nudged_ = true;
  if (state == RecoveryState::back_up) backed_up_ = true;
  if (state == RecoveryState::replan) answered_ = false;
}

void Recovery::give_up(Reason reason, const RecoveryInput& in) {
  enter(RecoveryState::give_up, in);
  cause_ = in.cause;
  reason_ = reason == Reason::blocked && side_ != Side::none ? Reason::start_in_collision : reason;
  rest_until_ = in.stamp_s + params_.rests * std::exp2(std::min(rests_, params_.doublings));
  ++rests_;
}

Target Recovery::target(Target target) const {
  if (state_ == RecoveryState::back_up) return {.kind = Target::Kind::back_up};
  if (state_ != RecoveryState::nudge) return target;
  if (leaves_ || target.kind != Target::Kind::goal) return {.kind = Target::Kind::leave};
  target.nudges = true;
  return target;
}

void Recovery::restore() {
  nudged_ = backed_up_ = false;
  side_ = Side::none;
  spent_at_.reset();
  replans_ = 0;
}

// The next attempt, each of them once until the robot makes progress.
void Recovery::try_next(const RecoveryInput& in) {
  leaves_ = in.held;
  if (!nudged_) return enter(RecoveryState::nudge, in);
  if (!backed_up_) return enter(RecoveryState::back_up, in);
  if (replans_++ >= params_.replans) return give_up(Reason::blocked, in);
  replan_ = Replan{false};
  enter(RecoveryState::replan, in);
}

// Near the goal a robot that moves and comes no nearer has ended: the goal lies in or behind something.
bool Recovery::comes_no_nearer(const RecoveryInput& in) {
  if (in.left > params_.near || in.left < nearest_ - params_.closer) {
    nearest_ = in.left;
    nearest_since_ = driven_s_;
  }
  return driven_s_ - nearest_since_ >= params_.near_for;
}

RecoveryState Recovery::look(const RecoveryInput& in) {
  constexpr double kPause = 0.5;  // s: a longer interval was a pause.
  if (state_ == RecoveryState::drive && !in.stands)
    driven_s_ += std::clamp(in.stamp_s - last_s_, 0.0, kPause);
  last_s_ = in.stamp_s;
  if (in.goal != goal_) {
    goal_ = in.goal;
    route_ = 0;
    least_ = std::numeric_limits<double>::infinity();
    rests_ = 0;
    if (spent_at_ && (in.at - *spent_at_).norm() >= params_.elsewhere) restore();
    progress_ = ProgressChecker();
    nearest_ = in.left;
    nearest_since_ = driven_s_;
    unreachable_since_.reset();
    enter(RecoveryState::drive, in);
  }
  const bool other_route = in.route != 0 && in.route != route_;
  const bool longer = other_route && in.left > least_ + params_.progress;
  if (other_route) {
    route_ = in.route;
    least_ = in.left;
  } else if (in.route != 0 && in.left < least_ - params_.progress) {
    least_ = in.left;
    if (!spent_at_ || (in.at - *spent_at_).norm() >= params_.elsewhere) restore();
  }
  if (in.route == 0) route_ = 0;
  const bool stuck = in.route != 0 && progress_.stuck(in.left, longer, driven_s_);
  const bool ended = in.route != 0 && comes_no_nearer(in);

  const bool hindered = in.blocked || in.held;
  if (!hindered)
    blocked_since_.reset();
  else if (!blocked_since_)
    blocked_since_ = in.stamp_s;
  if (hindered || !in.ends_at_goal)
    free_since_.reset();
  else if (!free_since_)
    free_since_ = in.stamp_s;
  const double now = in.stamp_s;
  const bool blocked = blocked_since_ && now - *blocked_since_ >= (in.held ? 0.0 : params_.blocked);
  const bool free = free_since_ && now - *free_since_ >= params_.blocked;
  const double lasts = now - since_;
  const double moved = (in.at - from_).norm();
  const bool fails = lasts > 0 && (in.blocked || (in.held && lasts >= params_.held));
  const bool passes_by = in.cause == Cause::mover || in.cause == Cause::peer;

  // Without a route there is nothing to follow.
  if (in.route == 0 && state_ != RecoveryState::give_up && state_ != RecoveryState::replan) {
    if (!unreachable_since_) unreachable_since_ = now;
    if (in.unreachable) {
      give_up(Reason::goal_unreachable, in);
    } else if (in.start_blocked && now - *unreachable_since_ >= params_.blocked &&
               state_ != RecoveryState::nudge) {
      if (!nudged_)
        enter(RecoveryState::nudge, in);
      else
        give_up(Reason::start_in_collision, in);
      return state_;
    } else if (!in.start_blocked && now - *unreachable_since_ >= params_.reported) {
      give_up(Reason::blocked, in);
    }
    if (state_ != RecoveryState::nudge) return state_;
  } else if (in.route != 0) {
    unreachable_since_.reset();
  }

  switch (state_) {
    case RecoveryState::drive:
      if (stuck)
        give_up(Reason::stuck, in);
      else if (ended)
        give_up(Reason::blocked, in);
      else if (blocked)
        passes_by ? enter(RecoveryState::wait, in) : try_next(in);
      break;
    case RecoveryState::wait:
      if (!hindered) {
        enter(RecoveryState::drive, in);
      } else if (!passes_by) {
        if (now - *blocked_since_ >= params_.blocked) try_next(in);
      } else {
        blocked_since_ = now;
        if (lasts >= params_.reported - params_.blocked) reason_ = Reason::blocked;
        cause_ = in.cause;
        if (lasts >= params_.waits) {
          replan_ = Replan{true};
          since_ = now;
        }
      }
      break;
    case RecoveryState::nudge:
      side_ = in.side;
      if (lasts >= params_.nudges || fails || (lasts > 0 && !in.nudge)) enter(RecoveryState::drive, in);
      break;
    case RecoveryState::back_up:
      if (moved >= params_.backs_up || lasts >= params_.backs_up_for || fails)
        enter(RecoveryState::drive, in);
      break;
    case RecoveryState::replan:
      if (!answered_ && lasts < params_.router_for) break;
      if (answered_ && in.route != 0)
        enter(RecoveryState::drive, in);
      else
        give_up(Reason::blocked, in);
      break;
    case RecoveryState::give_up:
      if (in.unreachable) reason_ = Reason::goal_unreachable;
      if (in.route != 0 && reason_ != Reason::stuck && other_route) {
        enter(RecoveryState::drive, in);
      } else if (free && in.route == 0) {
        free_ = true;
        free_since_.reset();
      } else if (now >= rest_until_ && (in.route != 0 || in.start_blocked)) {
        progress_ = ProgressChecker();
        nearest_ = in.left;
        nearest_since_ = driven_s_;
        replans_ = 0;
        if (in.start_blocked && in.route == 0) nudged_ = false;
        enter(RecoveryState::drive, in);
      }
      break;
  }
  return state_;
}

}  // namespace adit::nav
