// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/known_findings.hpp"

#include <algorithm>

#include "core/store/background.hpp"
#include "core/store/pack.hpp"
#include "core/store/preserve.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

constexpr const char* kFile = "findings-known";
constexpr store::StateFormat kFormat{{'F', 'A', 'C', 'K'}, 2, 512 * 1024};
constexpr Duration kPeriod = 5s;
constexpr Duration kWrite = 3ms;  // In rehearsal.

/// The floor above a revision.
std::uint32_t above(std::uint32_t revision) { return revision + (revision < UINT32_MAX ? 1 : 0); }

}  // namespace

void KnownFindings::load(const std::function<bool(std::uint64_t id)>& exists) {
  if (!disk_) return;
  const store::State state = store::StateFile(disk_, kFile, kFormat).load();
  const bool first_version = state.found == store::LoadStatus::older && state.version == 1;
  if (state.found != store::LoadStatus::good && !first_version) {
    if (state.found != store::LoadStatus::nothing)
      (void)store::set_aside(*disk_, kFile, store::name(state.found));
    return;
  }
  store::Unpacker in(state.payload);
  if (!first_version) floor_ = in.get<std::uint32_t>();
  for (std::size_t left = in.count(65535); left > 0 && in.good(); --left) {
    const auto id = in.get<std::uint64_t>();
    std::vector<Holder> has;
    for (std::size_t stations = in.count(kStations); stations > 0 && in.good(); --stations) {
      const auto station = in.array<16>();
      has.emplace_back(station, first_version ? 0 : in.get<std::uint32_t>());
    }
    if (!in.good() || has.empty()) continue;
    if (exists(id))
      stations_[id] = std::move(has);
    else
      for (const auto& [station, revision] : has) floor_ = std::max(floor_, above(revision));
  }
}

void KnownFindings::add(std::uint64_t id, std::uint32_t revision, const transfer::PeerId& station) {
  std::vector<Holder>& has = stations_[id];
  const auto found =
      std::find_if(has.begin(), has.end(), [&](const Holder& holder) { return holder.first == station; });
  if (found != has.end()) {
    if (found->second >= revision) return;
    found->second = revision;
  } else {
    if (has.size() >= kStations) has.erase(has.begin());
    has.emplace_back(station, revision);
  }
  changed_ = true;
}

std::optional<std::uint32_t> KnownFindings::revision(std::uint64_t id,
                                                     const transfer::PeerId& station) const {
  const auto found = stations_.find(id);
  if (found == stations_.end()) return std::nullopt;
  for (const auto& [holder, revision] : found->second)
    if (holder == station) return revision;
  return std::nullopt;
}

bool KnownFindings::has(std::uint64_t id, std::uint32_t revision) const {
  const auto found = stations_.find(id);
  return found != stations_.end() &&
         std::any_of(found->second.begin(), found->second.end(),
                     [revision](const Holder& holder) { return holder.second >= revision; });
}

void KnownFindings::raise_above(std::uint32_t revision) {
  if (above(revision) <= floor_) return;
  floor_ = above(revision);
  if (disk_) save();
}

void KnownFindings::tick(Time now) {
  if (!disk_ || !changed_ || now - saved_ < kPeriod) return;
  saved_ = now;
  save();
}

void KnownFindings::save() {
  changed_ = false;
  store::Packer out;
  out.put(floor_);
  out.put(static_cast<std::uint16_t>(std::min<std::size_t>(stations_.size(), 65535)));
  std::size_t left = 65535;
  for (const auto& [id, has] : stations_) {
    if (left-- == 0) break;
    out.put(id).put(static_cast<std::uint16_t>(has.size()));
    for (const auto& [station, revision] : has) out.put(station).put(revision);
  }
  timer_ = store::run_in_background(
      *disk_, home_, writer_, {.name = "known findings", .modelled = kWrite, .pool = PoolKind::io},
      [file = store::StateFile(disk_, kFile, kFormat), bytes = out.bytes()] { (void)file.save(1, bytes); });
}

}  // namespace adit::agent
