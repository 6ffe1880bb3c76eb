// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/recording.hpp"

#include <cmath>
#include <numbers>
#include <set>
#include <thread>

#include "core/exec/virtual_runtime.hpp"
#include "core/time/random.hpp"
#include "robot_agent/perception/block_votes.hpp"
#include "robot_agent/perception/map_keeper.hpp"
#include "sim/world/lidar.hpp"

namespace adit::bench {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;

constexpr float kHeight = 0.5F;          ///< Of the lidar above the ground, m.
constexpr double kSpeed = 1.0;           ///< m/s
constexpr Duration kScanPeriod = 250ms;  ///< Of scans.
constexpr double kShake = 0.02;          ///< Of the body's height, m.
constexpr double kVisited = 1.5;         ///< Edge of the cells in which visits are counted, m.
constexpr int kHeadings = 24;
constexpr double kLook = 8.0;      ///< Along a heading, m.
constexpr double kLeg = 4.0;       ///< Way until another heading is looked for, m.
constexpr double kApart = 25.0;    ///< Way of a robot before its mission, for each one before it, m.
constexpr double kTowards = 0.25;  ///< Between two places that are looked at along a heading, m.

/// Drives to where it was least.
class Walker {
 public:
  Walker(const Ground& ground, Random random) : ground_(ground), random_(random), at_(ground.start) {}

  void go(double length) {
    for (double left = length; left > 1e-9; left -= kTowards) {
      const double step = std::min(left, kTowards);
      if (leg_ <= 0.0 || !can_go(heading_, step)) turn();
      if (!can_go(heading_, step)) return;
      at_ += step * direction(heading_);
      leg_ -= step;
      ++visits_[cell(at_)];
    }
  }
  Pose2 pose() const { return {at_.x(), at_.y(), wrap_angle(heading_)}; }

 private:
  static Eigen::Vector2d direction(double heading) { return {std::cos(heading), std::sin(heading)}; }
  static std::pair<int, int> cell(const Eigen::Vector2d& at) {
    return {static_cast<int>(std::floor(at.x() / kVisited)), static_cast<int>(std::floor(at.y() / kVisited))};
  }
  bool can_go(double heading, double way) const {
    return ground_.can_stand(at_ + way * direction(heading), ground_.height(at_));
  }
  void turn() {
    double best = 1e9, found = heading_ + std::numbers::pi;
    for (int i = 0; i < kHeadings; ++i) {
      const double heading = heading_ + 2.0 * std::numbers::pi * i / kHeadings;
      double visits = 0.0, way = kTowards;
      for (; way <= kLook && can_go(heading, way); way += kTowards) {
        const auto known = visits_.find(cell(at_ + way * direction(heading)));
        visits += known == visits_.end() ? 0.0 : known->second;
      }
      if (way < 2 * kTowards) continue;
      const double cost = visits / (way / kTowards) - 0.2 * way + 0.3 * random_.uniform();
      if (cost < best) best = cost, found = heading;
    }
    heading_ = found;
    leg_ = kLeg;
  }

  const Ground& ground_;
  Random random_;
  Eigen::Vector2d at_;
  double heading_{}, leg_{};
  std::map<std::pair<int, int>, int> visits_{};
};

}  // namespace

BlockIndex lattice_offset(const Pose3& T_odom_submap) {
  const Eigen::Vector3d at = T_odom_submap.position / static_cast<double>(BlockIndex::kSize);
  const auto rounded = [](double v) { return static_cast<std::int32_t>(std::lround(v)); };
  return {rounded(at.x()), rounded(at.y()), rounded(at.z())};
}

MapRecording record(const Ground& ground, std::uint64_t seed, int number, Duration length) {
  Random random = Random(seed).fork(static_cast<std::uint64_t>(number) + 1);
  MapRecording out;
  out.robot = "wheeled_" + std::to_string(number + 1);
  out.length = length;
  out.T_map_odom = Pose3::level({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)}, 0.04);
  const Pose3 T_odom_map = out.T_map_odom.inverse();
  Walker walker(ground, random.fork(1));
  walker.go(kApart * number);

  VirtualScheduler scheduler(VirtualParams{.seed = seed, .workers = 1});
  const auto machine = scheduler.machine(out.robot, 5s);
  const auto strand = machine->strand("map");
  agent::MapService service{"map insertion", 2};
  agent::MapPart part(agent::MapParams{}, *strand, Log{}, service);
  static_cast<void>(part.start());
  agent::MapKeeper keeper({.robot = out.robot, .seed = seed, .origin = {0, 0, kHeight}});
  const sim::LidarPattern lidar{sim::LidarParams{}};
  const agent::MapFrame frame{out.T_map_odom, 0, 0};
  for (std::uint64_t n = 1; scheduler.elapsed() < length; ++n) {
    const Pose2 at = walker.pose();
    const Pose3 base = Pose3::level(at, ground.height(at.position()) + kShake * random.uniform(-1, 1));
    auto scan = std::make_shared<agent::Scan>();
    scan->points =
        lidar.scan(ground.world, {}, base, static_cast<double>(kHeight), n + 1000 * random.below(1U << 30));
    scan->body = scan->located = T_odom_map * base;
    const std::shared_ptr<const agent::Scan> taken = scan;
    if (auto job = keeper.job(taken, {}, 0, strand->now())) {
      service.call(*strand, std::move(job), {.deadline = 2s}, [&](const Result<agent::MapStep>& step) {
        keeper.taken(step, frame);
        if (step) out.updates.push_back({scheduler.elapsed(), *step});
      });
    }
    scheduler.run_until(scheduler.elapsed() + kScanPeriod);
    walker.go(kSpeed * seconds(kScanPeriod));
  }
  part.stop();
  return out;
}

std::vector<MapRecording> record_team(const Ground& ground, std::uint64_t seed, int robots, Duration length) {
  std::vector<MapRecording> out(static_cast<std::size_t>(robots));
  std::vector<std::thread> threads;
  for (int i = 0; i < robots; ++i)
    threads.emplace_back([&, i] { out[static_cast<std::size_t>(i)] = record(ground, seed, i, length); });
  for (std::thread& thread : threads) thread.join();
  return out;
}

CoarseBlock LatticeMap::set(std::uint32_t submap, const CoarseBlock& block, const BlockIndex& offset) {
  const BlockIndex at{block.index.x + offset.x, block.index.y + offset.y, block.index.z + offset.z};
  auto& votes = votes_[at];
  votes[submap] = block;
  agent::BlockVotes all;
  for (const auto& [by, vote] : votes) all.add(vote.known, vote.occupied);
  return shown_[at] = {at, all.known(), all.occupied() & all.known()};
}

std::uint8_t known_cells(std::uint64_t known) {
  std::uint8_t out = 0;
  for (int cell = 0; cell < 8; ++cell) {
    const int corner = 2 * (cell & 1) + 8 * (cell >> 1 & 1) + 32 * (cell >> 2);
    constexpr std::uint64_t kCell = 0x0000000000330033ULL;  // Voxels 0, 1, 4, 5, 16, 17, 20 and 21.
    if ((known & kCell << corner) != 0) out = static_cast<std::uint8_t>(out | 1U << cell);
  }
  return out;
}

double ground_area(const std::map<BlockIndex, CoarseBlock>& blocks) {
  std::set<std::pair<int, int>> columns;
  for (const auto& [at, block] : blocks)
    for (int i = 0; i < 64; ++i)
      if ((block.known >> i & 1) != 0) columns.insert({4 * at.x + i % 4, 4 * at.y + i / 4 % 4});
  return 0.04 * static_cast<double>(columns.size());
}

}  // namespace adit::bench
