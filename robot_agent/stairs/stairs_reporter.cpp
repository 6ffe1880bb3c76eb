// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_reporter.hpp"

#include <array>
#include <cstdio>

#include "core/findings/merge_stairs.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::agent {
namespace {

findings::Finding finding_of(const Staircase& stairs, std::uint64_t stamp) {
  return {.kind = findings::kStairs,
          .importance = StairsReporter::kImportance,
          .position = {stairs.foot.x(), stairs.foot.y(), stairs.foot.z()},
          .stamp = stamp,
          .text = stairs_text(stairs),
          .data = findings::encode_stairs(stairs)};
}

}  // namespace

std::string stairs_text(const Staircase& stairs) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%d steps of %.2f m, %.1f m up", stairs.steps, stairs.rise,
                stairs.steps * stairs.rise);
  return text.data();
}

Result<void> StairsReporter::take(const Staircase& stairs, std::uint64_t stamp) {
  for (const auto& [key, finding] : findings_.finding_store().all()) {
    if (key.robot != robot_ || finding.kind != findings::kStairs) continue;
    const auto known = findings::stairs_of(finding);
    if (!known || !findings::is_same_flight(*known, stairs)) continue;
    // After a restart, fewer steps may be in view than were seen before.
    const std::array<findings::SeenStairs, 2> both{{{key, *known}, {key, stairs}}};
    findings::Finding better =
        finding_of(stairs.steps >= known->steps ? stairs : findings::combined(both), stamp);
    better.key = key;
    return findings_.update(std::move(better));
  }
  const auto reported = findings_.report(finding_of(stairs, stamp));
  if (!reported) return reported.error();
  return {};
}

}  // namespace adit::agent
