// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "core/command/words.hpp"

namespace adit::station {

std::string fixed(double value, int decimals) {
  constexpr double kLargest = 1e12;  // More means nothing, and would fill a line.
  if (!(std::abs(value) < kLargest)) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  std::string out(buffer);
  if (out.starts_with('-') && out.find_first_not_of("-0.") == std::string::npos) out.erase(0, 1);
  return out;
}

std::string code_text(std::string code) {
  std::ranges::replace(code, '_', ' ');
  return code;
}

std::string size_text(const Size& size) {
  if (size.length <= 0.0F || size.width <= 0.0F) return "-";
  return fixed(size.length, 2) + " x " + fixed(size.width, 2) +
         (size.height > 0.0F ? " x " + fixed(size.height, 2) : "") + " m";
}

std::string limits_text(const Robot& robot) {
  std::vector<std::string> limits{fixed(robot.max_speed, 1) + " m/s", fixed(robot.max_turn, 1) + " rad/s"};
  if (robot.max_acceleration > 0.0F) limits.push_back(fixed(robot.max_acceleration, 1) + " m/s2");
  if (robot.max_step > 0.0F) limits.push_back("steps of " + fixed(robot.max_step, 2) + " m");
  if (robot.max_slope > 0.0F)
    limits.push_back("slopes of " + fixed(robot.max_slope * 180.0 / std::numbers::pi, 0) + " degrees");
  limits.push_back(robot.climbs_stairs ? "climbs stairs" : "no stairs");
  if (robot.holonomic) limits.push_back("moves sideways");
  return command::joined(limits, "-");
}

std::string motion_text(const Robot& robot) {
  constexpr double kLeastSpeed = 0.05, kLeastTurn = 0.05;  // m/s, rad/s: of odometry at rest.
  if (!robot.located || !(std::hypot(robot.vx, robot.vy) > kLeastSpeed || std::abs(robot.wz) > kLeastTurn))
    return {};
  if (is_by_hand(robot.mode)) return "driven by hand";
  const auto self = std::find(robot.convoy.begin(), robot.convoy.end(), robot.name);
  if (self != robot.convoy.end() && self != robot.convoy.begin()) return "follows " + *std::prev(self);
  return "moves without a goal";
}

std::string standstill_text(const Robot& robot) {
  if (robot.reason == Reason::none || robot.moving_allowed) return {};
  return std::string(describe(robot.reason));
}

std::string recovery_text(RecoveryState state) {
  static constexpr std::array kTexts{
      "",         "waits for what is in its way", "moves away from an obstacle",
      "backs up", "looks for another way",        "found no way, looks again now and then"};
  return kTexts[static_cast<std::size_t>(state)];
}

std::string exploration_text(const contract::Exploration& e) {
  return std::string(to_string(e.phase)) +
         (e.reason == Reason::none ? "" : " (" + std::string(describe(e.reason)) + ")") + ", " +
         fixed(e.volume, 0) + " m3, about " + fixed(e.share * 100.0, 0) + "%, " + std::to_string(e.open) +
         " frontiers left, " + std::to_string(e.unreachable) + " out of reach";
}

std::string area_text(const Area& area) {
  std::string text = area.name + " " + std::string(name(area.kind));
  if (area.kind == AreaKind::prefer) text += " weight " + fixed(area.weight, 1);
  for (const auto& corner : area.corners) text += ", " + fixed(corner[0], 1) + " " + fixed(corner[1], 1);
  if (std::isfinite(area.z_min)) text += ", from z " + fixed(area.z_min, 1);
  if (std::isfinite(area.z_max)) text += ", up to z " + fixed(area.z_max, 1);
  return text;
}

}  // namespace adit::station
