// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/navigation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "nav/routing/known_stairs.hpp"

namespace adit::agent {
namespace {

// Time over which a stick's turn rate shifts the requested direction, s.
constexpr double kTurnLooksAhead = 0.6;
constexpr double kTurningSpeed = 0.05;    // Speed for a stick that only turns, m/s.
constexpr Duration kAnswerDeadline = 2s;  // Of planner and router; one that hangs is replaced earlier.
constexpr double kBorderRange = 5.0;      // Of the areas' border that planner and monitor see, m.
constexpr double kRestsOff = 0.01;        // Of a robot that moves only by the noise of its odometry, m.
constexpr double kGoalMoved = 0.05;       // Shift of the goal by a correction of the map, m.
constexpr double kCrawls = 0.05;          // A robot with a lower speed limit is to stand, m/s.
constexpr double kAtHeight = 0.2;         // Greatest error of the height of a goal, m.
constexpr double kTolerance = 0.25;       // Of the planners, m.
constexpr double kTurned = 0.15;          // Greatest error of a heading that was asked for, rad.

}  // namespace

/// The detector, which the jobs of one lane use.
struct Navigation::Detection {
  nav::ObstacleDetector detector;
  std::uint32_t epoch{};  ///< Of the scans that it remembers.
};

Navigation::Navigation(NavigationParams params, Executor& strand, Log log, const Frames& frames,
                       const PlanService& planner, const RouteServices* router, Outputs outputs)
    : Component("navigation", strand, std::move(log)),
      params_(std::move(params)),
      frames_(frames),
      planner_(planner),
      router_(router),
      outputs_(std::move(outputs)),
      controller_(nav::make_controller(params_.platform.controller, params_.platform).value()),
      monitor_(params_.platform),
      detection_(new Detection{monitor_.make_detector()}),
      fence_(params_.platform) {}

void Navigation::accept(MuxKey, const Motion& motion, Time now) {
  const bool other_kind = motion.index() != motion_.index();
  const auto* go = std::get_if<GoTo>(&motion);
  const auto* before = std::get_if<GoTo>(&motion_);
  const bool same_number = go && before && go->id == before->id;
  if (motion == motion_ && (!go || same_number)) return;
  const bool same_goal = same_number && go->id != 0;
  if (!same_goal) {
    const bool continues = go && before && go->continues && step_on(now);
    if (go) {
      ++goal_generation_;
      outputs_.progress({});  // What was reported of the goal before says nothing about this one.
    }
    if (continues)
      continued_ = now;
    else
      step_.reset();
    ask_ = nav::RouteAsk::none;
    held_.clear();
  }
  motion_ = motion;
  update_fence(now);
  if (other_kind) {
    has_plan_ = false;
    controller_->stop_now();
  }
  if (const auto* velocity = std::get_if<Velocity>(&motion_))
    pass_on(*velocity);
  else if (std::holds_alternative<Stand>(motion_))
    send({});
}

void Navigation::clear() {
  controller_->stop_now();
  has_plan_ = false;
  step_.reset();
  recovery_.clear();
  held_.clear();
  monitor_.clear();
  ++scan_epoch_;
  waiting_.reset();
  scanned_.reset();
  mapped_.reset();
  local_map_.reset();
}

void Navigation::send(const Twist2& velocity) {
  // The robot does not follow a new velocity immediately.
  const double since = seconds(now() - sent_at_);
  sent_at_ = now();
  sent_speed_ =
      std::max(std::hypot(velocity.vx, velocity.vy), sent_speed_ - params_.platform.max_acceleration * since);
  outputs_.velocity(velocity);
}

bool Navigation::is_bound() const {
  const auto* velocity = std::get_if<Velocity>(&motion_);
  return std::holds_alternative<GoTo>(motion_) || (velocity && velocity->by_program);
}

void Navigation::update_fence(Time now) {
  if (areas_.empty() && fence_.empty()) return;
  fence_.update(areas_, frames_, place_sigma_, is_bound());
  monitor_.set_border(is_bound() ? fence_.border(frames_, kBorderRange) : std::vector<Eigen::Vector2f>{});
  if (!fence_.is_obeyed() && !std::holds_alternative<Stand>(motion_)) warn(Warning::outside_area, now);
}

void Navigation::step(Time now) {
  update_fence(now);
  if (const auto* velocity = std::get_if<Velocity>(&motion_))
    pass_on(*velocity);
  else if (std::holds_alternative<Stand>(motion_))
    send({});
  else
    send(along_plan(now));
}

nav::CollisionMonitor::Verdict Navigation::guarded(const Twist2& wanted,
                                                   nav::CollisionMonitor::Policy policy) const {
  Twist2 moves = frames_.twist();
  moves.vz = 0;
  if (!params_.platform.sideways()) moves.vy = 0;
  return monitor_.check(wanted, frames_.T_odom_base().planar(), seconds(now().time_since_epoch()), policy,
                        {moves, sent_speed_});
}

void Navigation::pass_on(const Velocity& wanted) {
  using Policy = nav::CollisionMonitor::Policy;
  const Policy by_hand = params_.platform.manual_collision_stop ? Policy::stop_seen : Policy::limit;
  const auto verdict = guarded(limited(wanted.twist), wanted.by_program ? Policy::stop : by_hand);
  watch_warning(verdict.cause, now());
  send(verdict.velocity);
}

void Navigation::watch_warning(nav::CollisionMonitor::Cause cause, Time now) {
  using Cause = nav::CollisionMonitor::Cause;
  if (cause == Cause::none) return;
  const Warning warning = cause == Cause::stale    ? Warning::lidar_silent
                          : cause == Cause::tilted ? Warning::tilted
                                                   : Warning::obstacle_near;
  warn(warning, now);
}

void Navigation::warn(Warning warning, Time now) {
  std::optional<Time>& last = warned_[static_cast<std::size_t>(warning)];
  if ((!last || now - *last > params_.warned_for) && outputs_.warn) outputs_.warn(warning);
  last = now;
}

Twist2 Navigation::along_plan(Time now) {
  const auto* guidance = std::get_if<Guidance>(&motion_);
  const bool centred = guidance && guidance->stick.zero();
  if (centred || !has_plan_ || now - plan_made_ > params_.plan_age || !frames_.alive(now))
    return controller_->stop_now();
  Twist2 wanted = controller_->follow(frames_.T_odom_base().planar(), seconds(params_.period));
  if (const double speed = std::hypot(wanted.vx, wanted.vy); speed > speed_limit_) {
    // All components alike, so that the path keeps its curvature.
    const double scale = speed_limit_ / speed;
    wanted = {scale * wanted.vx, scale * wanted.vy, scale * wanted.wz, wanted.vz};
    controller_->sent(wanted);
  }
  auto verdict = guarded(wanted, nav::CollisionMonitor::Policy::stop);
  if (verdict.cause == nav::CollisionMonitor::Cause::stopped && !guidance)
    verdict.velocity =
        monitor_.instead_of(wanted, frames_.T_odom_base().planar(), seconds(now.time_since_epoch()));
  if (verdict.cause != nav::CollisionMonitor::Cause::none) controller_->sent(verdict.velocity);
  if (verdict.cause == nav::CollisionMonitor::Cause::tilted) watch_warning(verdict.cause, now);
  held_.look(verdict.cause == nav::CollisionMonitor::Cause::stopped,
             frames_.T_odom_base().planar().position(), seconds(now.time_since_epoch()));
  Twist2 velocity = verdict.velocity;
  if (terrain_fresh(now)) velocity.vz = climb();
  return velocity;
}

std::optional<double> Navigation::height_left() const {
  const auto* go = std::get_if<GoTo>(&motion_);
  if (!params_.platform.flies() || !go || !std::isfinite(go->goal.z())) return std::nullopt;
  return go->goal.z() - frames_.height();
}

double Navigation::climb() const {
  constexpr double kThere = 0.05;  // m
  const double left = height_left().value_or(0.0), most = params_.platform.max_climb;
  return std::fabs(left) < kThere ? 0.0 : std::clamp(left, -most, most);
}

double Navigation::distance_to_goal(const Pose2& pose) const {
  const auto* go = std::get_if<GoTo>(&motion_);
  if (!go) return std::numeric_limits<double>::infinity();
  return (frames_.to_odom(Eigen::Vector2d(go->goal.head<2>())) - pose.position()).norm();
}

Pose2 Navigation::resting_place() const {
  const Twist2& moves = frames_.twist();
  const double brakes_s = std::hypot(moves.vx, moves.vy) / (2.0 * params_.platform.max_acceleration);
  return frames_.T_odom_base().planar() * Pose2{moves.vx * brakes_s, moves.vy * brakes_s, 0};
}

bool Navigation::is_current(std::uint64_t generation, Time now) const {
  const auto* go = std::get_if<GoTo>(&motion_);
  if (generation == goal_generation_) return true;
  return go && go->continues && now - continued_ < params_.passed_age;
}

nav::Target Navigation::target() const {
  if (const auto* go = std::get_if<GoTo>(&motion_)) {
    const auto* step = step_on(now());
    nav::Target target{};
    if (!router_)
      target = nav::Target::to(frames_.to_odom(Eigen::Vector2d(go->goal.head<2>())));
    else if (step)  // Otherwise the robot waits for its route.
      target = nav::target_of(*step);
    target.speed = go->max_speed;
    if (target.last) target.tolerance = go->tolerance;
    return target;
  }
  const auto* guidance = std::get_if<Guidance>(&motion_);
  if (!guidance || guidance->stick.zero()) return {};
  const Twist2& stick = guidance->stick;
  const double speed = std::hypot(stick.vx, stick.vy);
  if (speed < kTurningSpeed && !params_.platform.turns_on_spot()) return {};
  if (speed < kTurningSpeed) return nav::Target::along(std::copysign(M_PI / 2, stick.wz), kTurningSpeed);
  const double turn = std::clamp(stick.wz * kTurnLooksAhead, -M_PI / 2, M_PI / 2);
  return nav::Target::along(wrap_angle(std::atan2(stick.vy, stick.vx) + turn),
                            std::min(speed, params_.platform.max_speed));
}

Twist2 Navigation::limited(const Twist2& wanted) const {
  const Platform& p = params_.platform;
  Twist2 t = p.limited(wanted);
  if (!p.turns_on_spot()) {
    const double most = std::fabs(t.vx) / p.least_radius();
    t.wz = std::clamp(t.wz, -most, most);
  }
  return t;
}

void Navigation::add_scan(std::shared_ptr<Scan> scan, Time received, Time now, std::vector<TeamRobot> team) {
  scanned_ = received;
  detect(scan, now);
  peers_.clear();
  for (const TeamRobot& robot : team)
    peers_.emplace_back(robot.pose.x, robot.pose.y, std::hypot(robot.length, robot.width) / 2);
  if (planning_)
    waiting_ = scan;
  else
    plan(scan, now);
  ask_route(scan, now, std::move(team));
}

void Navigation::detect(std::shared_ptr<const Scan> scan, Time now) {
  using Detected = std::shared_ptr<const nav::DetectedObstacles>;
  compute(
      {.name = "obstacles",
       .modelled = params_.detection,
       .priority = JobPriority::high,
       .lane = "obstacles",
       .latest_only = true},
      [scan = std::move(scan), detection = detection_, epoch = scan_epoch_,
       stamp = seconds(now.time_since_epoch())]() -> Detected {
        if (std::exchange(detection->epoch, epoch) != epoch) detection->detector.clear();
        return std::make_shared<const nav::DetectedObstacles>(
            detection->detector.look(scan->measured(), scan->body, stamp));
      },
      [this, epoch = scan_epoch_](const Result<Detected>& detected) {
        if (detected) {
          if (epoch == scan_epoch_) monitor_.see(*detected);
        } else if (detected.reason() != Reason::cancelled && detected.reason() != Reason::queue_full) {
          // Work that hangs still uses the one before.
          detection_.reset(new Detection{monitor_.make_detector(), scan_epoch_});
        }
      });
}

std::vector<Eigen::Vector3f> Navigation::movers(Time now) const {
  constexpr float kUnseen = 0.4f;  // m: the far side of a person, and limbs that swing.
  constexpr double kOld = 1.0;     // s; who was seen then may be anywhere.
  const nav::DetectedObstacles& seen = monitor_.seen();
  const double age = seconds(now.time_since_epoch()) - seen.stamp_s;
  std::vector<Eigen::Vector3f> discs;
  if (!(age < kOld)) return discs;
  for (const nav::Mover& mover : seen.movers) {
    if (!mover.moves) continue;
    float radius = 0;
    for (const Eigen::Vector2f& point : mover.surface())
      radius = std::max(radius, (point - mover.position).norm());
    const Eigen::Vector2f at = mover.position + static_cast<float>(age) * mover.velocity;
    discs.emplace_back(at.x(), at.y(), radius + kUnseen);
  }
  return discs;
}

const nav::RouteStep* Navigation::followed_route(Time now) const {
  const nav::RouteStep* step = std::holds_alternative<GoTo>(motion_) ? step_on(now) : nullptr;
  return step && !step->ahead.empty() ? step : nullptr;
}

const nav::RouteStep* Navigation::step_on(Time now) const {
  if (!step_ || now - step_made_ >= params_.step_age) return nullptr;
  return is_current(step_generation_, now) ? &*step_ : nullptr;
}

// One before a jump of the own odometry lies elsewhere in the map of the routes.
std::shared_ptr<const nav::LocalMap> Navigation::near_map(const Scan& scan, Time now) const {
  constexpr double kOldest = 0.5;  // s
  if (!local_map_) return nullptr;
  const nav::LocalMapScan& at = local_map_->scan();
  const bool same = at.odom_epoch == frames_.odom_epoch() && at.jumps == scan.jumps;
  return same && seconds(now.time_since_epoch()) - at.stamp_s < kOldest ? local_map_ : nullptr;
}

void Navigation::ask_route(const std::shared_ptr<const Scan>& scan, Time now, std::vector<TeamRobot> team) {
  if (!router_ || routing_) return;
  auto job = std::make_shared<RouteJob>();
  job->scan = scan;
  job->near = near_map(*scan, now);
  job->team = std::move(team);
  job->place = frames_.T_odom_base().position;
  if (const auto* go = std::get_if<GoTo>(&motion_)) {
    job->goal = frames_.to_odom(go->goal);
    job->pass = go->pass;
    job->ask = std::exchange(ask_, nav::RouteAsk::none);
    job->blocked_ahead = recovery_.cause_ahead();
  }
  job->odom_epoch = frames_.odom_epoch();
  job->generation = goal_generation_;
  job->areas = route_areas();
  job->stairs = nav::nearest_stairs(stairs_, std::array{job->place, job->goal.value_or(job->place)},
                                    nav::SurfaceMap::kMaxStairs);
  job->made = now;
  routing_ = true;
  call(router_->step, job, {.deadline = kAnswerDeadline},
       [this, job](const Result<nav::RouteStep>& step) { routed(*job, step); });
}

void Navigation::routed(const RouteJob& job, const Result<nav::RouteStep>& step) {
  routing_ = false;
  if (!step && job.generation == goal_generation_ && ask_ == nav::RouteAsk::none) ask_ = job.ask;
  if (!step || job.odom_epoch != frames_.odom_epoch()) return;
  mapped_ = job.made;
  const auto* go = std::get_if<GoTo>(&motion_);
  if (!job.goal || job.generation != goal_generation_ || !go) return;
  step_ = *step;
  if (step->length > go->max_route) step_->state = nav::RouteStep::State::unreachable;
  if (step_->state != nav::RouteStep::State::along) step_->route = 0;
  step_generation_ = job.generation;
  step_made_ = job.made;
  if (step->replanned) recovery_.replanned();
}

void Navigation::plan(std::shared_ptr<Scan> scan, Time now) {
  auto job = std::make_shared<PlanJob>();
  job->scan = std::move(scan);
  job->target = target();
  job->state = recovery_.state();
  if (std::holds_alternative<GoTo>(motion_)) job->target = recovery_.target(job->target);
  job->peers = peers_;
  job->stairs =
      nav::nearest_stairs(stairs_, std::array{frames_.T_odom_base().position}, nav::SurfaceMap::kMaxStairs);
  job->pose = frames_.T_odom_base().planar();
  if (is_bound() && !fence_.empty()) job->border = fence_.border(frames_, kBorderRange);
  job->odom_epoch = frames_.odom_epoch();
  job->generation = router_ && step_on(now) ? step_generation_ : goal_generation_;
  job->made = now;
  planning_ = true;
  waiting_.reset();
  call(planner_, job, {.deadline = kAnswerDeadline},
       [this, job](const Result<std::shared_ptr<const PlanAnswer>>& answer) { planned(*job, answer); });
}

void Navigation::planned(const PlanJob& job, const Result<std::shared_ptr<const PlanAnswer>>& answer) {
  planning_ = false;
  if (answer && job.odom_epoch == frames_.odom_epoch()) take(job, *answer);
  if (waiting_) plan(std::exchange(waiting_, nullptr), now());
}

void Navigation::take(const PlanJob& job, const std::shared_ptr<const PlanAnswer>& answer) {
  local_map_ = answer->map;
  const bool for_stick =
      job.target.kind == nav::Target::Kind::direction && std::holds_alternative<Guidance>(motion_);
  if (for_stick)
    follow(answer->plan, job.made);
  else if (job.target.kind != nav::Target::Kind::direction && std::holds_alternative<GoTo>(motion_) &&
           is_current(job.generation, now()))
    go_on(job, answer->plan);
}

void Navigation::follow(const nav::Plan& plan, Time made) {
  controller_->set_plan(plan);
  has_plan_ = true;
  plan_made_ = made;
}

void Navigation::recover(const PlanJob& job, const nav::Plan& plan, bool held) {
  nav::RecoveryInput in = router_ ? nav::recovery_input(*step_on(now()))
                                  : nav::RecoveryInput{.route = 1, .left = distance_to_goal(job.pose)};
  in.take(plan);
  in.goal = goal_generation_;
  in.held = held;
  in.stands = in.stands || speed_limit_ < kCrawls;
  in.at = job.pose.position();
  in.stamp_s = seconds(job.made.time_since_epoch());
  const nav::RecoveryState before = recovery_.state();
  if (const auto state = recovery_.look(in); state != before && log().on(LogLevel::info)) {
    char text[80];
    std::snprintf(text, sizeof text, "%s after %s at %.2f %.2f, odometry", nav::name(state).data(),
                  nav::name(before).data(), in.at.x(), in.at.y());
    log().info(text);
  }
  if (const auto ask = recovery_.take_ask(); ask != nav::RouteAsk::none) {
    ask_ = ask;
    if (!router_) recovery_.replanned();  // There is no other way.
  }
}

void Navigation::go_on(const PlanJob& job, const nav::Plan& plan) {
  using Kind = nav::Target::Kind;
  using State = nav::RecoveryState;
  const auto* step = step_on(now());
  if (router_ && !step) return;
  const bool held = held_.held(seconds(now().time_since_epoch()), seconds(params_.held_after));
  // A plan for the state before says nothing about this one.
  if (job.state == recovery_.state()) recover(job, plan, held);
  const bool drives = job.state == recovery_.state() && !recovery_.gave_up() &&
                      recovery_.state() != State::replan &&
                      (!router_ || step->route != 0 || job.target.kind == Kind::leave);
  follow(drives ? plan : nav::Plan{}, job.made);

  const auto& go = std::get<GoTo>(motion_);
  const double tolerance = go.tolerance > 0 ? go.tolerance : kTolerance;
  bool arrived = plan.arrived && drives && job.target.last && job.generation == goal_generation_ &&
                 distance_to_goal(job.pose) < tolerance + kGoalMoved &&
                 distance_to_goal(resting_place()) <=
                     std::max(tolerance, distance_to_goal(frames_.T_odom_base().planar())) + kRestsOff &&
                 std::fabs(height_left().value_or(0.0)) < kAtHeight;
  if (arrived && go.yaw && params_.platform.turns_on_spot()) {
    nav::Plan turn{.stamp_s = plan.stamp_s, .turn_first = true, .pose_count = 2};
    turn.poses[0] = turn.poses[1] = frames_.T_map_odom().inverse() * Pose2{go.goal.x(), go.goal.y(), *go.yaw};
    arrived = std::fabs(wrap_angle(turn.poses[0].yaw - job.pose.yaw)) < kTurned;
    if (!arrived) follow(turn, job.made);
  }
  const Reason reason = recovery_.reason();
  const bool refused = reason == Reason::goal_unreachable && nav::is_refused(step->goal);
  outputs_.progress({.arrived = arrived,
                     .blocked = plan.blocked || held || recovery_.gave_up(),
                     .goal_seen = !step_ || step_->goal != nav::Standing::unseen,
                     .reason = reason,
                     .refusal = refused ? reason_of(step->goal) : Reason::none,
                     .refusal_text = refused && step->goal == nav::Standing::over_stairs && step->stairs
                                         ? stairs_in_the_way(*step->stairs, frames_)
                                         : "",
                     .recovery = recovery_.state(),
                     .cause = recovery_.cause(),
                     .in_collision = recovery_.side()});
}

bool Navigation::goal_free(const Eigen::Vector2d& place) const {
  if (!local_map_) return true;
  const Eigen::Vector2f at = frames_.to_odom(place).cast<float>();
  const float radius = static_cast<float>(std::min(params_.platform.width, params_.platform.length) / 2);
  return std::ranges::none_of(local_map_->places(), [&](const nav::LocalPlace& each) {
    return each.cost >= 1.0f && (Eigen::Vector2f(each.x, each.y) - at).squaredNorm() < radius * radius;
  });
}

}  // namespace adit::agent
