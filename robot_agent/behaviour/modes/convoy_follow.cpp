// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/convoy_follow.hpp"

#include <cmath>
#include <cstdio>

#include "core/store/pack.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/convoy/convoy.hpp"

namespace adit::agent {
namespace {

constexpr std::string_view kInConvoy = "in_convoy", kLeaderKnown = "leader_known",
                           kOrderAgrees = "order_agrees";
constexpr std::size_t kMaxName = 32;
constexpr double kMoved = 0.3;      // m: less is no motion along the path.
constexpr double kSlow = 0.1;       // m/s: at a lower limit the robot may stand.
constexpr double kSamePlace = 1.0;  // m

/// The longest route to a place of the path that is `straight` metres away, m: another robot's path is not
/// followed by a detour through other rooms.
double max_route(double straight) { return 5.0 + 1.5 * straight; }

}  // namespace

ModeRow ConvoyFollowMode::row() {
  using namespace conditions;
  static constexpr Condition in_convoy{"InConvoy", Reason::not_in_convoy,
                                       [](const Facts& f) { return f.has(kInConvoy); }, Scope::terminal};
  static constexpr Condition leader_known{"LeaderKnown", Reason::leader_unknown,
                                          [](const Facts& f) { return f.has(kLeaderKnown); },
                                          Scope::continuous};
  static constexpr Condition order_agrees{"OrderAgrees", Reason::order_differs,
                                          [](const Facts& f) { return f.has(kOrderAgrees); },
                                          Scope::continuous};
  return {.name = "convoy_follow",
          .commanded_by = {.holder = true},
          .goal = GoalOnLeaving::cleared,
          .on_failure = OnFailure::pauses,
          .on_handover = OnHandover::falls_to_hold,
          .conditions = {kNotStopped, in_convoy, kDriverAlive, kLocalised, kTerrainFresh, leader_known,
                         order_agrees},
          .make = ConvoyFollowMode::make,
          .output_lifetime = 500ms,
          .optional = true};
}

void ConvoyFollowMode::note(Facts& facts, Time now) const {
  const Convoy* convoy = context_.convoy;
  if (!convoy || !convoy->follows()) return;
  facts.also.push_back(kInConvoy);
  if (convoy->leader_known(now)) facts.also.push_back(kLeaderKnown);
  if (convoy->order_agrees()) facts.also.push_back(kOrderAgrees);
}

void ConvoyFollowMode::clear() {
  if (context_.convoy && context_.convoy->follows()) (void)context_.convoy->leave();
}

void ConvoyFollowMode::enter(Time now) {
  free_since_ = moved_since_ = now;
  moved_at_.reset();
  reported_at_.reset();
}

void ConvoyFollowMode::tick(bool passes, Time now) {
  if (!context_.convoy) return;
  const auto& target = context_.convoy->target();
  const auto pose = context_.pose();
  if (target) {
    // Each change begins a new route.
    if (pose && target->head<2>() != next_.goal.head<2>())
      next_ = {.goal = {target->x(), target->y(), std::nan("")},
               .max_route = max_route((target->head<2>() - pose->position()).norm()),
               .continues = true};
    context_.output.write(next_, now);
  } else {
    context_.output.write(Stand{}, now);
  }
  if (!passes || !target || !navigated_.unreachable()) tried_ = now;
  if (now - tried_ >= kTriesAfter) {
    tried_ = now;
    context_.convoy->target_refused();
  }
  reason_ = watch(passes, now);
  if (reason_ == Reason::none || !pose) return;
  // Once for each place and matter.
  if (reported_at_ && reported_ == reason_ && (*reported_at_ - pose->position()).norm() < kSamePlace) return;
  reported_at_ = pose->position();
  reported_ = reason_;
  const std::string hindrance = context_.convoy->hindrance(now);
  char place[64];
  std::snprintf(place, sizeof place, " at %.1f %.1f", pose->x, pose->y);
  if (reason_ == Reason::trail_impassable)
    context_.notify_holder(Severity::warning, "trail_impassable", reason_,
                           std::string(describe(reason_)) + ", and waits" + place);
  else
    context_.notify_holder(Severity::warning, "convoy_waits", reason_, hindrance + ", and it waits" + place);
}

Reason ConvoyFollowMode::watch(bool passes, Time now) {
  const auto& target = context_.convoy->target();
  const auto pose = context_.pose();
  const std::string hindrance = context_.convoy->hindrance(now);
  const bool drives = passes && target && !navigated_.arrived && context_.convoy->speed_limit(true) > kSlow;
  if (!passes || !target || !navigated_.blocked) free_since_ = now;
  const bool moved = pose && (!moved_at_ || (*moved_at_ - pose->position()).norm() > kMoved);
  if (moved) moved_at_ = pose->position();
  if (moved || (!drives && hindrance.empty())) moved_since_ = now;
  if (now - free_since_ >= kImpassableAfter) return Reason::trail_impassable;
  if (now - moved_since_ < kStandsAfter) return Reason::none;
  if (hindrance.empty()) return Reason::trail_impassable;
  return context_.convoy->order_agrees() ? Reason::leader_unknown : Reason::order_differs;
}

ModeProgress ConvoyFollowMode::progress(bool passes) const {
  if (!passes || reason_ == Reason::none) return {};
  const auto pose = context_.pose();
  const auto& target = context_.convoy->target();
  ModeProgress blocked{.state = GoalState::blocked, .reason = reason_};
  if (target)
    blocked.goal = *target;
  else if (pose)
    blocked.goal.head<2>() = pose->position();
  return blocked;
}

void ConvoyFollowMode::store(StoredBehaviour& stored) const {
  if (!context_.convoy || !context_.convoy->role()) return;
  const Convoy::Role& role = *context_.convoy->role();
  store::Packer out;
  out.put(role.order.convoy).put(role.order.gap).put(role.order.speed).flag(role.left);
  out.put(static_cast<std::uint8_t>(role.index)).put(static_cast<std::uint8_t>(role.order.robots.size()));
  for (const std::string& robot : role.order.robots) out.text(robot);
  stored.modes.push_back({std::string(row().name), out.bytes()});
}

void ConvoyFollowMode::restore(const StoredBehaviour& stored) {
  const store::Bytes* bytes = stored.of(row().name);
  if (!bytes || !context_.convoy) return;
  store::Unpacker in(*bytes);
  Convoy::Role role{};
  role.order.convoy = in.get<std::uint64_t>();
  role.order.gap = in.number();
  role.order.speed = in.number();
  role.left = in.flag();
  role.index = in.get<std::uint8_t>();
  const std::size_t count = in.get<std::uint8_t>();
  if (!in.good() || count > ConvoyOrder::kMaxRobots) return;
  bool valid = true;
  for (std::size_t i = 0; i < count; ++i) {
    role.order.robots.push_back(in.text(kMaxName));
    valid = valid && valid_name(role.order.robots.back());
  }
  if (in.done() && valid && role.index < count && std::isfinite(role.order.gap))
    context_.convoy->set_role(role);
}

}  // namespace adit::agent
