// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/sent_sets.hpp"

#include <deque>

#include "basestation/map/chunk_store.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::bench {

void visit_sent(
    const MapRecording& recording, std::size_t max_bytes,
    const std::function<void(const perception::MapPiece&, const perception::FindStored&)>& visit) {
  constexpr Duration kTick = 50ms, kAcknowledged = 1s, kAfter = 150s;
  constexpr std::uint64_t kStart = 0x0123456789abcdefU;
  const transfer::PeerId station{1};
  agent::BlockSource source({.robot = recording.robot, .start = kStart});
  source.join(station);
  station::ChunkStore store;
  const perception::FindStored find_stored = [&](const auto& key, const perception::BlockIndex& index) {
    return store.find(key, index);
  };
  std::set<std::uint32_t> opened;
  std::deque<std::pair<Time, std::uint64_t>> flights;
  auto next = recording.updates.begin();
  for (Time now{}; now.time_since_epoch() < recording.length + kAfter; now += kTick) {
    source.tick(now);
    for (; next != recording.updates.end() && next->at <= now.time_since_epoch(); ++next) {
      const agent::MapStep& step = next->step;
      if (opened.insert(step.submap).second)
        source.open(step.submap, {kStart, step.submap, step.odom_epoch, lattice_offset(step.T_odom_submap)});
      for (const perception::CoarseBlock& block : step.blocks) source.update(step.submap, block);
    }
    for (; !flights.empty() && now - flights.front().first >= kAcknowledged; flights.pop_front()) {
      source.acknowledged(station, flights.front().second);
      source.settled(flights.front().second);
    }
    while (const auto content = source.next(std::span(&station, 1), max_bytes, now)) {
      flights.emplace_back(now, content->token);
      const auto piece = perception::decode(content->data, find_stored);
      if (!piece) continue;
      visit(*piece, find_stored);
      static_cast<void>(store.count(recording.robot, content->data.size(), 0, now));
      store.take(recording.robot, *piece);
    }
  }
}

}  // namespace adit::bench
