// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/convoy/convoy.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace adit::agent {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLookAhead = 2.5;  // m: farther, a route between two places would cut the leader's corners.
constexpr double kBeside = 0.3;     // m: clearance from a robot that stands on the path.
constexpr double kRenew = 1.25;     // m: from here on the robot would brake for the place.
constexpr double kStands = 0.05;    // m/s: slower is standing.
/// Error of the gap to a standing predecessor that is left as it is, m: the robot would creep for seconds.
constexpr double kDeadBand = 0.4;
constexpr double kLostSpeed = 0.5;   // m/s
constexpr double kClosingUp = 1.25;  // Followers may drive faster than the leader by this factor.
constexpr double kSearch = 5.0;      // m: path that is searched for the robot around its last position.
constexpr double kOffPath = 3.0;     // m: a robot farther away from the path is not on it.

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
  lost_told_ = split_told_ = false;
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
  if (!part || part->convoy != role_->order.convoy) {
    member.left = member.left || member.spoke;
    return;
  }
  member.spoke = true;
  member.left = member.left || part->left;
  member.part = *part;
  const bool learns = role_->index > 0 || rejoins_;
  if (learns && part->order_hash == role_->order.hash()) (void)trail_.add(part->first, part->points);
}

void Convoy::tick(Time now) {
  if (!role_) return;
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (i != role_->index) hear(members_[i]);
  if (leads()) lead(now);
  if (follows()) follow(now);
}

void Convoy::lead(Time now) {
  const auto place = inputs_.place();
  const bool alone =
      std::all_of(members_.begin() + 1, members_.end(), [](const Member& m) { return m.left; });
  // The path goes on from the newest point that a follower knows.
  if (rejoins_ && !trail_.empty()) rejoins_ = false;
  if (place && !rejoins_) {
    trail_.record(*place);
    along_ = trail_.leader_at(*place);
  }
  leader_limit_ = kInfinity;
  if (alone) return;
  if (std::isfinite(role_->order.speed)) leader_limit_ = role_->order.speed;
  nav::Governor::Members members{};
  for (std::size_t i = 1; i < members_.size(); ++i) {
    const Member& m = members_[i];
    if (m.left) continue;
    if (m.max_speed > 0.0) leader_limit_ = std::min(leader_limit_, m.max_speed);
    if (!m.part) continue;
    members.silence = std::max(members.silence, seconds(now - m.heard));
    if (m.part->gap > members.longest_gap) {
      members.longest_gap = m.part->gap;
      members.slowest = std::max(0.0, m.speed);
    }
  }
  const double period = governed_ ? seconds(now - *governed_) : 0.0;
  governed_ = now;
  const auto verdict = governor_.step(members, role_->order.gap, period);
  leader_limit_ = std::min(leader_limit_, verdict.limit);
  if (verdict.split && !split_told_)
    tell(Severity::warning, "convoy_split", Reason::leader_unknown,
         "the convoy of " + params_.robot + " is split: a robot does not come after it");
  split_told_ = verdict.split;
}

double Convoy::gap_to(const Member& ahead) const {
  const double other = ahead.length > 0.0 ? ahead.length : params_.length;
  return ahead.part->along - *along_ - (other + params_.length) / 2;
}

void Convoy::follow(Time now) {
  follow_speed_ = 0.0;
  const auto stand = [this](State state) {
    state_ = state;
    target_.reset();
    target_along_.reset();
  };
  const auto place = inputs_.place();
  if (place && !trail_.empty()) {
    const double from = along_ ? *along_ - kSearch : -kInfinity, to = along_ ? *along_ + kSearch : kInfinity;
    const auto on = trail_.project(*place, std::max(from, trail_.start()), std::min(to, trail_.length()));
    along_ = on->along;
    // A robot that was carried, or whose map jumped, looks for itself on the whole path.
    if (on->offset > kOffPath && on->along >= 0.0) along_.reset();
  }
  const Member* ahead = predecessor();
  if (!ahead || members_.front().left) return stand(State::ended);
  const bool agrees = ahead->part && ahead->part->order_hash == role_->order.hash();
  if (!agrees || !ahead->part->placed || !place || !along_) return stand(State::forming);
  gap_ = gap_to(*ahead);
  const double rest = role_->order.gap;
  double stop = *along_ + gap_ - rest;
  const double most = std::isfinite(role_->order.speed)
                          ? std::min(params_.max_speed, kClosingUp * role_->order.speed)
                          : params_.max_speed;
  const Duration silence = now - ahead->heard;
  if (silence > std::max(kMinLost, 4 * ahead->period)) {
    // On to the end of the path, less the gap: there the others were last.
    stop = std::max(stop, trail_.length() - rest - params_.length);
    follow_speed_ = std::min(most, kLostSpeed);
    if (!std::exchange(lost_told_, true))
      tell(Severity::warning, "convoy_lost", Reason::leader_unknown,
           params_.robot + " does not hear " + ahead->name + ", and follows the known path to its end");
    state_ = State::lost;
    return choose_target(stop, follow_speed_);
  }
  lost_told_ = false;
  const nav::Spacing spacing{.standstill = rest};
  follow_speed_ = spacing.speed(gap_, ahead->speed, most);
  if (std::fabs(ahead->speed) < kStands && stop - *along_ < kDeadBand) return stand(State::waiting);
  state_ = State::following;
  choose_target(stop, follow_speed_);
}

void Convoy::choose_target(double stop, double limit) {
  stop = std::min(stop, trail_.length());
  const double own = *along_;
  const bool reaches = stop > own && (stop >= trail_.start() || trail_.first() == 0) && limit > 0.0;
  if (!reaches) {
    target_.reset();
    target_along_.reset();
    return;
  }
  // Where another robot stands, one that left the convoy for instance, the place behind it is the next one.
  const auto occupied = [&](double along) {
    const Eigen::Vector2d at = trail_.at(along).head<2>();
    return std::any_of(inputs_.peers.all().begin(), inputs_.peers.all().end(), [&](const Peer& peer) {
      const double reach = (peer.length + params_.length) / 2 + kBeside;
      return peer.present && peer.heard_beacon &&
             (peer.heard_beacon->beacon.pose.position() - at).norm() < reach;
    });
  };
  // A place that changes with every cycle never gets a plan, so one is kept until the robot is near it.
  const bool last = target_along_ && stop - *target_along_ < nav::Trail::kSpacing / 2;
  const bool keeps = target_along_ && *target_along_ <= stop && (*target_along_ - own > kRenew || last) &&
                     !occupied(*target_along_);
  if (keeps) return;
  target_along_ = std::min(stop, own + kLookAhead);
  if (trail_.first() > 0) target_along_ = std::max(*target_along_, trail_.start());
  while (occupied(*target_along_) && *target_along_ + nav::Trail::kSpacing <= stop)
    *target_along_ += nav::Trail::kSpacing;
  target_ = trail_.at(*target_along_);
  // Before the beginning the path is the straight line to it.
  if (const auto place = inputs_.place(); *target_along_ < 0.0 && place)
    *target_ += *target_along_ / own * (*place - trail_.at(0.0));
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

void Convoy::tell(Severity severity, const char* code, Reason reason, std::string text) const {
  inputs_.tell_holder({{}, severity, code, reason, std::move(text)});
}

}  // namespace adit::agent
