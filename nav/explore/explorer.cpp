// SPDX-License-Identifier: Apache-2.0
#include "nav/explore/explorer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace adit::nav {
namespace {

// m3: frontiers with less behind them are left to the end. By test_explore.
constexpr double kLeastGain = 8.0;
constexpr double kKeepCost = 0.9;  // Another frontier must cost less than this fraction of the present one.
constexpr double kKeepGain = 2.0;  // Another frontier must cost this much less than the present one, m.
constexpr double kArrived = 0.5;   // m
constexpr int kLooks = 1;          // Scans at a viewpoint before what it does not show is given up.
constexpr double kSettled = 3.0;   // s without a frontier before the exploration is done.
constexpr double kFirstPause = 60.0;  // s before a place that was blocked is tried again; doubles each time.
constexpr double kSameViewpoint = 1.0;  // m
constexpr double kSameFrontier = 3.0;   // m between the centres: the width of a group.
constexpr double kAlong = 1.0;          // Between places on the straight line to a frontier, m.
constexpr double kReplaced = 4.0;  // A goal is replaced when it is nearer, m: twice the braking distance.
constexpr std::size_t kViewpoints = 6;  // Of a frontier, the nearest to the robot, besides the goal.
constexpr std::size_t kSamples = 8;     // Voxels of a frontier that are looked at for a viewpoint.
constexpr std::array kAway{2.0, 4.0, 6.0, 8.0, 10.0};  // Of a viewpoint from its frontier, m.
constexpr int kDirections = 16;
constexpr std::size_t kMaxDeferred = 64;
// Without an exploration, a scan is kept after so much of the way, m, or of a turn, rad, or so many scans.
constexpr double kApart = 1.0, kTurnApart = 0.5;
constexpr int kSkipped = 25;
constexpr int kIdle =
    10;  // Scans without a step after which the exploration is over: 2 s at the router's rate.
// Least volume behind a frontier that is left to the end, m3: that of an opening which the robot fits through
// with its margin, two voxels wide and 2.5 m high, to the depth of 1.5 m that counts.
constexpr double kSmallGain = 3.75;
// Small frontiers are not worth a way when all of them together promise less than this share of what was
// seen. Chosen with bench_explore, not derived: without it the blocks take up to half as long again.
constexpr double kWorth = 0.01;

/// Whether it is left to the end.
bool is_small(const Frontier& frontier) { return frontier.gain < kLeastGain; }

std::size_t unseen_of(const CoverageMap& map, const Frontier& frontier) {
  return static_cast<std::size_t>(std::ranges::count_if(frontier.unseen, [&map](const CoverageVoxel& v) {
    const CoverageMap::Column column = map.column(v.x, v.y, CoverageMap::band_of(v.z));
    return !CoverageMap::bit(static_cast<std::uint16_t>(column.seen() | column.tried), v.z);
  }));
}

/// Leaves out what the robot's areas say is not worth a look, and weighs the rest.
/// Areas are those of the ground, so `z` is that of the robot, m.
void weigh(const RouteGround& ground, double z, std::vector<Frontier>& frontiers) {
  for (Frontier& frontier : frontiers) {
    const auto all = static_cast<double>(frontier.unseen.size());
    double sum = 0;
    std::erase_if(frontier.unseen, [&](const CoverageVoxel& v) {
      const Eigen::Vector3d at = CoverageMap::centre(v);
      const double weight = ground.weight({at.x(), at.y(), z});
      sum += weight;
      return weight <= 0;
    });
    frontier.weight = sum / all;
    frontier.gain *= frontier.weight;
  }
  std::erase_if(frontiers, [&](const Frontier& f) { return f.unseen.empty() || f.gain < kSmallGain; });
}

}  // namespace

Explorer::Explorer(const Platform& platform)
    : sensor_(platform.lidar_origin()), braking_(platform.max_acceleration) {
  const LidarConfig lidar = platform.lidar();
  steepest_ = std::tan(lidar.highest * M_PI / 180.0);
  lowest_ = std::tan(lidar.lowest * M_PI / 180.0);
}

void Explorer::begin() {
  goal_.reset();
  deferred_.clear();
  nothing_since_.reset();
  before_.reset();
  scans_ = 0;
}

void Explorer::clear() {
  begin();
  map_.clear();
  ever_ = false;
  kept_.reset();
}

bool Explorer::worth_keeping(const Pose3& body) const {
  return !kept_ || skipped_ >= kSkipped || (body.position - kept_->position).norm() >= kApart ||
         body.orientation.angularDistance(kept_->orientation) >= kTurnApart;
}

void Explorer::add_scan(const ScanPoints& scan, const Pose3& body) {
  idle_ = std::min(idle_ + 1, kIdle);
  if (idle_ == kIdle && !worth_keeping(body)) {
    ++skipped_;
    return;
  }
  kept_ = body;
  skipped_ = 0;
  scan.each_part(sensor_,
                 [&](auto points, const Eigen::Vector3d& origin) { map_.add_scan(points, origin, body); });
  ++scans_;
}

// Whether the lidar of a robot at a viewpoint sees a place, according to the map.
bool Explorer::in_view(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& target) const {
  const Eigen::Vector3d from = viewpoint + Eigen::Vector3d(0, 0, sensor_.z());
  const Eigen::Vector3d way = target - from;
  const double across = way.head<2>().norm(), half = CoverageMap::kVoxel / 2;
  return way.norm() < CoverageMap::kRange && way.z() - half < steepest_ * across + half &&
         way.z() + half > lowest_ * across - half && map_.visible(from, target);
}

bool Explorer::satisfied(const Goal& goal) const {
  return 4 * unseen_of(map_, goal.frontier) <= goal.frontier.unseen.size();
}

void Explorer::defer(const Eigen::Vector3d& place, double stamp_s) {
  const auto same = std::ranges::find_if(
      deferred_, [&place](const Deferred& d) { return (d.place - place).norm() < kSameViewpoint; });
  if (same != deferred_.end()) {
    same->pause *= 2;
    same->until = stamp_s + same->pause;
    return;
  }
  if (deferred_.size() >= kMaxDeferred)
    deferred_.erase(std::ranges::min_element(deferred_, {}, &Deferred::until));
  deferred_.push_back({place, stamp_s + kFirstPause, kFirstPause});
}

bool Explorer::is_deferred(const Eigen::Vector3d& place, double stamp_s) const {
  return std::any_of(deferred_.begin(), deferred_.end(), [&](const Deferred& d) {
    return stamp_s < d.until && (d.place - place).norm() < kSameViewpoint;
  });
}

void Explorer::give_up_unseen(const Goal& goal) {
  for (const CoverageVoxel& v : goal.frontier.unseen)
    if (!map_.seen(v) && (!goal.shows || in_view(goal.place, CoverageMap::centre(v)))) map_.set_tried(v);
}

// Places around a frontier and on the straight line to the robot, those near the frontier first.
std::vector<Eigen::Vector3d> Explorer::places_around(RouteGround& ground, const Frontier& frontier,
                                                     const Eigen::Vector3d& place, double stamp_s) const {
  std::vector<Eigen::Vector3d> places;
  const Eigen::Vector2d centre = frontier.centre.head<2>(), to_robot = place.head<2>() - centre;
  const auto offer = [&](const Eigen::Vector2d& p) {
    const auto z = ground.ground(p.x(), p.y(), std::min(place.z(), frontier.centre.z()));
    if (z && !is_deferred({p.x(), p.y(), *z}, stamp_s)) places.emplace_back(p.x(), p.y(), *z);
  };
  offer(centre);
  for (const double away : kAway)
    for (int k = 0; k < kDirections; ++k) {
      const double bearing = 2 * M_PI * k / kDirections;
      offer(centre + away * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)));
    }
  for (double away = kAlong; away < std::min(to_robot.norm(), CoverageMap::kRange); away += kAlong)
    offer(centre + away * to_robot.normalized());
  std::ranges::sort(places, {},
                    [&](const Eigen::Vector3d& p) { return (p.head<2>() - centre).squaredNorm(); });
  return places;
}

// Whether at least half of a frontier is seen from a place.
bool Explorer::shows(const Eigen::Vector3d& viewpoint, const Frontier& frontier) const {
  const std::size_t stride = std::max<std::size_t>(1, frontier.unseen.size() / kSamples);
  std::size_t looked = 0, shown = 0;
  for (std::size_t k = 0; k < frontier.unseen.size(); k += stride) {
    ++looked;
    shown += in_view(viewpoint, CoverageMap::centre(frontier.unseen[k]));
  }
  return 2 * shown >= looked;
}

std::vector<Explorer::Viewpoint> Explorer::viewpoints(RouteGround& ground, const Frontiers& frontiers,
                                                      const Eigen::Vector3d& place, double stamp_s) const {
  std::vector<Viewpoint> all;
  for (std::size_t i = 0; i < frontiers.list.size(); ++i) {
    const Frontier& frontier = frontiers.list[i];
    std::vector<Eigen::Vector3d> places = places_around(ground, frontier, place, stamp_s);
    std::size_t added = 0;
    const auto keep = [&](const Eigen::Vector3d& p) {
      if (!shows(p, frontier) || !ground.standable(p)) return false;
      all.push_back({p, i, added == 0, true});
      ++added;
      return true;
    };
    const auto beside = std::find_if(places.begin(), places.end(), keep);
    if (beside == places.end()) {
      // The ground from where it could be seen may become known from nearer.
      const auto near = std::ranges::find_if(places, [&](const auto& p) { return ground.standable(p); });
      if (near != places.end()) all.push_back({*near, i, true, false});
      continue;
    }
    places.erase(places.begin(), beside + 1);
    std::ranges::sort(places, {}, [&](const Eigen::Vector3d& p) { return (p - place).squaredNorm(); });
    for (const Eigen::Vector3d& p : places) {
      if (added > kViewpoints) break;
      keep(p);
    }
  }
  return all;
}

Eigen::Vector3d Explorer::stopping_place(RouteGround& ground, const Eigen::Vector3d& place, double stamp_s) {
  constexpr double kShortest = 0.05, kLongest = 1.0;  // s: outside of this interval the speed is unknown.
  const double dt = stamp_s - before_s_;
  Eigen::Vector3d ahead = place;
  if (before_ && dt > kShortest && dt < kLongest) {
    const Eigen::Vector3d velocity = (place - *before_) / dt;
    const Eigen::Vector3d there = place + velocity * (velocity.norm() / (2 * braking_));
    if (ground.standable(there)) ahead = there;
  }
  before_ = place;
  before_s_ = stamp_s;
  return ahead;
}

void Explorer::end_goal(const Eigen::Vector3d& place, double stamp_s, bool blocked) {
  const bool here = (goal_->place - place).head<2>().norm() < kArrived;
  if (here && !goal_->arrived) {
    goal_->arrived = true;
    scans_ = 0;
  }
  const bool looked = goal_->arrived && scans_ >= kLooks;
  if (!looked && !blocked) return;
  if (looked || !goal_->shows) give_up_unseen(*goal_);
  if (!looked) defer(goal_->place, stamp_s);
  goal_.reset();
}

bool Explorer::continues(const Frontier& frontier) const {
  return goal_ && (frontier.centre - goal_->frontier.centre).norm() < kSameFrontier;
}

// Chooses the frontier of the cheapest viewpoint. The goal is the place beside the frontier, beyond most
// viewpoints: the robot has its next goal before it has to brake for this one.
std::vector<bool> Explorer::choose(RouteGround& ground, const Frontiers& frontiers,
                                   const Eigen::Vector3d& place, double stamp_s) {
  const std::vector<Viewpoint> places = viewpoints(ground, frontiers, place, stamp_s);
  std::vector<Eigen::Vector3d> goals;
  goals.reserve(places.size() + 1);
  for (const Viewpoint& v : places) goals.push_back(v.place);
  if (goal_) goals.push_back(goal_->place);
  std::vector<float> costs = ground.costs(stopping_place(ground, place, stamp_s), goals);
  const bool routes = std::any_of(costs.begin(), costs.end(), [](float cost) { return std::isfinite(cost); });
  // Without any route through known space the global planner has to prove that there is none at all.
  for (std::size_t i = 0; !routes && i < goals.size(); ++i)
    costs[i] = static_cast<float>((goals[i] - place).norm());
  if (ground.weighs()) {
    for (std::size_t i = 0; i < places.size(); ++i)
      costs[i] /= static_cast<float>(frontiers.list[places[i].frontier].weight);
    if (goal_) costs.back() /= static_cast<float>(goal_->frontier.weight);
  }
  // A frontier that was seen is no reason to go on in its direction.
  const bool open = goal_ && !satisfied(*goal_);
  std::vector<bool> reachable(frontiers.list.size(), false);
  bool large = false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!std::isfinite(costs[i])) continue;
    reachable[places[i].frontier] = true;
    large = large || !is_small(frontiers.list[places[i].frontier]);
  }
  // Small frontiers that cost about the same would replace one another before any of them is reached.
  if (open && !large && goal_->shows && std::isfinite(costs.back())) return reachable;
  std::size_t best = places.size(), to = places.size(), beside = places.size();
  double best_cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].beside) beside = i;
    const Frontier& frontier = frontiers.list[places[i].frontier];
    if (!std::isfinite(costs[i]) || (large && is_small(frontier))) continue;
    const double rest = places[i].shows ? 0 : (frontier.centre - places[i].place).norm();
    double cost = costs[i] + rest;
    if (open && continues(frontier)) cost = kKeepCost * cost - kKeepGain;
    if (cost >= best_cost) continue;
    best_cost = cost;
    best = i;
    to = std::isfinite(costs[beside]) ? beside : i;
  }
  if (goal_ && !std::isfinite(costs.back())) goal_.reset();
  if (best == places.size()) {
    goal_.reset();
    return reachable;
  }
  const Frontier& frontier = frontiers.list[places[best].frontier];
  const bool keeps = continues(frontier) && (goal_->arrived || (goal_->place - place).norm() > kReplaced);
  if (keeps)
    goal_->frontier = frontier;
  else
    goal_ = Goal{places[to].place, frontier, routes && places[to].shows};
  return reachable;
}

void Explorer::leave_small(std::vector<Frontier>& frontiers) const {
  double gain = 0;
  for (const Frontier& frontier : frontiers)
    if (is_small(frontier)) gain += frontier.gain;
  if (gain < kWorth * map_.seen_volume()) std::erase_if(frontiers, is_small);
}

ExploreStep Explorer::step(RouteGround& ground, const Eigen::Vector3d& place, double stamp_s, bool blocked) {
  idle_ = 0;
  if (goal_) end_goal(place, stamp_s, blocked);
  Frontiers frontiers = find_frontiers(map_, kSmallGain);
  if (ground.weighs()) weigh(ground, place.z(), frontiers.list);
  leave_small(frontiers.list);
  const std::vector<bool> reachable = choose(ground, frontiers, place, stamp_s);

  ExploreStep step;
  step.frontiers = static_cast<std::size_t>(std::count(reachable.begin(), reachable.end(), true));
  step.unreachable = reachable.size() - step.frontiers;
  step.dropped = frontiers.dropped;
  step.volume = map_.seen_volume();
  for (std::size_t i = 0; i < reachable.size(); ++i)
    if (reachable[i]) step.open += frontiers.list[i].gain;
  if (goal_) {
    ever_ = true;
    nothing_since_.reset();
    step.state = ExploreState::exploring;
    step.goal = goal_->place;
    return step;
  }
  if (!nothing_since_) {
    nothing_since_ = stamp_s;
    scans_ = 0;
  }
  const bool settled = stamp_s - *nothing_since_ >= kSettled && scans_ > 0;
  step.state = settled ? (ever_ ? ExploreState::done : ExploreState::no_viewpoint)
               : ever_ ? ExploreState::exploring
                       : ExploreState::starting;
  return step;
}

}  // namespace adit::nav
