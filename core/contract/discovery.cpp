// SPDX-License-Identifier: Apache-2.0
#include "core/contract/discovery.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "adit/discovery.h"
#include "core/command/words.hpp"

namespace adit::contract {
namespace {

constexpr std::string_view kNameTaken = "name_taken:";

/// Amounts of any ground or aerial robot that a team has, SI units; 0 is always allowed: unknown, or none.
struct Limit {
  const char *name, *unit;
  float (radio::Capabilities::*amount)() const;
  float Capabilities::*known;
  float least, most;
  /// False for NaN.
  bool permits(float value) const { return value == 0.0F || (value >= least && value <= most); }
};
constexpr Limit kLimits[]{
    {"length", "m", &radio::Capabilities::length, &Capabilities::length, 0.05F, 20.0F},
    {"width", "m", &radio::Capabilities::width, &Capabilities::width, 0.05F, 20.0F},
    {"height", "m", &radio::Capabilities::height, &Capabilities::height, 0.02F, 20.0F},
    {"max_speed", "m/s", &radio::Capabilities::max_speed, &Capabilities::max_speed, 0.0F, 50.0F},
    {"max_turn", "rad/s", &radio::Capabilities::max_turn, &Capabilities::max_turn, 0.0F, 50.0F},
    {"max_acceleration", "m/s2", &radio::Capabilities::max_acceleration, &Capabilities::max_acceleration,
     0.0F, 100.0F},
    {"max_step", "m", &radio::Capabilities::step, &Capabilities::max_step, 0.0F, 5.0F},
    {"max_slope", "rad", &radio::Capabilities::slope, &Capabilities::max_slope, 0.0F, 1.6F},
};

AgentKind kind_of(radio::AgentKind kind) { return known_or(kind, AgentKind::station, AgentKind::robot); }

}  // namespace

bool offers(const std::vector<std::string>& services, std::string_view word) {
  return std::find(services.begin(), services.end(), word) != services.end();
}

std::string service_word(const NameClaim& claim) {
  char digits[17]{};
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(claim.start));
  return std::string(kNameTaken) + (claim.held ? "held:" : "free:") + digits;
}

std::optional<NameClaim> claim_of(const std::vector<std::string>& services) {
  for (const std::string& word : services) {
    if (!word.starts_with(kNameTaken)) continue;
    NameClaim claim{.held = word.substr(kNameTaken.size(), 5) == "held:"};
    const std::size_t digits = kNameTaken.size() + 5;
    if (word.size() > digits)
      std::from_chars(word.data() + digits, word.data() + word.size(), claim.start, 16);
    return claim;
  }
  return std::nullopt;
}

radio::Capabilities encode(const Capabilities& capabilities) {
  radio::Capabilities out;
  out.name(capabilities.name);
  out.kind(static_cast<radio::AgentKind>(capabilities.kind));
  out.id(capabilities.id);
  out.protocol(capabilities.protocol);
  out.software(capabilities.software);
  out.platform(capabilities.platform);
  out.holonomic(capabilities.holonomic);
  out.length(capabilities.length);
  out.width(capabilities.width);
  out.height(capabilities.height);
  out.max_speed(capabilities.max_speed);
  out.max_turn(capabilities.max_turn);
  out.max_acceleration(capabilities.max_acceleration);
  out.step(capabilities.max_step);
  out.slope(capabilities.max_slope);
  out.stairs(capabilities.stairs);
  out.sensors(capabilities.sensors);
  out.modes(capabilities.modes);
  out.services(capabilities.services);
  out.placed(capabilities.place.has_value());
  if (capabilities.place) out.place(*capabilities.place);
  return out;
}

std::string amount_refused(const radio::Capabilities& sample) {
  for (const Limit& limit : kLimits) {
    const float amount = (sample.*limit.amount)();
    if (limit.permits(amount)) continue;
    char text[96];
    std::snprintf(text, sizeof text, "%s of %g %s (expected 0, or %g to %g)", limit.name,
                  static_cast<double>(amount), limit.unit, static_cast<double>(limit.least),
                  static_cast<double>(limit.most));
    return text;
  }
  return {};
}

std::optional<Capabilities> decode(const radio::Capabilities& sample) {
  if (!command::valid_name(sample.name())) return std::nullopt;
  Capabilities out{.name = sample.name(),
                   .kind = kind_of(sample.kind()),
                   .id = sample.id(),
                   .protocol = sample.protocol(),
                   .software = cleaned_name(sample.software()),
                   .platform = cleaned_name(sample.platform()),
                   .holonomic = sample.holonomic(),
                   .stairs = sample.stairs(),
                   .sensors = cleaned_names(sample.sensors(), Capabilities::kMaxSensors),
                   .modes = cleaned_names(sample.modes(), Capabilities::kMaxModes),
                   .services = cleaned_names(sample.services(), Capabilities::kMaxServices)};
  for (const Limit& limit : kLimits)
    if (const float amount = (sample.*limit.amount)(); limit.permits(amount)) out.*limit.known = amount;
  const auto& [x, y, z] = sample.place();
  if (out.kind == AgentKind::station && sample.placed() && finite(x, y, z)) out.place = sample.place();
  return out;
}

radio::Presence encode(const Presence& presence) {
  radio::Presence out;
  out.name(presence.name);
  out.kind(static_cast<radio::AgentKind>(presence.kind));
  out.id(presence.id);
  out.protocol(presence.protocol);
  out.seq(presence.seq);
  return out;
}

std::optional<Presence> decode(const radio::Presence& sample) {
  if (!command::valid_name(sample.name())) return std::nullopt;
  return Presence{sample.name(), kind_of(sample.kind()), sample.id(), sample.protocol(), sample.seq()};
}

}  // namespace adit::contract
