// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_reporter.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/findings/merge_stairs.hpp"
#include "core/findings/placed.hpp"
#include "core/findings/stairs_data.hpp"
#include "robot_agent/stairs/stairs_tracker.hpp"

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

Result<Staircase> StairsReporter::present(const findings::Finding& finding) const {
  const bool anchored = finding.anchor && submaps_.pose;
  return findings::stairs_of(
      finding, findings::placed(finding, anchored ? submaps_.pose(*finding.anchor) : std::nullopt));
}

std::optional<findings::Key> StairsReporter::known(const Staircase& stairs) const {
  for (const auto& [key, finding] : findings_.finding_store().all()) {
    if (key.robot != robot_ || finding.kind != findings::kStairs) continue;
    const auto stored = present(finding);
    if (stored && findings::is_same_flight(*stored, stairs)) return key;
  }
  return std::nullopt;
}

void StairsReporter::withdraw(std::uint64_t id) {
  const auto named = keys_.find(id);
  if (named == keys_.end()) return;
  // Refused: it was dropped for lack of room meanwhile.
  (void)findings_.withdraw(named->second.id);
  keys_.erase(named);
}

const std::vector<Staircase>& StairsReporter::all() const {
  const std::uint64_t changes = findings_.finding_store().changes();
  const std::uint64_t poses = submaps_.changes ? submaps_.changes() : 0;
  if (decoded_ && decoded_->findings == changes && decoded_->poses == poses) return decoded_->stairs;
  decoded_ = Decoded{changes, poses, {}};
  for (const auto& [key, finding] : findings_.finding_store().all()) {
    if (key.robot != robot_ || finding.kind != findings::kStairs || finding.withdrawn) continue;
    if (const auto stored = present(finding)) decoded_->stairs.push_back(*stored);
  }
  return decoded_->stairs;
}

Result<void> StairsReporter::take(const StairsTracker::Tracked& tracked_stairs, std::uint64_t stamp) {
  const auto& [id, stairs, foot_known, top_known] = tracked_stairs;
  const auto& all = findings_.finding_store().all();
  auto named = keys_.find(id);
  const bool tracked = named != keys_.end() && all.contains(named->second);
  if (!tracked) {
    if (const auto key = known(stairs)) {
      if (keys_.size() >= kMostKeys) keys_.erase(keys_.begin());
      named = keys_.insert_or_assign(id, *key).first;
    } else {
      const auto reported = findings_.report(finding_of(stairs, stamp));
      if (!reported) return reported.error();
      if (keys_.size() >= kMostKeys) keys_.erase(keys_.begin());
      keys_.insert_or_assign(id, findings_.key(*reported));
      return {};
    }
  }
  const findings::Key key = named->second;
  const auto stored = present(all.at(key));
  Staircase better = stairs;
  if (stored && stored->steps > stairs.steps) {
    // After a restart, fewer steps are in view than were seen before.
    const std::array<findings::SeenStairs, 2> both{{{key, *stored}, {key, stairs}}};
    better = with_least_sigma(findings::combined(both));
    // Where it was seen that there are none, no older report adds any.
    const Eigen::Vector3d step = step_of(better);
    const int below =
        static_cast<int>(std::lround((stairs.foot - better.foot).dot(step) / step.squaredNorm()));
    const int above = better.steps - stairs.steps - below;
    if (foot_known && below > 0) better.foot += below * step, better.steps -= below;
    if (top_known && above > 0) better.steps -= above;
  }
  if (stored && !all.at(key).withdrawn && !differs(*stored, better)) return {};
  findings::Finding changed = finding_of(better, stamp);
  changed.key = key;
  return findings_.update(std::move(changed));
}

}  // namespace adit::agent
