// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/get_out.hpp"

#include <cmath>

#include "core/store/pack.hpp"
#include "robot_agent/right_of_way/right_of_way.hpp"

namespace adit::agent {
namespace {

constexpr std::string_view kYieldAllowed = "yield_allowed", kInTheWay = "in_the_way";

}  // namespace

ModeRow GetOutMode::row() {
  using namespace conditions;
  static constexpr Condition yield_allowed{"YieldAllowed", Reason::yield_off,
                                           [](const Facts& f) { return f.has(kYieldAllowed); },
                                           Scope::terminal};
  static constexpr Condition in_the_way{"InTheWay", Reason::yield_refused,
                                        [](const Facts& f) { return f.has(kInTheWay); }, Scope::terminal};
  return {.name = "get_out",
          .commanded_by = {.agent = true},
          .on_failure = OnFailure::pauses,
          .on_handover = OnHandover::falls_to_hold,
          .conditions = {kNotStopped, yield_allowed, in_the_way, kDriverAlive, kLocalised, kTerrainFresh},
          .make = GetOutMode::make,
          .output_lifetime = 500ms,
          .optional = true};
}

void GetOutMode::note(Facts& facts, Time) const {
  const RightOfWay* way = context_.right_of_way;
  if (!way) return;
  if (way->allowed() && !way->asleep()) facts.also.push_back(kYieldAllowed);
  if (way->clears()) facts.also.push_back(kInTheWay);
}

void GetOutMode::tick(bool, Time now) {
  const auto place = context_.right_of_way ? context_.right_of_way->place() : std::nullopt;
  if (place)
    context_.output.write(GoTo{.goal = {place->x(), place->y(), std::nan("")}}, now);
  else
    context_.output.write(Stand{}, now);
}

void GetOutMode::store(StoredBehaviour& stored) const {
  const RightOfWay* way = context_.right_of_way;
  if (way && way->allowed())
    stored.modes.push_back({std::string(row().name), store::Packer{}.flag(way->asleep()).bytes()});
}

void GetOutMode::restore(const StoredBehaviour& stored) {
  const store::Bytes* bytes = stored.of(row().name);
  if (!bytes || !context_.right_of_way) return;
  store::Unpacker in(*bytes);
  const bool asleep = in.flag();
  if (in.done()) context_.right_of_way->restore(true, asleep);
}

}  // namespace adit::agent
