#include "robot_agent/behaviour/behaviour.hpp"

#include <cmath>

namespace adit::agent {

Behaviour::Behaviour(BehaviourParams params, std::unique_ptr<Decider> decider, Mux& mux, Inputs inputs,
                     Outputs outputs)
    : params_(params),
      decider_(std::move(decider)),
      mux_(mux),
      inputs_(std::move(inputs)),
      outputs_(std::move(outputs)),
      manual_(mux.connect("manual", Stick::kFresh)),
      smart_(mux.connect("smart_joystick", Stick::kFresh)),
      waypoint_(mux.connect("waypoint", params.goal_age)),
      decision_{&guard_.admitted(), false, Reason::none} {}

Facts Behaviour::facts(Time now) const {
  Facts f = inputs_.sense(now);
  f.stopped = stopped_;
  f.stick_fresh = stick_.fresh(now);
  f.stick_kept = stick_.kept(now);
  f.stick_centred = stick_.centred() || params_.defects.has(Defect::enter_off_centre);
  f.goal_known = goal_.known;
  f.goal_free = !goal_.known || inputs_.goal_free(goal_.place.head<2>());
  return f;
}

Result<void> Behaviour::refuse(Reason reason, std::string_view mode) const {
  return {reason, std::string(mode) + ": " + std::string(describe(reason))};
}

Reason Behaviour::not_run(const ModeRow& row) const {
  if (&row == &mode_table().front()) return Reason::none;
  if (!decider_->refusal().empty()) return Reason::tree_refused;
  return decider_->installed(row) ? Reason::none : Reason::mode_not_installed;
}

Result<void> Behaviour::request_mode(const std::string& mode, Time now) {
  const ModeRow* row = find_mode(mode);
  if (!row)
    return refuse(known_but_not_installed(mode) ? Reason::mode_not_installed : Reason::mode_unknown, mode);
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, mode);
  if (const Reason reason = guard_.admit(*row, Commander::holder, facts(now)); reason != Reason::none)
    return refuse(reason, mode);
  return enter(*row, now);
}

Result<void> Behaviour::request_goal(const Eigen::Vector3d& goal, Time now) {
  const ModeRow& row = *find_mode("waypoint");
  // z is NaN where none was given.
  if (!std::isfinite(goal.x()) || !std::isfinite(goal.y()) || std::isinf(goal.z()) ||
      std::hypot(goal.x(), goal.y()) > params_.farthest_goal)
    return {Reason::out_of_range, "goto: the goal is no place within 10 km"};
  if (const Reason reason = not_run(row); reason != Reason::none) return refuse(reason, "goto");
  Facts f = facts(now);
  f.goal_known = true;
  f.goal_free = inputs_.goal_free(goal.head<2>());
  const Reason reason = guard_.admit(row, Commander::holder, f);
  if (reason != Reason::none) return refuse(reason, "goto");
  const bool given = !std::isnan(goal.z()), on_floor = !given && !inputs_.height;
  const double height = given ? goal.z() : on_floor ? 0.0 : inputs_.height();
  goal_ = {true, false, goal_.id + 1, {goal.x(), goal.y(), height}, on_floor};
  progress_ = {};
  return enter(row, now);
}

Result<void> Behaviour::set_pose(const Pose2& pose, Time now) {
  const ModeRow* hold = &mode_table().front();
  if (&guard_.admitted() != hold || decision_.mode != hold)
    return {Reason::wrong_mode, "pose: only a robot in hold is told where it is"};
  if (!std::isfinite(pose.yaw) || !(std::hypot(pose.x, pose.y) <= params_.farthest_goal))
    return {Reason::out_of_range, "pose: expected a place within 10 km and a heading in radians"};
  if (const auto done = inputs_.set_pose(pose); !done) return done;
  if (fell_because_ == Reason::odometry_jumped) fell_because_ = Reason::none;
  tick(now);
  return {};
}

Result<void> Behaviour::enter(const ModeRow& row, Time now) {
  if (row.accepts != Accepts::goal) goal_ = {false, false, goal_.id, Eigen::Vector3d::Zero(), false};
  listens_ = false;
  fell_because_ = Reason::none;
  idle_told_ = blocked_told_ = false;
  idle_since_ = free_since_ = now;
  tick(now);
  return decision_.mode == &row ? Result<void>{} : refuse(decision_.reason, row.name);
}

void Behaviour::stop_changed(bool stopped, Time now) {
  stopped_ = stopped;
  tick(now);
}

void Behaviour::holder_changed(Time now) {
  if (params_.defects.has(Defect::manual_survives_handover)) return;
  stick_.forget();
  idle_since_ = now;
  idle_told_ = false;
  if (guard_.holder_changed()) fell_because_ = Reason::not_holder;
  tick(now);
}

void Behaviour::holder_restarted(Time now) {
  if (params_.defects.has(Defect::manual_survives_handover)) return;
  // A stick that is held pushed across the restart must not go on by itself: manual modes fall to hold.
  stick_.forget();
  tick(now);
}

Result<void> Behaviour::stick(const Twist2& twist, Time now) {
  stick_.update(twist, now);
  if (params_.defects.has(Defect::two_sources) && !decision_.mode->manual())
    manual_.write(Velocity{twist}, now);
  if (!decision_.mode->manual())
    return twist.zero() ? Result<void>{} : refuse(Reason::wrong_mode, decision_.mode->name);
  if (decision_.mode->name == "manual")
    manual_.write(Velocity{twist}, now);
  else
    smart_.write(Guidance{twist}, now);
  return {};
}

void Behaviour::resume_goal(Time now) {
  if (!goal_.known) return;
  guard_.readmit(*find_mode("waypoint"));
  tick(now);
}

void Behaviour::hold(Reason reason, Time now) {
  guard_.hold();
  fell_because_ = reason;
  idle_since_ = now;
  tick(now);
}

KeptBehaviour Behaviour::kept() const {
  return {std::string(guard_.admitted().name),
          fell_because_,
          goal_.known,
          goal_.reached,
          goal_.id,
          goal_.place,
          goal_.on_floor};
}

void Behaviour::restore(const KeptBehaviour& kept, bool stopped, bool resume, bool listens) {
  const ModeRow* row = find_mode(kept.mode);
  const bool autonomous = row && row->accepts == Accepts::goal && kept.goal_known;
  goal_ = {kept.goal_known, kept.goal_reached, kept.goal_id, kept.goal, kept.goal_on_floor};
  guard_.readmit(autonomous && resume ? *row : mode_table().front());
  fell_because_ = kept.reason;
  stopped_ = stopped;
  listens_ = listens;
}

void Behaviour::go_on(Time now) {
  listens_ = false;
  tick(now);
}

void Behaviour::tick(Time now) {
  if (!begun_) idle_since_ = free_since_ = now;
  begun_ = true;
  const ModeRow& requested = guard_.admitted();
  const Facts f = facts(now);
  decision_ = guard_.judge(decider_->decide(requested.name, f, now), f);
  if (listens_ && decision_.runs) {
    decision_.runs = false;
    decision_.reason = Reason::just_restarted;
  }
  if (decision_.mode != &requested) fall(requested, decision_);
  mux_.enable(decision_.runs ? decision_.mode->name : std::string_view{}, now);
  feed_waypoint(now);
  watch(now);
  if (const BehaviourView is = view(); is != told_) {
    told_ = is;
    outputs_.changed();
  }
}

void Behaviour::fall(const ModeRow& from, const Decision& decision) {
  fell_because_ = decision.reason;
  const std::string text = std::string(from.name) + " ended: " + std::string(describe(decision.reason));
  if (decision.reason == Reason::stopped) return;  // who stopped it was told already
  const bool stale = decision.reason == Reason::joystick_stale;
  if (stale && stick_.centred())  // the last that was heard of it: it was let go, and nothing was moving
    return outputs_.tell_holder({{}, Severity::info, "mode_changed", decision.reason, text});
  outputs_.tell_holder(
      {{}, Severity::warning, stale ? "joystick_lost" : "mode_changed", decision.reason, text});
}

void Behaviour::feed_waypoint(Time now) {
  if (decision_.mode->accepts != Accepts::goal || !goal_.known) return;
  if (progress_.arrived && !goal_.reached && decision_.runs) {
    goal_.reached = true;
    idle_since_ = now;
    outputs_.tell_holder({{}, Severity::info, "arrived", Reason::none, "goal reached"});
  }
  if (goal_.reached)
    waypoint_.write(Stand{}, now);
  else
    waypoint_.write(GoTo{{goal_.place.x(), goal_.place.y(), goal_.on_floor ? std::nan("") : goal_.place.z()}},
                    now);
}

void Behaviour::watch(Time now) {
  const bool waits = decision_.mode == &mode_table().front() || goal_state() == GoalState::reached;
  if (!waits) idle_since_ = now;
  if (waits && !idle_told_ && now - idle_since_ >= params_.idle_after) {
    idle_told_ = true;
    outputs_.tell_holder(
        {{}, Severity::info, "idle", Reason::none, "idle in " + std::string(decision_.mode->name)});
  }
  const bool unreachable = goal_state() == GoalState::blocked && progress_.unreachable;
  if (unreachable && !unreachable_told_)
    outputs_.tell_holder(
        {{}, Severity::warning, "unreachable", Reason::goal_unreachable, "no way leads to the goal"});
  unreachable_told_ = unreachable;
  if (goal_state() != GoalState::blocked || unreachable) {
    free_since_ = now;
    blocked_told_ = false;
  } else if (!blocked_told_ && now - free_since_ >= params_.blocked_after) {
    blocked_told_ = true;
    outputs_.tell_holder(
        {{}, Severity::warning, "blocked", Reason::blocked, "every path to the goal is blocked"});
  }
}

GoalState Behaviour::goal_state() const {
  if (!goal_.known) return GoalState::none;
  if (goal_.reached) return GoalState::reached;
  if (decision_.mode->accepts != Accepts::goal || !decision_.runs) return GoalState::kept;
  return progress_.blocked ? GoalState::blocked : GoalState::active;
}

BehaviourView Behaviour::view() const {
  BehaviourView v;
  v.mode = decision_.mode->name;
  v.stopped = stopped_;
  v.moving_allowed = decision_.runs && decision_.mode->accepts != Accepts::nothing;
  v.goal_state = goal_state();
  v.goal_id = goal_.id;
  v.goal = goal_.place;
  v.reason = stopped_ ? Reason::stopped
             : v.goal_state == GoalState::blocked
                 ? (progress_.unreachable ? Reason::goal_unreachable : Reason::blocked)
             : v.moving_allowed                 ? Reason::none
             : decision_.reason != Reason::none ? decision_.reason
                                                : fell_because_;
  return v;
}

std::vector<ModeOption> Behaviour::options(Time now) const {
  const Facts f = facts(now);
  std::vector<ModeOption> all;
  for (const ModeRow& row : mode_table()) {
    const Reason reason = not_run(row);
    all.push_back({row.name, reason != Reason::none ? reason : entry_refusal(row, f)});
  }
  return all;
}

}  // namespace adit::agent
