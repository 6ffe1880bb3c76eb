// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/watch.hpp"

#include <algorithm>
#include <cmath>

#include "bench/map_link/recording.hpp"

namespace adit::bench {
namespace {

/// Notes the time at which cells came to be known.
void note(std::array<std::optional<Time>, 8>& times, std::uint64_t known, Time now) {
  const std::uint8_t cells = known_cells(known);
  for (std::size_t i = 0; i < times.size(); ++i)
    if ((cells >> i & 1) != 0 && !times[i]) times[i] = now;
}

}  // namespace

void Watch::count(const Block& block, int sign) {
  different_ += block.differs() ? sign : 0;
  const std::uint8_t cells = known_cells(block.known);
  for (std::size_t i = 0; i < block.arrived.size(); ++i) {
    if ((cells >> i & 1) == 0) continue;
    seen_ += sign;
    known_ += block.arrived[i] ? sign : 0;
  }
}

void Watch::robot_has(std::size_t robot, const perception::CoarseBlock& block, Time now) {
  Block& at = robots_[robot][block.index];
  count(at, -1);
  at.known = block.known;
  at.occupied = block.occupied;
  // What was unknown again before it arrived is first known when it comes back.
  const std::uint8_t cells = known_cells(block.known);
  for (std::size_t i = 0; i < at.first.size(); ++i)
    if ((cells >> i & 1) == 0 && !at.arrived[i]) at.first[i].reset(), at.sent[i].reset();
  note(at.first, block.known, now);
  count(at, 1);
}

void Watch::was_sent(std::size_t robot, const perception::BlockIndex& index, std::uint64_t known, Time now) {
  note(robots_[robot][index].sent, known, now);
}

void Watch::station_shows(std::size_t robot, const perception::CoarseBlock& block, Time now) {
  Block& at = robots_[robot][block.index];
  count(at, -1);
  at.shown_known = block.known;
  at.shown_occupied = block.occupied;
  note(at.arrived, block.known, now);
  count(at, 1);
}

std::vector<Duration> Watch::delays(std::array<std::optional<Time>, 8> Block::*until) const {
  std::vector<Duration> out;
  for (const auto& blocks : robots_)
    for (const auto& [index, block] : blocks)
      for (std::size_t i = 0; i < block.first.size(); ++i)
        if ((known_cells(block.known) >> i & 1) != 0)
          out.push_back((block.*until)[i] ? *(block.*until)[i] - *block.first[i] : kNever);
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Duration> Watch::ages() const { return delays(&Block::arrived); }

std::vector<Duration> Watch::waits() const { return delays(&Block::sent); }

double quantile(const std::vector<Duration>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  const Duration value = sorted[std::clamp<std::size_t>(at, 1, sorted.size()) - 1];
  return value == Watch::kNever ? -1.0 : seconds(value);
}

}  // namespace adit::bench
