// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/convoy_follow.hpp"

#include <cmath>

#include "core/store/pack.hpp"
#include "robot_agent/common/identity.hpp"
#include "robot_agent/convoy/convoy.hpp"

namespace adit::agent {
namespace {

constexpr std::string_view kInConvoy = "in_convoy", kLeaderKnown = "leader_known",
                           kOrderAgrees = "order_agrees";
constexpr std::size_t kMaxName = 32;

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

void ConvoyFollowMode::tick(bool passes, Time now) {
  if (!context_.convoy) return;
  const auto& target = context_.convoy->target();
  if (target)
    context_.output.write(GoTo{{target->x(), target->y(), std::nan("")}}, now);
  else
    context_.output.write(Stand{}, now);
  if (!passes || !target || !(navigated_.blocked || navigated_.unreachable)) free_since_ = now;
  const bool impassable = now - free_since_ >= kImpassableAfter;
  if (impassable && !impassable_)
    context_.tell_holder({{},
                          Severity::warning,
                          "trail_impassable",
                          Reason::trail_impassable,
                          std::string(describe(Reason::trail_impassable))});
  impassable_ = impassable;
}

ModeProgress ConvoyFollowMode::progress(bool passes) const {
  if (!passes || !impassable_ || !context_.convoy->target()) return {};
  return {
      .state = GoalState::blocked, .goal = *context_.convoy->target(), .reason = Reason::trail_impassable};
}

void ConvoyFollowMode::store(KeptBehaviour& kept) const {
  if (!context_.convoy || !context_.convoy->role()) return;
  const Convoy::Role& role = *context_.convoy->role();
  store::Packer out;
  out.put(role.order.convoy).put(role.order.gap).put(role.order.speed).flag(role.left);
  out.put(static_cast<std::uint8_t>(role.index)).put(static_cast<std::uint8_t>(role.order.robots.size()));
  for (const std::string& robot : role.order.robots) out.text(robot);
  kept.modes.push_back({std::string(row().name), out.bytes()});
}

void ConvoyFollowMode::restore(const KeptBehaviour& kept) {
  const store::Bytes* bytes = kept.of(row().name);
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
