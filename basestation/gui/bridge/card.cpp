// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/card.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "basestation/gui/break.hpp"
#include "basestation/model/route.hpp"
#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using station::GoalState;
using station::Robot;

std::string upper(const std::string& code) {
  std::string text = station::code_text(code);
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

std::string glyph_of(const std::string& platform) {
  if (platform == "wheeled") return "wheels";
  if (platform == "tracked") return "tracks";
  if (platform == "legged") return "legs";
  if (platform == "aerial") return "rotor";
  return "unknown";
}

void headline(Card& card, const Robot& robot) {
  const auto set = [&](std::string word, Token token, std::string shape) {
    card.headline = std::move(word);
    card.headline_token = token;
    card.shape = std::move(shape);
  };
  const bool drives = robot.mode != "hold" && !robot.mode.empty();
  const bool waits = drives && !robot.moving_allowed && robot.reason != Reason::none;
  if (card.contact == Contact::lost) return set("LOST", Token::bad, "square");
  if (robot.stopped || !robot.stops.empty()) return set("STOP", Token::bad, "square");
  if (robot.goal_state == GoalState::blocked || robot.reason == Reason::blocked)
    return set("BLOCKED", Token::bad, "square");
  if (!robot.troubles.empty()) return set(upper(robot.mode), Token::warn, "triangle");
  if (waits) return set(upper(robot.mode) + " WAITS", Token::warn, "triangle");
  if (drives) return set(upper(robot.mode), Token::ok, "disc");
  set(robot.mode.empty() ? "NOT HEARD YET" : upper(robot.mode), Token::none, "ring");
}

struct Words {
  std::string full{};
  std::string brief{};  ///< Without names and numbers of any length; empty: the full ones are short.
};

Words detail(const Card& card, const Robot& robot, double age) {
  if (card.contact == Contact::lost) return {"last heard " + age_text(age) + " ago"};
  if (!robot.stops.empty())
    return {"stopped by " + command::joined(robot.stops, ""),
            robot.stops.size() == 1 ? "stopped by one operator"
                                    : "stopped by " + std::to_string(robot.stops.size()) + " operators"};
  if (robot.stopped) return {"stopped"};
  if (!robot.troubles.empty())
    return {command::joined(robot.troubles, ""),
            robot.troubles.size() == 1 ? "one component in trouble"
                                       : std::to_string(robot.troubles.size()) + " components in trouble"};
  if (const std::string why = station::standstill_text(robot); !why.empty())
    return {why, station::code_text(std::string(name(robot.reason)))};
  if (!robot.yields_to.empty()) return {"makes way for " + robot.yields_to, "makes way for a robot"};
  if (robot.recovery != station::RecoveryState::drive) {
    static constexpr std::array kBrief{"",         "waits",           "moves away",
                                       "backs up", "looks for a way", "found no way"};
    return {station::recovery_text(robot.recovery), kBrief[static_cast<std::size_t>(robot.recovery)]};
  }
  if (!robot.described) return {"capabilities not heard yet"};
  if (robot.localisation == Localisation::weak) return {"position is weak"};
  if (robot.localisation == Localisation::lost) return {"does not know where it is"};
  if (robot.exploration.phase != station::ExplorationPhase::none && robot.mode == "explore")
    return {std::string(to_string(robot.exploration.phase)) + ", " + std::to_string(robot.exploration.open) +
            " frontiers left"};
  const std::string motion = station::motion_text(robot);
  const bool by_hand = station::is_by_hand(robot.mode);
  if ((robot.goal_state == GoalState::active || robot.goal_state == GoalState::kept) &&
      !(by_hand && !motion.empty()))
    return {(robot.goal_state == GoalState::active ? "to " : "goal kept: ") +
            station::fixed(robot.goal[0], 1) + " " + station::fixed(robot.goal[1], 1)};
  if (robot.goal_state == GoalState::reached) return {"arrived"};
  if (!motion.empty()) return {motion, motion.substr(0, motion.find(' '))};
  return {"ready"};
}

}  // namespace

std::string age_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e7) return "-";
  if (seconds < 9.95) return station::fixed(seconds, 1) + " s";
  if (seconds < 120.0) return station::fixed(seconds, 0) + " s";
  if (seconds < 7200.0) return station::fixed(std::floor(seconds / 60.0), 0) + " min";
  return station::fixed(std::floor(seconds / 3600.0), 0) + " h";
}

Card card_of(const Robot& robot, int number, double silent, double stale_after) {
  Card card{
      .number = number, .name = robot.name, .glyph = glyph_of(robot.platform), .platform = robot.platform};
  const double age = robot.age + silent;
  card.contact = contact_of(robot, silent, stale_after);
  if constexpr (kBreakStaleFade) card.contact = Contact::live;
  card.owner = owner_of(robot);
  card.holder = robot.mine ? "mine" : robot.holder.empty() ? "no holder" : robot.holder;
  if (robot.locked) card.holder += ", locked";
  headline(card, robot);
  card.short_headline = card.headline.ends_with(" WAITS") ? "WAITS" : card.headline;
  Words words = detail(card, robot, age);
  card.short_detail = words.brief.empty() ? words.full : std::move(words.brief);
  card.detail = std::move(words.full);
  const bool battery = robot.battery >= 0.0F && robot.battery <= 1.0F;
  card.battery = battery ? station::fixed(100.0 * robot.battery, 0) + " %" : "-";
  card.speed = robot.located ? station::fixed(std::hypot(robot.vx, robot.vy), 1) + " m/s" : "-";
  const bool goal = robot.goal_state != GoalState::none && robot.goal_state != GoalState::reached;
  if (goal && robot.located) {
    const station::RouteRest route = station::rest_of_route(robot);
    const double straight = std::hypot(robot.goal[0] - robot.x, robot.goal[1] - robot.y);
    card.goal = station::fixed(route.complete ? route.length : straight, 0) + " m";
  }
  card.age = age_text(age);
  return card;
}

}  // namespace adit::gui
