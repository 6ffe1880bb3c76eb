// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/mission.hpp"

#include <algorithm>

namespace adit::bench {
namespace {

constexpr Duration kTick = 50ms;

LatticeMap map_until(const MapRecording& recording, Duration until) {
  LatticeMap out;
  for (const MapUpdate& update : recording.updates) {
    if (update.at > until) break;
    const perception::BlockIndex offset = lattice_offset(update.step.T_odom_submap);
    for (const perception::CoarseBlock& block : update.step.blocks)
      static_cast<void>(out.set(update.step.submap, block, offset));
  }
  return out;
}

void note_time(std::optional<Duration>& time, bool reached, Duration now) {
  if (reached && !time) time = now;
}

}  // namespace

MissionResult run_mission(const std::vector<MapRecording>& robots, const MissionPlan& plan,
                          const MakeRule& make) {
  Air air(plan.link, plan.seed, robots.size());
  Watch watch(robots.size());
  const std::unique_ptr<Rule> rule = make({air, watch, robots, plan.seed});
  MissionResult out;
  Duration length{};
  for (const MapRecording& robot : robots) length = std::max(length, robot.length);
  std::vector<std::size_t> next(robots.size());
  bool ended = false;
  for (Duration now{}; now < length + plan.limit; now += kTick) {
    for (std::size_t i = 0; i < robots.size(); ++i)
      while (next[i] < robots[i].updates.size() && robots[i].updates[next[i]].at <= now)
        rule->update(i, robots[i].updates[next[i]++]);
    if (plan.cut_from) air.cut(now >= *plan.cut_from && now < length);
    if (now >= length && !ended) {
      ended = true;
      out.share_at_end = watch.share();
    }
    rule->tick();
    air.run(kTick);
    if (!ended) continue;
    out.after = now + kTick - length;
    note_time(out.coarse_95, watch.share() >= 0.95, out.after);
    note_time(out.coarse_99, watch.share() >= 0.99, out.after);
    note_time(out.coarse_all, watch.known() == watch.seen(), out.after);
    note_time(out.all_equal, watch.different() == 0, out.after);
    out.settled = rule->settled();
    if (out.settled) break;
  }
  out.robots = air.sent_by_robots();
  out.station = air.sent(Air::kStation);
  out.ages = watch.ages();
  out.waits = watch.waits();
  out.account = rule->account();
  out.different_blocks = watch.different();
  out.different_voxels = rule->different_voxels();
  return out;
}

std::vector<perception::CoarseBlock> final_map(const MapRecording& recording) {
  const LatticeMap map = map_until(recording, recording.length);
  std::vector<perception::CoarseBlock> out;
  for (const auto& [at, block] : map.shown()) out.push_back(block);
  return out;
}

double area_seen_since(const MapRecording& recording, Duration from) {
  return ground_area(map_until(recording, recording.length).shown()) -
         ground_area(map_until(recording, from).shown());
}

}  // namespace adit::bench
