// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/known_findings.hpp"

#include <algorithm>

#include "core/store/pack.hpp"
#include "core/store/preserve.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

constexpr const char* kFile = "findings-known";
constexpr store::StateFormat kFormat{{'F', 'A', 'C', 'K'}, 1, 512 * 1024};
constexpr Duration kPeriod = 5s;
constexpr Duration kWrite = 3ms;  // In rehearsal.

}  // namespace

void KnownFindings::load(const std::function<bool(std::uint64_t id)>& exists) {
  if (!disk_) return;
  const store::State state = store::StateFile(disk_, kFile, kFormat).load();
  if (state.found != store::LoadStatus::good) {
    if (state.found != store::LoadStatus::nothing)
      (void)store::set_aside(*disk_, kFile, store::name(state.found));
    return;
  }
  store::Unpacker in(state.payload);
  for (std::size_t left = in.count(65535); left > 0 && in.good(); --left) {
    const auto id = in.get<std::uint64_t>();
    std::vector<transfer::PeerId> has;
    for (std::size_t stations = in.count(kStations); stations > 0 && in.good(); --stations)
      has.push_back(in.array<16>());
    if (in.good() && !has.empty() && exists(id)) stations_[id] = std::move(has);
  }
}

void KnownFindings::add(std::uint64_t id, const transfer::PeerId& station) {
  if (has(id, station)) return;
  std::vector<transfer::PeerId>& has = stations_[id];
  if (has.size() >= kStations) has.erase(has.begin());
  has.push_back(station);
  changed_ = true;
}

bool KnownFindings::has(std::uint64_t id, const transfer::PeerId& station) const {
  const auto found = stations_.find(id);
  return found != stations_.end() &&
         std::find(found->second.begin(), found->second.end(), station) != found->second.end();
}

void KnownFindings::tick(Time now) {
  if (!disk_ || !changed_ || now - saved_ < kPeriod) return;
  changed_ = false;
  saved_ = now;
  store::Packer out;
  out.put(static_cast<std::uint16_t>(std::min<std::size_t>(stations_.size(), 65535)));
  std::size_t left = 65535;
  for (const auto& [id, has] : stations_) {
    if (left-- == 0) break;
    out.put(id).put(static_cast<std::uint16_t>(has.size()));
    for (const transfer::PeerId& station : has) out.put(station);
  }
  const auto save = [file = store::StateFile(disk_, kFile, kFormat), bytes = out.bytes()] {
    (void)file.save(1, bytes);
  };
  if (disk_->instant())
    timer_ = home_.after(kWrite, save);
  else if (writer_)
    writer_->post(save);
  else
    home_.compute({.name = "known findings", .modelled = kWrite, .pool = PoolKind::io}, save,
                  [](const Result<void>&) {});
}

}  // namespace adit::agent
