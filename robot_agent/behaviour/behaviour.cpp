// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/behaviour.hpp"

#include <cmath>

namespace adit::agent {
namespace {

constexpr const char* kGetOut = "get_out";

}  // namespace

Behaviour::Behaviour(BehaviourParams params, std::unique_ptr<Decider> decider, Mux& mux, Inputs inputs,
                     Outputs outputs)
    : params_(params),
      decider_(std::move(decider)),
      mux_(mux),
      inputs_(std::move(inputs)),
      outputs_(std::move(outputs)),
      guard_(table()),
      decision_{&guard_.admitted(), false, Reason::none},
      running_(decision_.mode),
      interrupted_(decision_.mode) {
  reported_.mode = std::string(running_->name);
  // Modules may ask for the pose at any time.
  if (!inputs_.pose) inputs_.pose = [] { return std::optional<Pose2>{}; };
  if (!inputs_.stopping) inputs_.stopping = [] { return 0.0; };
  for (const ModeRow& row : table().rows()) {
    Mode& mode = modes_.emplace_back(Mode{row});
    if (row.moves())
      mode.module =
          row.make({mux_.connect(std::string(row.name), row.output_lifetime), outputs_.notify_holder,
                    inputs_.goal_free, inputs_.height, inputs_.pose, inputs_.stopping, inputs_.convoy,
                    inputs_.right_of_way, inputs_.explore, inputs_.holder_heard, inputs_.home});
  }
}

ModeModule* Behaviour::module(const ModeRow& row) const {
  for (const Mode& mode : modes_)
    if (&mode.row == &row) return mode.module.get();
  return nullptr;
}

Facts Behaviour::facts(Time now) const {
  Facts f = inputs_.sense(now);
  f.stopped = stopped_;
  f.stick_fresh = stick_.fresh(now);
  f.stick_present = stick_.present(now);
  f.stick_centred = stick_.centred();
  for (const Mode& mode : modes_)
    if (mode.module) mode.module->note(f, now);
  return f;
}

Result<void> Behaviour::refuse(Reason reason, std::string_view mode) const {
  return {reason, std::string(mode) + ": " + std::string(describe(reason))};
}

Reason Behaviour::not_run(const ModeRow& row) const {
  if (&row == &table().hold()) return Reason::none;
  if (!decider_->refusal().empty()) return Reason::tree_refused;
  const bool is_installed = decider_->installed(row) && (module(row) || !row.moves());
  return is_installed ? Reason::none : Reason::mode_not_installed;
}

Result<void> Behaviour::request_mode(const std::string& mode, Time now) {
  const ModeRow* row = table().find(mode);
  if (!row) return refuse(Reason::mode_unknown, mode);
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, mode);
  if (row->accepts == Accepts::goal && module(*row)) {
    const ModeProgress stored = module(*row)->progress(false);
    if (stored.state != GoalState::none && !is_permitted(stored.goal))
      return refuse(Reason::outside_area, mode);
  }
  if (const Reason reason = guard_.admit(*row, Commander::holder, facts(now)); reason != Reason::none)
    return refuse(reason, mode);
  count_request();
  return enter(*row, now);
}

Result<void> Behaviour::request_goal(const Eigen::Vector3d& goal, Commander by, Time now) {
  const ModeRow* row = table().find_by_input(Accepts::goal);
  ModeModule* driver = row ? module(*row) : nullptr;
  if (!driver) return refuse(Reason::mode_not_installed, "goto");
  Facts f = facts(now);
  if (const auto checked = driver->check_goal(goal, f); !checked) return checked;
  if (!is_permitted(goal)) return refuse(Reason::outside_area, "goto");
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, "goto");
  if (const Reason reason = guard_.admit(*row, by, f); reason != Reason::none) return refuse(reason, "goto");
  if (by == Commander::holder) count_request();
  driver->set_goal(goal);
  return enter(*row, now);
}

Result<void> Behaviour::request_explore(const ExploreRequest& request, Time now) {
  const ModeRow* row = table().find("explore");
  if (!row) return refuse(Reason::mode_not_installed, "explore");
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, "explore");
  if (!request.area.empty())
    if (const auto area = check_explored_area(request.area); !area) return area;
  if (const Reason reason = guard_.admit(*row, Commander::holder, facts(now)); reason != Reason::none)
    return refuse(reason, "explore");
  count_request();
  module(*row)->set_exploration(request);
  return enter(*row, now);
}

void Behaviour::limit_unknown(double metres) {
  if (ModeModule* current = module(*decision_.mode)) current->limit_unknown(metres);
}

Result<void> Behaviour::set_pose(const Pose2& pose, Time now) {
  const ModeRow* hold = &table().hold();
  if (&guard_.admitted() != hold || decision_.mode != hold)
    return {Reason::wrong_mode, "pose: only a robot in hold is told where it is"};
  if (!std::isfinite(pose.yaw) || !(std::hypot(pose.x, pose.y) <= kFarthestPlace))
    return {Reason::out_of_range, "pose: expected a place within 10 km and a heading in radians"};
  if (const auto done = inputs_.set_pose(pose); !done) return done;
  if (fell_because_ == Reason::odometry_jumped || fell_because_ == Reason::not_localised_here)
    fell_because_ = Reason::none;
  tick(now);
  return {};
}

bool Behaviour::is_permitted(const Eigen::Vector3d& goal) const {
  return areas_.empty() || !inputs_.goal_permitted || inputs_.goal_permitted(areas_, goal);
}

Result<void> Behaviour::check_explored_area(const std::string& name) const {
  const nav::Area* area = areas_.find(name);
  if (!area) return {Reason::bad_argument, "explore: there is no area " + name};
  if (!areas_.leaves_room(*area))
    return {Reason::outside_area, "explore: the robot's areas forbid all of " + name};
  return {};
}

Result<void> Behaviour::add_area(const nav::Area& area, Time now) {
  const auto valid = nav::checked(area);
  if (!valid) return valid.error();
  nav::AreaSet areas = areas_;
  if (const auto added = areas.add(*valid); !added) return added;
  // All areas to keep in are one piece of ground; another kind is judged alone.
  const nav::AreaSet judged = areas.only([&](const nav::Area& a) {
    return valid->kind == nav::AreaKind::keep_in ? a.kind == valid->kind : a.name == valid->name;
  });
  if (inputs_.body_permitted && !inputs_.body_permitted(judged))
    return {Reason::outside_area, "area " + area.name + ": it would forbid the place of the robot"};
  areas_ = areas;
  tick(now);
  return {};
}

Result<void> Behaviour::remove_area(const std::string& name, Time now) {
  if (!areas_.remove(name)) return {Reason::bad_argument, "there is no area " + name};
  tick(now);
  return {};
}

Result<void> Behaviour::enter(const ModeRow& row, Time now) {
  if (running_ == &row) ++modes_begun_;  // With another goal, for example.
  change_to(row, now);
  for (const Mode& mode : modes_)
    if (mode.module && &mode.row != &row && mode.row.goal == GoalOnLeaving::cleared) mode.module->clear();
  if (ModeModule* entered = module(row)) entered->enter(now);
  listens_ = false;
  fell_because_ = Reason::none;
  idle_reported_ = false;
  idle_since_ = now;
  tick(now);
  return decision_.mode == &row ? Result<void>{} : refuse(decision_.reason, row.name);
}

void Behaviour::change_to(const ModeRow& row, Time now) {
  if (running_ == &row) return;
  ++modes_begun_;
  if (ModeModule* left = module(*running_)) left->leave(now);
  running_ = &row;
  recovery_ = contract::RecoveryState::drive;
}

void Behaviour::count_request() {
  ++holder_requests_;
  if (inputs_.right_of_way) inputs_.right_of_way->holder_requested();
}

Result<void> Behaviour::allow_yield(bool allowed, Time now) {
  const ModeRow* row = table().find(kGetOut);
  if (!inputs_.right_of_way || !row) return refuse(Reason::mode_not_installed, "yield");
  if (const Reason reason = not_run(*row); allowed && reason != Reason::none) return refuse(reason, "yield");
  if (const auto done = inputs_.right_of_way->allow(allowed, now); !done) return done;
  tick(now);
  return {};
}

Result<void> Behaviour::clear_way(Time now) {
  const ModeRow* row = table().find(kGetOut);
  if (!row) return refuse(Reason::mode_not_installed, kGetOut);
  const ModeRow& before = guard_.admitted();
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, kGetOut);
  if (const Reason reason = guard_.admit(*row, Commander::agent, facts(now)); reason != Reason::none)
    return refuse(reason, kGetOut);
  if (&before != row) interrupted_ = &before;
  change_to(*row, now);  // The goals of the other modes stay.
  module(*row)->enter(now);
  tick(now);
  return {};
}

void Behaviour::resume(Time now) {
  if (guard_.admitted().name != kGetOut) return;
  guard_.readmit(*interrupted_);
  const ModeRow& row = guard_.admitted();
  change_to(row, now);
  if (ModeModule* entered = module(row)) entered->enter(now);
  idle_since_ = now;
  tick(now);
}

bool Behaviour::drives() const {
  if (!decision_.runs || !decision_.mode->autonomous()) return false;
  return decision_.mode->accepts != Accepts::goal || progress().state != GoalState::reached;
}

Progress Behaviour::clearing() const {
  const ModeRow* row = table().find(kGetOut);
  const ModeModule* driver = row ? module(*row) : nullptr;
  return driver && decision_.mode == row ? driver->progress(decision_.runs).navigation : Progress{};
}

void Behaviour::stop_changed(bool stopped, Time now) {
  stopped_ = stopped;
  if (RightOfWay* way = inputs_.right_of_way) stopped ? way->stopped() : way->reset();
  if (!stopped && fell_because_ == Reason::stopped) fell_because_ = Reason::none;
  tick(now);
}

Result<void> Behaviour::join_convoy(const ConvoyOrder& order, Time now) {
  const ModeRow* row = table().find("convoy_follow");
  if (!inputs_.convoy || !row) return refuse(Reason::mode_not_installed, "convoy");
  if (const Reason reason = not_run(*row); reason != Reason::none) return refuse(reason, "convoy");
  const auto before = inputs_.convoy->role();
  if (const auto started = inputs_.convoy->start(order); !started) return started;
  const bool leads = inputs_.convoy->leads();
  const Facts f = facts(now);
  const Reason leader_reason = f.stopped ? Reason::stopped : f.localised ? Reason::none : f.unlocalised;
  const Reason reason = leads ? leader_reason : guard_.admit(*row, Commander::holder, f);
  if (reason != Reason::none) {
    inputs_.convoy->set_role(before);
    return refuse(reason, "convoy");
  }
  count_request();
  if (!leads) return enter(*row, now);
  tick(now);  // The leader stays in its mode.
  return {};
}

Result<void> Behaviour::leave_convoy(Time now) {
  if (!inputs_.convoy) return refuse(Reason::not_in_convoy, "convoy");
  const bool followed = guard_.admitted().name == "convoy_follow";
  if (const auto left = inputs_.convoy->leave(); !left) return left;
  if (followed) return request_mode(std::string(table().hold().name), now);
  tick(now);
  return {};
}

void Behaviour::holder_changed(Time now) {
  // The order to follow was the former holder's (rule 8).
  if (inputs_.convoy) (void)inputs_.convoy->leave();
  if (inputs_.right_of_way) inputs_.right_of_way->holder_changed();
  stick_.forget();
  idle_since_ = now;
  idle_reported_ = false;
  if (guard_.holder_changed()) fell_because_ = Reason::not_holder;
  tick(now);
}

void Behaviour::holder_restarted(Time now) {
  // A stick that stays pushed across the restart must not continue to move the robot: manual modes fall to
  // hold.
  stick_.forget();
  tick(now);
}

Result<void> Behaviour::stick(const Twist2& twist, Time now) {
  stick_.update(twist, now);
  if (!decision_.mode->manual())
    return twist.zero() ? Result<void>{} : refuse(Reason::wrong_mode, decision_.mode->name);
  if (ModeModule* current = module(*decision_.mode)) current->steer(twist, now);
  return {};
}

void Behaviour::program(const Twist2& velocity, Time now) {
  for (const Mode& mode : modes_)
    if (mode.row.accepts == Accepts::program && mode.module) mode.module->steer(velocity, now);
}

void Behaviour::set_progress(const Progress& progress) {
  static_assert(static_cast<int>(contract::RecoveryState::give_up) ==
                static_cast<int>(nav::RecoveryState::give_up));
  recovery_ = static_cast<contract::RecoveryState>(progress.recovery);
  if (ModeModule* current = module(*decision_.mode)) current->navigated(progress);
}

void Behaviour::hold(Reason reason, Time now) {
  guard_.hold();
  fell_because_ = reason;
  idle_since_ = now;
  tick(now);
}

StoredBehaviour Behaviour::stored() const {
  StoredBehaviour stored{};
  const ModeRow& admitted = guard_.admitted();
  stored.mode = admitted.name == kGetOut ? interrupted_->name : admitted.name;
  stored.reason = fell_because_;
  stored.areas = areas_;
  for (const Mode& mode : modes_)
    if (mode.module) mode.module->store(stored);
  return stored;
}

void Behaviour::restore(const StoredBehaviour& stored, bool stopped, bool resume, bool listens) {
  for (const Mode& mode : modes_)
    if (mode.module) mode.module->restore(stored);
  const ModeRow* row = table().find(stored.mode);
  guard_.readmit(row && resume ? *row : table().hold());
  running_ = &guard_.admitted();
  fell_because_ = stored.reason;
  areas_ = stored.areas;
  stopped_ = stopped;
  listens_ = listens;
}

void Behaviour::go_on(Time now) {
  listens_ = false;
  tick(now);
}

void Behaviour::tick(Time now) {
  if (!begun_) idle_since_ = now;
  begun_ = true;
  const ModeRow& requested = guard_.admitted();
  const Facts f = facts(now);
  decision_ = guard_.judge(decider_->decide(requested.name, f, now), f);
  if (listens_ && decision_.runs) {
    decision_.runs = false;
    decision_.reason = Reason::just_restarted;
  }
  if (decision_.mode != &requested) fall(requested, decision_.reason);
  change_to(*decision_.mode, now);
  const bool passes = decision_.runs && decision_.mode->moves();
  mux_.enable(passes ? decision_.mode->name : std::string_view{}, now);
  if (ModeModule* current = module(*decision_.mode)) {
    current->tick(passes, now);
    if (current->progress(passes).finished) return hold(Reason::none, now);
  }
  watch(now);
  contract::BehaviourState is = view();
  // The numbers of an exploration change with every scan; they are sent once a second.
  is.exploration = {.phase = is.exploration.phase, .reason = is.exploration.reason};
  if (is != reported_) {
    reported_ = is;
    outputs_.changed();
  }
}

void Behaviour::fall(const ModeRow& from, Reason reason) {
  fell_because_ = reason;
  if (reason == Reason::stopped) return;  // The stopping operator was already notified.
  const std::string text = std::string(from.name) + " ended: " + std::string(describe(reason));
  const bool stale = reason == Reason::joystick_stale;
  // The last sample was centred: the stick was released, and the robot did not move.
  if (stale && stick_.centred()) {
    fell_because_ = Reason::none;
    return outputs_.notify_holder(Severity::info, "mode_changed", reason, text);
  }
  outputs_.notify_holder(Severity::warning, stale ? "joystick_lost" : "mode_changed", reason, text);
}

void Behaviour::watch(Time now) {
  const bool waits = decision_.mode == &table().hold() || progress().state == GoalState::reached;
  if (!waits) idle_since_ = now;
  if (!waits || idle_reported_ || now - idle_since_ < params_.idle_after) return;
  idle_reported_ = true;
  outputs_.notify_holder(Severity::info, "idle", Reason::none,
                         "idle in " + std::string(decision_.mode->name));
}

// Returns the goal of the mode, otherwise one that another mode stores.
ModeProgress Behaviour::progress() const {
  ModeProgress best{};
  for (const Mode& mode : modes_) {
    if (!mode.module) continue;
    const bool current = &mode.row == decision_.mode;
    const ModeProgress p = mode.module->progress(current && decision_.runs);
    if (current && p.state != GoalState::none) return p;
    if (best.state == GoalState::none && (p.state != GoalState::none || best.goal_id == 0)) best = p;
  }
  return best;
}

contract::BehaviourState Behaviour::view() const {
  const ModeProgress p = progress();
  contract::BehaviourState v;
  v.mode = decision_.mode->name;
  v.stopped = stopped_;
  v.moving_allowed = decision_.runs && decision_.mode->moves();
  if (v.moving_allowed && decision_.mode->autonomous() && p.state != GoalState::reached)
    v.recovery = recovery_;
  v.goal_state = p.state;
  v.goal_id = p.goal_id;
  v.goal = p.goal;
  v.areas.assign(areas_.all().begin(), areas_.all().end());
  if (inputs_.convoy) v.convoy = inputs_.convoy->order();
  if (const RightOfWay* way = inputs_.right_of_way) {
    v.yields = way->allowed();
    v.yields_to = way->yields_to();
  }
  for (const Mode& mode : modes_)
    if (mode.module && v.exploration.phase == contract::ExplorationPhase::none)
      v.exploration = mode.module->progress(false).exploration;
  v.reason = stopped_                           ? Reason::stopped
             : p.state == GoalState::blocked    ? p.reason
             : v.moving_allowed                 ? Reason::none
             : decision_.reason != Reason::none ? decision_.reason
                                                : fell_because_;
  return v;
}

std::vector<contract::ModeOption> Behaviour::options(Time now) const {
  const Facts f = facts(now);
  std::vector<contract::ModeOption> all;
  for (const ModeRow& row : table().rows()) {
    Reason reason = not_run(row);
    if (reason == Reason::none) reason = entry_refusal(row, f);
    all.push_back({std::string(row.name), reason == Reason::none, reason});
  }
  return all;
}

}  // namespace adit::agent
