// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/right_of_way/right_of_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "nav/right_of_way/place_search.hpp"

namespace adit::agent {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTouch = 0.05;       // m: a route that passes at a greater distance leads around the robot.
constexpr double kThere = 0.5;        // m: a robot this near its place has arrived.
constexpr double kBesidePlace = 1.5;  // m: free for a robot that drives to a place.
constexpr double kPassed = 1.0;       // m behind the robot: a place was passed.
// s: a longer detour is driven only when the local planner finds no way past the robot. A robot that leads
// round through ground that it does not know would be away when the other one has made way.
constexpr double kDetour = 10.0;
constexpr double kNearer = 0.5;       // A place replaces the one before it if it is nearer than this share.
constexpr Duration kLookAgain = 3s;   // Between two searches on the way to a place.
constexpr Duration kSearchLost = 2s;  // An answer of the router that takes longer is lost.

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Eigen::Vector2d velocity(const TeamBeacon& beacon) {
  const double c = std::cos(beacon.pose.yaw), s = std::sin(beacon.pose.yaw);
  return {c * beacon.twist.vx - s * beacon.twist.vy, s * beacon.twist.vx + c * beacon.twist.vy};
}

}  // namespace

Result<void> RightOfWay::allow(bool allowed, Time now) {
  if (allowed && !params_.can_clear)
    return {Reason::not_supported, "yield: this robot has no global planner to find a place with"};
  allowed_ = allowed;
  asleep_ = false;
  refusals_.clear();
  if (!allowed && clearing_) end(now);
  return {};
}

void RightOfWay::stopped() {
  asleep_ = allowed_;
  clearing_.reset();
  ++search_;
}

void RightOfWay::holder_changed() {
  allowed_ = asleep_ = false;
  clearing_.reset();
  refusals_.clear();
  ++search_;
}

std::optional<Eigen::Vector2d> RightOfWay::place() const {
  return clearing_ ? std::optional(clearing_->place) : std::nullopt;
}

RightOfWay::Claim RightOfWay::claim(const Own& own) const {
  if (clearing_) return {clearing_->rank, clearing_->root};
  const auto rank = own.mode == "manual" || own.mode == "smart_joystick" ? Rank::by_hand
                    : own.stopped || !own.drives                         ? Rank::holds
                    : own.convoy                                         ? Rank::convoy
                    : own.mode == "explore"                              ? Rank::explores
                                                                         : Rank::drives;
  return {static_cast<std::uint8_t>(rank), params_.robot};
}

RightOfWay::Claim RightOfWay::claim(const TeamBeacon& beacon) {
  if (beacon.answer && beacon.answer->clears) return {beacon.rank, beacon.answer->root};
  return {beacon.rank, beacon.ask ? beacon.ask->root : beacon.robot};
}

bool RightOfWay::makes_way(const TeamBeacon& beacon) { return beacon.yields && !beacon.stopped; }

bool RightOfWay::refuses(const TeamBeacon& beacon, const std::string& root) {
  return beacon.answer && !beacon.answer->clears && beacon.answer->root == root;
}

bool RightOfWay::fresh(const Peer& peer, Time now) const {
  return peer.present && peer.heard_beacon && now - peer.heard_beacon->at < kHeard;
}

double RightOfWay::cost_of(const Peer& peer) const {
  const TeamBeacon& beacon = peer.heard_beacon->beacon;
  if (velocity(beacon).norm() > kStands) return 0.0;
  if (clearing_ && (peer.name == clearing_->asker || peer.name == clearing_->root)) return nav::kNoWay;
  return params_.max_speed * kDetour;
}

// The nearest robot on the way ahead that does not drive on along it.
std::optional<RightOfWay::Blocker> RightOfWay::blocker(const Own& own, Time now) const {
  std::optional<Blocker> nearest;
  if (own.route.size() < 2) return nearest;
  for (const Peer& peer : peers_.all()) {
    if (!fresh(peer, now) || contains(own.members, peer.name)) continue;
    const TeamBeacon& beacon = peer.heard_beacon->beacon;
    const nav::BesideRoute at = nav::beside_route(own.route, beacon.pose.position());
    const double half = nav::half_extent(peer.length, peer.width, beacon.pose.yaw, at.direction);
    const bool ahead = at.along > 0.0 && at.along <= kLookAhead;
    if (!ahead || at.distance > params_.width / 2 + half + kTouch) continue;
    const bool clears = beacon.answer && beacon.answer->clears;
    const bool leaves = !clears && velocity(beacon).dot(at.direction) > kStands;
    // One that waits for a third robot on the same way goes on before this one.
    const bool queues = beacon.ask && beacon.ask->route.size() >= 2 &&
                        (beacon.ask->route[1] - beacon.ask->route[0]).dot(at.direction) > 0.0 &&
                        !beacon.ask->names(params_.robot);
    if (leaves || queues) continue;
    if (!nearest || at.along < nearest->along) nearest = Blocker{&peer, at.along};
  }
  return nearest;
}

void RightOfWay::tick(const Own& own, Time now) {
  could_ = allowed_ && !asleep_ && !own.stopped && own.pose && own.mode != "manual" &&
           own.mode != "smart_joystick" && own.mode != "external";
  std::erase_if(refusals_, [&](const Refusal& r) { return now >= r.until; });
  if (clearing_ && own.mode != "get_out") clearing_.reset();  // The holder requested something else.
  claim_ = claim(own);
  speed_limit_ = kInfinity;
  route_ = own.route;
  ask_others(own, now);
  answer_others(own, now);
}

void RightOfWay::ask_others(const Own& own, Time now) {
  keep_asked(own, now);
  const auto before = own.pose ? blocker(own, now) : std::nullopt;
  if (!before) {
    blocked_by_.clear();
    return watch_wall(nullptr, now);
  }
  const Peer& peer = *before->peer;
  if (blocked_by_ != peer.name) {
    blocked_by_ = peer.name;
    blocked_since_ = now;
  }
  const TeamBeacon& beacon = peer.heard_beacon->beacon;
  const bool clears = makes_way(beacon) && !refuses(beacon, claim_.root);
  const bool passes = claim_.outranks(claim(beacon)) || has_refused(claim(beacon).root);
  if (!clears) return watch_wall(&peer, now);
  keep_distance(own, *before, now);
  watch_wall(nullptr, now);
  if (!passes || now - blocked_since_ < kPersists) return;
  const auto asked =
      std::find_if(asked_.begin(), asked_.end(), [&](const Asked& a) { return a.robot == peer.name; });
  if (asked == asked_.end() && asked_.size() < YieldAsk::kRobots)
    asked_.push_back({peer.name, {beacon.pose.position()}, now});
}

// A robot is asked until this one has passed the place where it was, and the one to which it drives.
void RightOfWay::keep_asked(const Own& own, Time now) {
  std::erase_if(asked_, [&](Asked& asked) {
    const Peer* peer = peers_.find(asked.robot);
    if (!peer || !fresh(*peer, now) || own.route.size() < 2 || !own.drives) return true;
    const TeamBeacon& beacon = peer->heard_beacon->beacon;
    if (!makes_way(beacon) || refuses(beacon, claim_.root)) return true;
    if (beacon.answer && beacon.answer->clears && asked.spots.size() < 2)
      asked.spots.push_back(beacon.answer->place);
    const double reach = (params_.length + peer->length) / 2 + kPassed;
    return std::none_of(asked.spots.begin(), asked.spots.end(), [&](const Eigen::Vector2d& spot) {
      return nav::beside_route(own.route, spot).distance < reach;
    });
  });
}

// Stays away from a robot that makes way, and from the place to which it drives. If it does not answer, the
// local planner decides after a while whether there is room to pass.
void RightOfWay::keep_distance(const Own& own, const Blocker& before, Time now) {
  const Peer& peer = *before.peer;
  const TeamBeacon& beacon = peer.heard_beacon->beacon;
  const bool clears = beacon.answer && beacon.answer->clears;
  if (!clears && now - blocked_since_ > kWaits) return;
  const double outline = (params_.length + peer.length) / 2;
  double room = before.along - outline - kDistance;
  if (clears && (beacon.pose.position() - beacon.answer->place).norm() > kThere)
    room = std::min(room, (own.pose->position() - beacon.answer->place).norm() - outline - kBesidePlace);
  speed_limit_ = std::max(0.0, 0.5 * room);
}

// A robot in the way that does not make way: the operator decides.
void RightOfWay::watch_wall(const Peer* wall, Time now) {
  if (!wall) {
    if (!wall_gone_) wall_gone_ = now;
    if (now - *wall_gone_ > kAskTimeout) reported_wall_.clear();
    return;
  }
  wall_gone_.reset();
  if (reported_wall_ == wall->name || now - blocked_since_ < kReportAfter) return;
  reported_wall_ = wall->name;
  const TeamBeacon& beacon = wall->heard_beacon->beacon;
  const std::string who = params_.robot + " waits for " + wall->name;
  if (refuses(beacon, claim_.root) && has_refused(claim(beacon).root))
    return outputs_.notify_holder(Severity::warning, "yield_deadlock", Reason::yield_deadlock,
                                  who + ", and neither has a place to make way");
  const std::string why = beacon.stopped ? "is stopped"
                          : refuses(beacon, claim_.root)
                              ? "finds no place to make way"
                              : "may not make way; allow it with: yield " + wall->name + " on";
  outputs_.notify_holder(Severity::warning, "yield_refused", Reason::yield_refused, who + ", which " + why);
}

bool RightOfWay::in_corridor(const Own& own, const YieldAsk& ask, double margin) const {
  if (!own.pose || ask.route.size() < 2) return false;
  const nav::BesideRoute at = nav::beside_route(ask.route, own.pose->position());
  const double half = nav::half_extent(params_.length, params_.width, own.pose->yaw, at.direction);
  return at.distance < ask.width / 2 + half + margin;
}

bool RightOfWay::has_refused(const std::string& root) const {
  return std::any_of(refusals_.begin(), refusals_.end(), [&](const Refusal& r) { return r.root == root; });
}

void RightOfWay::refuse(const std::string& root, Reason reason, Time now) {
  constexpr std::size_t kMost = 8;
  if (has_refused(root)) return;
  if (refusals_.size() == kMost) refusals_.erase(refusals_.begin());
  refusals_.push_back({root, reason, now + kRefused});
}

void RightOfWay::answer_others(const Own& own, Time now) {
  if (clearing_) clear(own, now);
  if (!could_ || clearing_ || (searches_since_ && now - *searches_since_ < kSearchLost)) return;
  const Peer* first = nullptr;
  for (const Peer& peer : peers_.all()) {
    if (!fresh(peer, now) || !peer.heard_beacon->beacon.ask) continue;
    const TeamBeacon& beacon = peer.heard_beacon->beacon;
    const YieldAsk& ask = *beacon.ask;
    if (!ask.names(params_.robot) || ask.root == params_.robot || has_refused(ask.root)) continue;
    const Claim theirs{beacon.rank, ask.root};
    // One that cannot make way itself passes, whatever its rank.
    if (!theirs.outranks(claim_) && !refuses(beacon, claim_.root)) continue;
    if (!in_corridor(own, ask, kMargin)) continue;
    if (!first || theirs.outranks(claim(first->heard_beacon->beacon))) first = &peer;
  }
  if (first) find(own, *first, now);
}

void RightOfWay::find(const Own& own, const Peer& asker, Time now) {
  const TeamBeacon& beacon = asker.heard_beacon->beacon;
  searches_since_ = now;
  Clearing way{
      asker.name, beacon.ask->root, beacon.rank, {}, own.pose->position(), own.mode == "hold", now, now, now,
      {}};
  outputs_.find_place({beacon.ask->route, beacon.ask->width}, asker.name,
                      [this, way, now, search = ++search_](std::optional<Eigen::Vector2d> place) {
                        if (search != search_ || !could_) return;
                        searches_since_.reset();
                        if (clearing_) return found_again(place, way.from, now);
                        if (!place) return refuse(way.root, Reason::yield_refused, now);
                        clearing_ = way;
                        clearing_->place = *place;
                        if (const auto entered = outputs_.clear_way(now); !entered) {
                          clearing_.reset();
                          refuse(way.root, entered.error().reason, now);
                        }
                      });
}

// What the robot sees on its way may show a place that is much nearer, or that the first one is none.
void RightOfWay::found_again(const std::optional<Eigen::Vector2d>& place, const Eigen::Vector2d& from,
                             Time now) {
  Clearing& way = *clearing_;
  if (!place && !way.must_change) return;
  if (!place) {
    const std::string root = way.root;
    end(now);
    return refuse(root, Reason::yield_refused, now);
  }
  const bool nearer = (*place - from).norm() < kNearer * (way.place - from).norm();
  if (!nearer && !way.must_change) return;
  way.place = *place;
  way.must_change = false;
  way.blocked_since.reset();
}

void RightOfWay::clear(const Own& own, Time now) {
  Clearing& way = *clearing_;
  const Peer* asker = peers_.find(way.asker);
  const bool renewed = asker && fresh(*asker, now) && asker->heard_beacon->beacon.ask &&
                       asker->heard_beacon->beacon.ask->names(params_.robot);
  if (renewed) way.heard = std::max(way.heard, asker->heard_beacon->at);
  if (!own.blocked)
    way.blocked_since.reset();
  else if (!way.blocked_since)
    way.blocked_since = now;
  if (now - way.heard > kAskTimeout || now - way.since > kLongest) return end(now);
  if (!renewed || (searches_since_ && now - *searches_since_ < kSearchLost)) return;
  // The way is blocked, or the robot stands at its place and the corridor has moved there: another place.
  const bool needs = (way.blocked_since && now - *way.blocked_since > kBlocked) ||
                     (own.arrived && in_corridor(own, *asker->heard_beacon->beacon.ask, 0.0));
  const bool looks = !own.arrived && now - way.looked > kLookAgain;
  if (!needs && !looks) return;
  way.looked = now;
  way.must_change = needs;
  find(own, *asker, now);
}

void RightOfWay::end(Time now) {
  const Clearing way = *std::exchange(clearing_, std::nullopt);
  ++search_;
  searches_since_.reset();
  outputs_.resume(now);
  if (!way.held) return;
  char text[96];
  std::snprintf(text, sizeof text, "%s made way for %s and stays %.1f m from where it was",
                params_.robot.c_str(), way.root.c_str(), (way.place - way.from).norm());
  outputs_.notify_holder(Severity::info, "made_way", Reason::none, text);
}

void RightOfWay::say(TeamBeacon& beacon) const {
  beacon.rank = claim_.rank;
  beacon.yields = could_;
  if (!asked_.empty() && route_.size() >= 2) {
    YieldAsk& ask = beacon.ask.emplace();
    for (const Asked& asked : asked_) ask.to.push_back(asked.robot);
    ask.root = claim_.root;
    ask.width = params_.width + kMargin;
    const std::size_t count = std::min(route_.size(), YieldAsk::kPoints);
    ask.route.assign(route_.begin(), route_.begin() + static_cast<std::ptrdiff_t>(count));
  }
  if (clearing_)
    beacon.answer = YieldAnswer{clearing_->root, true, Reason::none, clearing_->place};
  else if (!refusals_.empty())
    beacon.answer = YieldAnswer{refusals_.back().root, false, refusals_.back().reason, {}};
}

}  // namespace adit::agent
