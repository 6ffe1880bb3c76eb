// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/convoy/convoy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace adit::agent {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLookAhead = 2.5;   // m: farther, a route between two places would cut the leader's corners.
constexpr double kBeside = 0.3;      // m: clearance from a robot that stands on the path.
constexpr double kBehind = 0.5;      // m: a place this far behind the predecessor is not occupied by it.
constexpr double kRenew = 1.25;      // m: from here on the robot would brake for the place.
constexpr double kMinRenewal = 0.5;  // m: a place that changes with every beacon never gets a plan.
constexpr double kStands = 0.05;     // m/s: slower is standing.
/// A predecessor is assumed to drive on for so long after its beacon, s.
constexpr double kMaxExtrapolation = 0.5;
constexpr Duration kHalts = 1s;  // A leader that said so later may drive again.
/// Where two robots' maps drift apart, the path of one may lead through the other's walls: it then drives so
/// far beside the path, to the left or right, m.
constexpr std::array kAside{0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9, 1.2, -1.2};
constexpr double kRoom = 0.2;  // m: free around such a place, beside the body.
constexpr std::array<std::pair<double, double>, 5> kAround{{{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
constexpr double kBeforeAndAfter = 0.5;  // m: of a place, for the direction of the path there.
constexpr double kBackOnPath = 2.0;      // m: after so much path the robot tries the path itself again.
/// Error of the gap to a standing predecessor that is left as it is, m: the robot would creep for seconds.
constexpr double kDeadBand = 0.4;
constexpr double kLostSpeed = 0.5;     // m/s
constexpr double kClosingUp = 1.25;    // Followers may drive faster than the leader by this factor.
constexpr double kSearch = 5.0;        // m: path that is searched for the robot around its last position.
constexpr double kOffPath = 3.0;       // m: a robot farther away from the path is not on it.
constexpr double kFormingSpeed = 0.7;  // m/s: towards the path.
constexpr double kMissing = 5.0;       // m: so much path is never missing between two beacons.
constexpr Duration kMisfit = 5s;       // After pieces of another path for so long, this path is forgotten.
/// A restarted leader waits for a follower that knows its path for so long.
constexpr Duration kRejoin = 10s;
constexpr std::size_t kMaxUnrecorded = 512;  // Places of a leader that waits so.
/// First numbers of another path: no path of a mission comes so far. Their positions stay below 60 km.
constexpr std::uint32_t kFirstOfAnother = 65536, kOthers = 64;

}  // namespace

std::uint32_t ConvoyOrder::hash() const {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  const auto add = [&](char c) { hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u; };
  for (const std::string& robot : robots) {
    for (const char c : robot) add(c);
    add('\0');
  }
  return hash;
}

Result<void> Convoy::start(const ConvoyOrder& order) {
  const auto wrong = [](const std::string& text) -> Result<void> {
    return {Reason::bad_argument, "convoy: " + text};
  };
  const std::set<std::string> names(order.robots.begin(), order.robots.end());
  if (order.robots.size() < 2 || order.robots.size() > ConvoyOrder::kMaxRobots)
    return wrong("it takes 2 to " + std::to_string(ConvoyOrder::kMaxRobots) + " robots");
  if (names.size() != order.robots.size()) return wrong("a robot is named twice");
  const auto own = std::find(order.robots.begin(), order.robots.end(), params_.robot);
  if (own == order.robots.end()) return wrong(params_.robot + " is not in the order");
  if (in() && role_->order.robots.front() != order.robots.front())
    return wrong(params_.robot + " is in the convoy of " + role_->order.robots.front() +
                 "; take it out with peeloff first");
  set_role(Role{order, static_cast<std::size_t>(own - order.robots.begin()), false});
  rejoins_ = false;
  return {};
}

void Convoy::set_role(std::optional<Role> role) {
  const bool same = role && role_ && role->order == role_->order;
  role_ = std::move(role);
  if (same) return;
  members_.clear();
  trail_ = {};
  governor_ = nav::Governor{};
  along_.reset();
  gap_ = -1.0;
  state_ = State::forming;
  target_.reset();
  target_along_.reset();
  follow_speed_ = leader_limit_ = kInfinity;
  lost_reported_ = split_reported_ = false;
  aside_ = 0;
  refused_at_.reset();
  joined_.reset();
  misfit_since_.reset();
  unrecorded_.clear();
  rejoins_ = role_ && role_->index == 0;
  if (role_)
    for (const std::string& robot : role_->order.robots) members_.push_back({.name = robot});
}

Result<void> Convoy::leave() {
  if (!in()) return {Reason::not_in_convoy, std::string(describe(Reason::not_in_convoy))};
  role_->left = true;
  target_.reset();
  follow_speed_ = leader_limit_ = kInfinity;
  return {};
}

std::vector<std::string> Convoy::order() const {
  std::vector<std::string> names;
  if (!in()) return names;
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (i == role_->index || !members_[i].left) names.push_back(members_[i].name);
  return names;
}

std::vector<std::string> Convoy::others() const {
  std::vector<std::string> names = order();
  std::erase(names, params_.robot);
  return names;
}

const Convoy::Member* Convoy::predecessor() const {
  if (!follows()) return nullptr;
  for (std::size_t i = role_->index; i-- > 0;)
    if (!members_[i].left) return &members_[i];
  return nullptr;
}

bool Convoy::leader_known(Time now) const {
  if (!follows() || members_.front().left) return false;
  // An order may arrive before the first beacon; until then the robot does not move.
  if (!joined_ || now - *joined_ < kPredecessorTimeout) return true;
  const Member* ahead = predecessor();
  const Peer* peer = ahead ? inputs_.peers.find(ahead->name) : nullptr;
  return peer && peer->heard_beacon && now - peer->heard_beacon->at < kPredecessorTimeout;
}

bool Convoy::order_agrees() const {
  const Member* ahead = predecessor();
  return !ahead || !ahead->part || ahead->part->order_hash == role_->order.hash();
}

void Convoy::hear(Member& member) {
  const Peer* peer = inputs_.peers.find(member.name);
  if (!peer) return;
  member.length = peer->length;
  member.max_speed = peer->max_speed;
  if (!peer->heard_beacon) return;
  const HeardBeacon& heard = *peer->heard_beacon;
  if (heard.at == member.heard) return;
  member.heard = heard.at;
  member.period = heard.period;
  member.speed = heard.beacon.twist.vx;
  const auto& part = heard.beacon.convoy;
  const bool left_before = member.left;
  if (!part || part->convoy != role_->order.convoy) {
    member.left = member.left || member.spoke;
  } else {
    member.spoke = true;
    member.left = member.left || part->left;
    member.part = *part;
    const bool learns = role_->index > 0 || rejoins_;
    if (learns && part->order_hash == role_->order.hash()) learn(member, heard.at);
  }
  if (member.left && !left_before) governor_.member_left();
}

void Convoy::learn(const Member& member, Time now) {
  const ConvoyPart& part = *member.part;
  const bool fits = trail_.add(part.first, part.points) && part.first <= trail_.end();
  if (&member != predecessor() || part.points.empty()) return;
  if (fits) misfit_since_.reset();
  if (fits || trail_.empty()) return;
  // The predecessor has another path, or none of the points that are missing here.
  if (!misfit_since_) misfit_since_ = now;
  if (now - *misfit_since_ < kMisfit) return;
  trail_ = {};
  along_.reset();
  misfit_since_.reset();
}

void Convoy::tick(Time now) {
  if (!role_) return;
  if (!joined_) joined_ = now;
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (i != role_->index) hear(members_[i]);
  if (leads()) lead(now);
  if (follows()) follow(now);
}

void Convoy::lead(Time now) {
  const auto place = inputs_.place();
  const bool alone =
      std::all_of(members_.begin() + 1, members_.end(), [](const Member& m) { return m.left; });
  if (place) record(*place, now);
  leader_limit_ = kInfinity;
  if (alone) return;
  if (std::isfinite(role_->order.speed)) leader_limit_ = role_->order.speed;
  nav::Governor::Members members{};
  for (std::size_t i = 1; i < members_.size(); ++i) {
    const Member& m = members_[i];
    if (m.left) continue;
    if (m.max_speed > 0.0) leader_limit_ = std::min(leader_limit_, m.max_speed);
    members.silence = std::max(members.silence, seconds(now - (m.part ? m.heard : *joined_)));
    if (!m.part) continue;
    if (m.part->gap > members.longest_gap) {
      members.longest_gap = m.part->gap;
      members.slowest = std::max(0.0, m.speed);
    }
  }
  const double period = governed_ ? seconds(now - *governed_) : 0.0;
  governed_ = now;
  const auto verdict = governor_.step(members, role_->order.gap, period);
  if (verdict.share < 1.0) leader_limit_ = verdict.share * std::min(leader_limit_, params_.max_speed);
  leader_limit_ = std::min(leader_limit_, verdict.limit);
  if (verdict.split && !split_reported_)
    inputs_.notify_holder(Severity::warning, "convoy_split", Reason::leader_unknown,
                          "the convoy of " + params_.robot + " is split: a robot does not come after it");
  split_reported_ = verdict.split;
}

void Convoy::record(const Eigen::Vector3d& place, Time now) {
  if (rejoins_ && trail_.empty()) {
    // The path goes on from the newest point that a follower knows.
    const bool moved = unrecorded_.empty() || (place - unrecorded_.back()).norm() > nav::Trail::kSpacing / 2;
    if (moved && unrecorded_.size() < kMaxUnrecorded) unrecorded_.push_back(place);
    if (now - *joined_ < kRejoin) return;
    // No follower knows it: another path begins, with numbers that the former one never had.
    trail_.begin(kFirstOfAnother + static_cast<std::uint32_t>(now.time_since_epoch() / 1s % kOthers) *
                                       static_cast<std::uint32_t>(nav::Trail::kCapacity));
  }
  rejoins_ = false;
  for (const Eigen::Vector3d& before : std::exchange(unrecorded_, {})) trail_.record(before);
  trail_.record(place);
  along_ = trail_.leader_at(place);
}

double Convoy::gap_to(const Member& ahead, Time now) const {
  const double other = ahead.length > 0.0 ? ahead.length : params_.length;
  const double since = std::min(seconds(now - ahead.heard), kMaxExtrapolation);
  return ahead.part->along + since * ahead.speed - *along_ - (other + params_.length) / 2;
}

bool Convoy::locate(const Eigen::Vector3d& place) {
  const auto on = [&](double from, double to) {
    return *trail_.project(place, std::max(from, trail_.start()), std::min(to, trail_.length()));
  };
  const auto away = [](const nav::Trail::Projection& p) { return p.offset > kOffPath && p.along >= 0.0; };
  auto nearest = on(along_ ? *along_ - kSearch : -kInfinity, along_ ? *along_ + kSearch : kInfinity);
  // A robot that was carried, or whose map jumped, looks for itself on the complete path.
  if (away(nearest)) nearest = on(-kInfinity, kInfinity);
  along_ = nearest.along;
  return !away(nearest);
}

bool Convoy::halts(const Member& ahead, Time now) const {
  const Member& leader = members_.front();
  const bool leader_stands = leader.part && now - leader.heard < kHalts && std::fabs(leader.speed) < kStands;
  return leader_stands || std::fabs(ahead.speed) < kStands;
}

std::string Convoy::hindrance(Time now) const {
  if (!follows() || state_ == State::lost) return {};
  const Member& leader = members_.front();
  if (leader.left) return leader.name + ", the leader, left the convoy";
  const Member* ahead = predecessor();
  if (now - ahead->heard >= kPredecessorTimeout)
    return lost_reported_ ? std::string() : params_.robot + " does not hear " + ahead->name;
  if (!ahead->part) return ahead->name + " does not say that it is in this convoy";
  if (!order_agrees()) return ahead->name + " has another order of the convoy";
  if (trail_.empty() || !ahead->part->placed) return "the path of " + leader.name + " is not known yet";
  if (misses_path(*ahead)) return "a part of the path of " + leader.name + " is not known yet";
  return {};
}

bool Convoy::misses_path(const Member& ahead) const {
  const bool begins = trail_.first() == 0 || (along_ && *along_ > trail_.start());
  return !begins || ahead.part->along > trail_.length() + kMissing;
}

void Convoy::follow(Time now) {
  follow_speed_ = 0.0;
  const auto stand = [this](State state) {
    state_ = state;
    target_.reset();
    target_along_.reset();
  };
  const auto place = inputs_.place();
  const bool on_path = place && !trail_.empty() && locate(*place);
  const Member* ahead = predecessor();
  if (!ahead || members_.front().left) return stand(State::ended);
  const bool agrees = ahead->part && ahead->part->order_hash == role_->order.hash();
  if (!agrees || !ahead->part->placed || !place || !along_) return stand(State::forming);
  gap_ = gap_to(*ahead, now);
  const double rest = role_->order.gap;
  double stop = *along_ + gap_ - rest;
  const double most = std::isfinite(role_->order.speed)
                          ? std::min(params_.max_speed, kClosingUp * role_->order.speed)
                          : params_.max_speed;
  // Without the rest of the path: on to its end, less the gap, because there the others were last.
  const double end = trail_.length() - rest - params_.length;
  const Duration silence = now - ahead->heard;
  if (silence > std::max(kMinLost, 4 * ahead->period)) {
    stop = std::max(stop, end);
    follow_speed_ = std::min(most, kLostSpeed);
    if (!std::exchange(lost_reported_, true))
      inputs_.notify_holder(
          Severity::warning, "convoy_lost", Reason::leader_unknown,
          params_.robot + " does not hear " + ahead->name + ", and follows the known path to its end");
    state_ = State::lost;
    return choose_target(stop, stop, true);
  }
  lost_reported_ = false;
  const nav::Spacing spacing{.standstill = rest};
  const double speed = halts(*ahead, now) ? spacing.halting_speed(gap_, ahead->speed, most)
                                          : spacing.speed(gap_, ahead->speed, most);
  const bool stands = std::fabs(ahead->speed) < kStands;
  if (stands && stop - *along_ < kDeadBand) return stand(State::waiting);
  follow_speed_ = on_path ? speed : std::min(speed, kFormingSpeed);
  state_ = on_path ? State::following : State::forming;
  if (misses_path(*ahead)) return choose_target(std::min(stop, end), std::min(stop, end), true);
  choose_target(stop, std::max(stop, *along_ + gap_ - kBehind), stands);
}

void Convoy::choose_target(double stop, double reach, bool stands) {
  reach = std::min(reach, trail_.length());
  const double own = *along_;
  const bool known = reach >= trail_.start() || trail_.first() == 0;
  // Nearer than the gap at rest, it follows a robot that drives on, but does not start.
  const bool starts = stop > own || target_along_;
  if (!known || !starts || reach <= own) {
    target_.reset();
    target_along_.reset();
    return;
  }
  // Before the beginning the path is the straight line to it.
  const Eigen::Vector3d beginning = trail_.at(0.0);
  const auto place = inputs_.place();
  const auto at = [&](double along) -> Eigen::Vector3d {
    if (along >= 0.0 || own >= 0.0 || !place) return trail_.at(along);
    return beginning + along / own * (*place - beginning);
  };
  // Where another robot stands, one that left the convoy for instance, the place behind it is the next one.
  const auto occupied = [&](double along) {
    const Eigen::Vector2d there = at(along).head<2>();
    return std::any_of(inputs_.peers.all().begin(), inputs_.peers.all().end(), [&](const Peer& peer) {
      if (const Member* ahead = predecessor(); ahead && ahead->name == peer.name) return false;
      const double near = (peer.length + params_.length) / 2 + kBeside;
      return peer.present && peer.heard_beacon &&
             (peer.heard_beacon->beacon.pose.position() - there).norm() < near;
    });
  };
  const double candidate = std::min(reach, own + kLookAhead);
  const double renewal = stands ? kMinRenewal / 4 : kMinRenewal;
  // The estimate of where the predecessor is goes to and fro.
  const bool keeps = target_along_ && *target_along_ <= reach + kBehind / 2 &&
                     (*target_along_ - own > kRenew || candidate - *target_along_ < renewal) &&
                     !occupied(*target_along_);
  if (keeps) return;
  target_along_ = candidate;
  if (trail_.first() > 0) target_along_ = std::max(*target_along_, trail_.start());
  while (occupied(*target_along_) && *target_along_ + nav::Trail::kSpacing <= reach)
    *target_along_ += nav::Trail::kSpacing;
  if (refused_at_ && own > *refused_at_ + kBackOnPath) {
    refused_at_.reset();
    aside_ = 0;
  }
  target_ = beside(at(*target_along_));
}

Eigen::Vector3d Convoy::beside(const Eigen::Vector3d& place) {
  const auto own = inputs_.place();
  const Eigen::Vector3d step =
      trail_.at(*target_along_ + kBeforeAndAfter) - trail_.at(*target_along_ - kBeforeAndAfter);
  if (!inputs_.free || !own || step.head<2>().norm() < 1e-3) return place;
  // Free itself with some room, and along the straight line to it: it could be behind a wall.
  const auto free = [&](const Eigen::Vector2d& at) {
    for (const auto& [x, y] : kAround)
      if (!inputs_.free(at + kRoom * Eigen::Vector2d(x, y))) return false;
    const Eigen::Vector2d from = own->head<2>(), way = at - from;
    for (double along = params_.length / 2; along < way.norm(); along += kRoom)
      if (!inputs_.free(from + way.normalized() * along)) return false;
    return true;
  };
  const Eigen::Vector3d left = Eigen::Vector3d(-step.y(), step.x(), 0.0).normalized();
  for (std::size_t i = aside_; i < kAside.size(); ++i)
    if (const Eigen::Vector3d there = place + kAside[i] * left; free(there.head<2>())) return there;
  return place + kAside[aside_] * left;
}

void Convoy::target_refused() {
  if (!target_along_) return;
  refused_at_ = *along_;
  aside_ = (aside_ + 1) % kAside.size();
  target_along_.reset();
}

std::uint32_t Convoy::wanted() const {
  if (trail_.empty()) return UINT32_MAX;
  const bool covers = trail_.first() == 0 || (along_ && *along_ > trail_.start() + nav::Trail::kSpacing);
  if (covers) return trail_.end();
  constexpr std::uint32_t piece = ConvoyPart::kPoints;
  return trail_.first() > piece ? trail_.first() - piece : 0;
}

std::optional<ConvoyPart> Convoy::part(std::uint32_t seq) const {
  if (!role_) return std::nullopt;
  ConvoyPart part{};
  part.convoy = role_->order.convoy;
  part.order_hash = role_->order.hash();
  part.index = static_cast<std::uint8_t>(role_->index);
  part.left = role_->left;
  if (role_->left) return part;
  part.placed = along_.has_value();
  part.along = along_.value_or(0.0);
  part.gap = gap_;
  part.wanted = wanted();
  if (trail_.empty()) return part;
  constexpr std::uint32_t piece = ConvoyPart::kPoints;
  const std::uint32_t newest = std::max(trail_.first(), trail_.end() - std::min(trail_.end(), piece));
  part.first = newest;
  // Every second beacon carries what the members behind lack.
  if (seq % 2 == 1)
    for (std::size_t i = role_->index + 1; i < members_.size(); ++i)
      if (const auto& other = members_[i].part; other && !members_[i].left)
        part.first = std::clamp(other->wanted, trail_.first(), part.first);
  for (std::uint32_t n = part.first; n < trail_.end() && part.points.size() < piece; ++n)
    part.points.push_back(trail_.point(n));
  return part;
}

}  // namespace adit::agent
