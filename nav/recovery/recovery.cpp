// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/recovery.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

// Notes since when a condition holds, s.
void note(std::optional<double>& since, bool holds, double now_s) {
  if (!holds)
    since.reset();
  else if (!since)
    since = now_s;
}

}  // namespace

void Recovery::enter(RecoveryState state, const RecoveryInput& in) {
  state_ = state;
  since_ = in.stamp_s;
  from_ = in.at;
  blocked_since_.reset();
  free_since_.reset();
  if (state == RecoveryState::nudge || state == RecoveryState::back_up || state == RecoveryState::replan)
    spent_at_ = in.at;
  if (state == RecoveryState::nudge) nudged_ = true;
  if (state == RecoveryState::back_up) backed_up_ = true;
  if (state == RecoveryState::replan) answered_ = false;
}

void Recovery::give_up(Reason reason, const RecoveryInput& in) {
  enter(RecoveryState::give_up, in);
  retries_ = false;
  if (!in.blocked && !in.held) cause_ = Cause::none;
  reason_ = reason == Reason::blocked && side_ != Side::none ? Reason::start_in_collision : reason;
  rest_until_ = in.stamp_s + params_.rests * std::exp2(std::min(rests_, params_.doublings));
  ++rests_;
}

Target Recovery::target(Target target) {
  if (target.kind == Target::Kind::goal)
    last_ = target;
  else if (gave_up())
    target = last_;
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
  ask_ = RouteAsk::around;
  enter(RecoveryState::replan, in);
}

// There is nothing to follow: the robot waits for the router, or leaves ground that it found impassable.
void Recovery::look_without_route(const RecoveryInput& in) {
  const double lasts = in.stamp_s - *no_route_since_;
  if (in.unreachable) return give_up(Reason::goal_unreachable, in);
  if (!in.start_blocked) return lasts >= params_.reported ? give_up(Reason::blocked, in) : void();
  if (lasts < params_.blocked || state_ == RecoveryState::nudge) return;
  if (nudged_) return give_up(Reason::start_in_collision, in);
  enter(RecoveryState::nudge, in);
}

// Changes the state by what the last plan and the router found.
void Recovery::step(const RecoveryInput& in, bool other_route) {
  const double now = in.stamp_s, lasts = now - since_;
  const bool blocked = blocked_since_ && now - *blocked_since_ >= (in.held ? 0.0 : params_.blocked);
  const bool free = free_since_ && now - *free_since_ >= params_.blocked;
  const bool fails = lasts > 0 && (in.blocked || (in.held && lasts >= params_.held));
  const bool passes_by = in.cause == Cause::mover || in.cause == Cause::peer;
  switch (state_) {
    case RecoveryState::drive:
      if (blocked) passes_by ? enter(RecoveryState::wait, in) : try_next(in);
      break;
    case RecoveryState::wait:
      if (!blocked_since_) {
        enter(RecoveryState::drive, in);
      } else if (!passes_by) {
        if (now - *blocked_since_ >= params_.blocked) try_next(in);
      } else {
        blocked_since_ = now;
        if (lasts < params_.waits) break;
        ask_ = RouteAsk::around_if_found;
        since_ = now;
      }
      break;
    case RecoveryState::nudge:
      side_ = in.side;
      if (lasts >= params_.nudges || fails || (lasts > 0 && !in.nudge)) enter(RecoveryState::drive, in);
      break;
    case RecoveryState::back_up:
      if ((in.at - from_).norm() >= params_.backs_up || lasts >= params_.backs_up_for || fails)
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
      if (other_route && reason_ != Reason::stuck) {
        hindered_since_.reset();
        enter(RecoveryState::drive, in);
      } else if (free && in.route == 0) {
        ask_ = RouteAsk::open;
        free_since_.reset();
      } else if (now >= rest_until_ && (in.route != 0 || in.start_blocked)) {
        progress_ = ProgressChecker();
        ends_ = ProgressChecker(params_.ends);
        replans_ = 0;
        retries_ = true;
        if (in.start_blocked && in.route == 0) nudged_ = false;
        enter(RecoveryState::drive, in);
      }
      break;
  }
}

RecoveryState Recovery::look(const RecoveryInput& in) {
  constexpr double kPause = 0.5;  // s: a longer interval was a pause.
  const double now = in.stamp_s;
  if (state_ == RecoveryState::drive && !in.stands) driven_s_ += std::clamp(now - last_s_, 0.0, kPause);
  last_s_ = now;
  if (in.goal != goal_) {
    goal_ = in.goal;
    route_ = 0;
    least_ = std::numeric_limits<double>::infinity();
    rests_ = 0;
    if (spent_at_ && (in.at - *spent_at_).norm() >= params_.elsewhere) restore();
    progress_ = ProgressChecker();
    ends_ = ProgressChecker(params_.ends);
    no_route_since_.reset();
    hindered_since_.reset();
    retries_ = false;
    cause_ = Cause::none;
    last_ = {};
    enter(RecoveryState::drive, in);
  }
  const bool follows = in.route != 0, other_route = follows && in.route != route_;
  const bool longer = other_route && in.left > least_ + params_.progress;
  route_ = in.route;
  if (other_route) {
    least_ = in.left;
  } else if (follows && in.left < least_ - params_.progress) {
    least_ = in.left;
    hindered_since_.reset();
    retries_ = false;
    if (!spent_at_ || (in.at - *spent_at_).norm() >= params_.elsewhere) restore();
  }
  // Near the goal a robot that moves and comes no nearer has ended: the goal lies in or behind something.
  if (in.left > params_.near) ends_ = ProgressChecker(params_.ends);
  const bool stuck = follows && progress_.stuck(in.left, longer, driven_s_);
  const bool ended = follows && ends_.stuck(in.left, false, driven_s_);

  const bool hindered = in.blocked || in.held;
  const bool waits = state_ == RecoveryState::drive || state_ == RecoveryState::wait;
  if (hindered && waits) cause_ = in.cause, cause_ahead_ = in.cause_ahead;
  if (hindered && !hindered_since_) hindered_since_ = now;
  note(clear_since_, !hindered, now);
  const bool clear = clear_since_ && now - *clear_since_ >= params_.blocked && waits && !spent_at_;
  if (clear || in.stands) hindered_since_.reset();
  note(blocked_since_, hindered, now);
  note(free_since_, !hindered && in.ends_at_goal, now);
  note(no_route_since_, !follows, now);
  const bool searches = !follows && !gave_up() && state_ != RecoveryState::replan;
  const bool nudges = state_ == RecoveryState::nudge;
  if (searches) look_without_route(in);
  if (stuck && state_ == RecoveryState::drive)
    give_up(Reason::stuck, in);
  else if (ended && state_ == RecoveryState::drive)
    give_up(Reason::blocked, in);
  else if (!searches || (nudges && state_ == RecoveryState::nudge))
    step(in, other_route);
  if (!gave_up() && !retries_) {
    const bool reported = hindered_since_ && now - *hindered_since_ >= params_.reported;
    reason_ = reported ? Reason::blocked : Reason::none;
  }
  return state_;
}

}  // namespace adit::nav
