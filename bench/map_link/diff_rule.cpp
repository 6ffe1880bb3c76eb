// SPDX-License-Identifier: Apache-2.0
// MARBLE's rule, from marble_mapping (MarbleMapping.cpp, updateDiff) and bobcat (BOBCAT.py, addMapDiffs):
// every 10 s, if more than 1000 leaves of 0.2 m are new or changed, they are one more numbered diff, a binary
// OctoMap. A robot says once a second how many there are; the station asks for those that it lacks, each at
// most once in 6 s, and applies them in their order. More than they did: a diff is sent at once, and
// compressed.
#include <algorithm>
#include <bit>
#include <deque>
#include <set>

#include "bench/map_link/rule.hpp"

namespace adit::bench {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;

constexpr Duration kPeriod = 10s;
constexpr std::size_t kThreshold = 1000;  ///< Leaves.
constexpr Duration kStatus = 1s;
constexpr Duration kAskedAgain = 6s;
constexpr std::size_t kStatusBytes = 60;   ///< A message with the number of diffs.
constexpr std::size_t kRequestBytes = 40;  ///< A request without its numbers.
constexpr std::size_t kFramesAhead = 2;    ///< Frames in the radio's queue.

/// Voxels of `known` that are new or changed.
struct Diff {
  std::vector<CoarseBlock> blocks{};
  std::size_t bytes{}, frames{};
  std::optional<Time> begun{};  ///< Its last sending.
  std::uint32_t attempts{};
};

struct Frame {
  std::size_t diff{};
  std::uint32_t attempt{};
  std::size_t number{};
};

struct DiffRobot {
  LatticeMap merged{};
  std::map<BlockIndex, CoarseBlock> last{};  ///< As of the last diff.
  std::vector<Diff> diffs{};
  std::deque<Frame> queue{};
  std::size_t announced{};  ///< Diffs that left the robot once.
  Time due{}, status{};
  std::uint64_t content{};
  // At the station.
  std::set<std::size_t> complete{};
  std::map<std::pair<std::size_t, std::uint32_t>, std::size_t> frames{};  ///< Received, by diff and attempt.
  std::map<std::size_t, Time> asked{};
  std::map<BlockIndex, std::map<std::size_t, CoarseBlock>> received{};
};

class DiffRule final : public Rule {
 public:
  explicit DiffRule(const Mission& mission) : mission_(mission), robots_(mission.robots.size()) {
    for (DiffRobot& r : robots_) r.due = mission.air.now() + kPeriod;
  }

  void update(std::size_t robot, const MapUpdate& update) override {
    DiffRobot& r = robots_[robot];
    const BlockIndex offset = lattice_offset(update.step.T_odom_submap);
    for (const CoarseBlock& block : update.step.blocks)
      mission_.watch.robot_has(robot, r.merged.set(update.step.submap, block, offset), mission_.air.now());
  }

  void tick() override {
    for (std::size_t i = 0; i < robots_.size(); ++i) tick(i);
  }

  bool settled() const override {
    return std::all_of(robots_.begin(), robots_.end(),
                       [](const DiffRobot& r) { return r.complete.size() == r.diffs.size(); });
  }

  Account account() const override {
    Account out;
    for (const DiffRobot& r : robots_) out.content += r.content;
    return out;
  }

 private:
  void tick(std::size_t robot) {
    DiffRobot& r = robots_[robot];
    const Time now = mission_.air.now();
    if (now >= r.due) {
      r.due += kPeriod;
      compare(r);
    }
    while (!r.queue.empty() && mission_.air.backlog(Air::robot(robot)) < kFramesAhead) {
      const Frame frame = r.queue.front();
      r.queue.pop_front();
      const std::size_t room = mission_.air.room(), bytes = r.diffs[frame.diff].bytes;
      if (frame.number + 1 == r.diffs[frame.diff].frames) r.announced = std::max(r.announced, frame.diff + 1);
      mission_.air.send(Air::robot(robot), Air::kStation, std::min(room, bytes - frame.number * room),
                        [this, robot, frame] { arrived(robot, frame); });
    }
    if (now < r.status || r.announced == 0) return;
    r.status = now + kStatus;
    mission_.air.send(Air::robot(robot), Air::kStation, kStatusBytes,
                      [this, robot, count = r.announced] { ask(robot, count); });
  }

  /// Makes a diff of what changed, if that is enough.
  void compare(DiffRobot& r) {
    Diff diff;
    std::size_t leaves = 0;
    for (const auto& [at, block] : r.merged.shown()) {
      const CoarseBlock& old = r.last[at];
      const std::uint64_t changed = (block.known ^ old.known) | (block.occupied ^ old.occupied);
      if (changed == 0) continue;
      leaves += static_cast<std::size_t>(std::popcount(changed));
      diff.blocks.push_back({at, changed, block.occupied & changed});
    }
    if (leaves <= kThreshold) return;
    for (const CoarseBlock& block : diff.blocks) r.last[block.index] = r.merged.shown().at(block.index);
    diff.bytes = octree_file_bytes(diff.blocks);
    diff.frames = (diff.bytes + mission_.air.room() - 1) / mission_.air.room();
    r.content += diff.bytes;
    r.diffs.push_back(std::move(diff));
    queue(r, r.diffs.size() - 1);
  }

  void queue(DiffRobot& r, std::size_t number) {
    Diff& diff = r.diffs[number];
    diff.begun = mission_.air.now();
    ++diff.attempts;
    for (std::size_t i = 0; i < diff.frames; ++i) r.queue.push_back({number, diff.attempts, i});
  }

  void arrived(std::size_t robot, const Frame& frame) {
    DiffRobot& r = robots_[robot];
    if (r.complete.contains(frame.diff)) return;
    if (++r.frames[{frame.diff, frame.attempt}] < r.diffs[frame.diff].frames) return;
    r.complete.insert(frame.diff);
    for (const CoarseBlock& block : r.diffs[frame.diff].blocks) {
      auto& received = r.received[block.index];
      received[frame.diff] = block;
      CoarseBlock shown{block.index, 0, 0};
      for (const auto& [number, part] : received) {
        shown.known |= part.known;
        shown.occupied = (shown.occupied & ~part.known) | part.occupied;
      }
      mission_.watch.station_shows(robot, shown, mission_.air.now());
    }
  }

  /// The station heard how many diffs there are.
  void ask(std::size_t robot, std::size_t count) {
    DiffRobot& r = robots_[robot];
    const Time now = mission_.air.now();
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < count; ++i) {
      if (r.complete.contains(i)) continue;
      const auto asked = r.asked.find(i);
      if (asked != r.asked.end() && now - asked->second < kAskedAgain) continue;
      r.asked[i] = now;
      missing.push_back(i);
    }
    if (missing.empty()) return;
    mission_.air.send(Air::kStation, Air::robot(robot), kRequestBytes + 4 * missing.size(),
                      [this, robot, missing] { send_again(robot, missing); });
  }

  void send_again(std::size_t robot, const std::vector<std::size_t>& numbers) {
    DiffRobot& r = robots_[robot];
    for (const std::size_t number : numbers) {
      const Diff& diff = r.diffs[number];
      const bool waits = std::any_of(r.queue.begin(), r.queue.end(),
                                     [&](const Frame& frame) { return frame.diff == number; });
      if (waits || (diff.attempts > 1 && mission_.air.now() - *diff.begun < kAskedAgain)) continue;
      queue(r, number);
    }
  }

  Mission mission_;
  std::vector<DiffRobot> robots_;
};

}  // namespace

std::unique_ptr<Rule> make_diff_rule(const Mission& mission) { return std::make_unique<DiffRule>(mission); }

}  // namespace adit::bench
