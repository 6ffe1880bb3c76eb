// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/station_views.hpp"

#include <algorithm>

namespace adit::agent {
namespace {

constexpr std::size_t kMaxRobots = 64;  // That a view names.

}  // namespace

void StationViews::heard(const transfer::Ack& ack, Time now) {
  const auto found = views_.find(ack.peer);
  if (found == views_.end() && views_.size() >= kMaxStations)
    views_.erase(std::min_element(views_.begin(), views_.end(), [](const auto& a, const auto& b) {
      return a.second.heard < b.second.heard;
    }));
  View& view = views_[ack.peer];
  if (found == views_.end() || view.start != ack.start) view = {.start = ack.start, .joined = now};
  view.heard = now;
  view.all_digests = view.all_digests || ack.all_digests;
  for (const transfer::ContentDigest& digest : ack.digests)
    if (view.digests.size() < kMaxRobots) view.digests.insert(digest.robot);
  std::erase_if(view.direct, [now](const auto& entry) { return now - entry.second >= kDirect; });
  for (const std::string& robot : ack.senders)
    if (view.direct.size() < kMaxRobots) view.direct[robot] = now;
}

bool StationViews::wants(const transfer::PeerId& station, const std::string& robot, Time now) const {
  const auto found = views_.find(station);
  if (found == views_.end()) return false;
  const View& view = found->second;
  const auto direct = view.direct.find(robot);
  if (direct != view.direct.end() && now - direct->second < kDirect) return false;
  return view.all_digests || view.digests.contains(robot) || now - view.joined >= kDigestWait;
}

}  // namespace adit::agent
