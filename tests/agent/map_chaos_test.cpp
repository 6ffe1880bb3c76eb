// SPDX-License-Identifier: Apache-2.0
// A robot's map and a station on a bad link, while both are started again, beside a station that hears nearly
// all: in the end both show what a station shows that comes then and misses nothing.
#include <gtest/gtest.h>

#include <cstdlib>

#include "basestation/content/piece_reader.hpp"
#include "basestation/map/map_replica.hpp"
#include "basestation/map/merged_map.hpp"
#include "tests/agent/map_bench.hpp"

namespace adit::agent {
namespace {

/// A station with a disk.
struct DiskStation {
  DiskStation(Executor& home, transfer::PeerId peer) : strand(home), id(peer) { restart(); }

  void restart() {
    pieces.emplace(
        [this] { return strand.now(); },
        [this](const station::PieceReader::Piece& piece, const station::PieceReader::Stored& stored) {
          return replica->take(piece.robot, piece.kind, piece.waiting, piece.data, stored);
        });
    replica.emplace(++starts, disk, strand, [](const std::string&) {});
    (void)replica->load();
  }
  perception::VoxelImage image() const {
    return station::merged(station::parts_of(replica->chunks()), nullptr, 0.2);
  }

  Executor& strand;
  transfer::PeerId id;
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::uint32_t starts{100};
  std::optional<station::PieceReader> pieces{};
  std::optional<station::MapReplica> replica{};
};

class Chaos : public MapBench {
 public:
  /// Large voxels go first as soon as a station lacks anything, or a piece; pieces are encoded by `compute`
  /// or at once; stations join in slices of a few blocks or at once.
  explicit Chaos(std::uint64_t number)
      : MapBench("r1", {}, {.coarse_pieces = number % 2, .slice = number % 3 == 0 ? 1000U : 7U},
                 number % 4 < 2),
        random(number) {}

  /// Lets time pass; pieces and acknowledgements of `base` are lost, late, twice or in another order. `other`
  /// loses few.
  void pass(Duration span, DiskStation& base, double loss, DiskStation* other = nullptr) {
    std::vector<std::pair<DiskStation*, double>> bases{{&base, loss}};
    if (other != nullptr) bases.emplace_back(other, 0.05);
    for (const Time end = strand->now() + span; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms)) {
      keeper->follow(frame);
      keeper->tick(strand->now());
      for (const transfer::Piece& piece : sender->due(strand->now(), link))
        for (const auto& [to, lost] : bases)
          send(lost, [this, to = to, piece, session = sender->session()] {
            to->pieces->take(
                {name, session, piece.id, static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data});
          });
      for (const auto& [from, lost] : bases) {
        const auto due = from->pieces->due(profile.bandwidth);
        if (!due) continue;
        transfer::Ack ack{from->id, from->replica->start(), {}, {}};
        for (const auto& [robot, receipt] : *due) ack.receipt = receipt;
        send(lost, [this, ack] {
          if (sender->acknowledged(ack, strand->now())) keeper->heard(ack);
        });
      }
      deliver();
    }
  }
  void send(double loss, std::function<void()> arrive) {
    for (int copies = random.chance(0.1) ? 2 : 1; copies > 0; --copies)
      if (!random.chance(loss))
        air.emplace_back(strand->now() + from_seconds(random.uniform(0.05, 0.8)), arrive);
  }
  void deliver() {
    std::vector<std::pair<Time, std::function<void()>>> arriving;
    std::erase_if(air, [&](auto& message) {
      if (message.first > strand->now()) return false;
      arriving.push_back(std::move(message));
      return true;
    });
    for (auto& [at, arrive] : arriving) arrive();
  }
  /// The robot goes on, and comes by places that it knows.
  void drive_on() {
    const double to = random.uniform(0.0, 60.0);
    const double step = to > x ? 1.0 : -1.0;
    for (int n = 0; n < 12 && (to - x) * step > 0; ++n) scan(x += step);
  }
  /// Whole voxels, so that merging the same submaps gives the same map wherever they were moved.
  void correct() {
    frame.T_map_odom.position.x() += 0.2 * static_cast<double>(random.below(5));
    ++frame.map_epoch;
  }

  wire::LinkProfile profile{.name = "mesh_500k", .bandwidth = 500e3};
  wire::SenderState link{.link = &profile};
  Random random;
  double x{};
  std::vector<std::pair<Time, std::function<void()>>> air{};
};

std::map<perception::VoxelIndex, perception::Voxel> voxels(const perception::VoxelImage& image) {
  std::map<perception::VoxelIndex, perception::Voxel> out;
  image.for_each([&](const perception::VoxelIndex& index, perception::Voxel voxel) { out[index] = voxel; });
  return out;
}

TEST(MapChaos, TheStationsMapEqualsTheRobotsOnceAllIsAcknowledged) {
  const char* wanted = std::getenv("ADIT_CHAOS_SEEDS");  // more in a campaign
  const std::uint64_t seeds = wanted == nullptr ? 4 : std::strtoull(wanted, nullptr, 10);
  std::uint64_t station_starts = 0, robot_starts = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Chaos chaos(seed);
    DiskStation base(*chaos.strand, {1}), other(*chaos.strand, {3});
    for (int episode = 0; episode < 14; ++episode) {
      chaos.drive_on();
      const double loss = chaos.random.chance(0.2) ? 1.0 : chaos.random.uniform(0.0, 0.4);
      chaos.pass(from_seconds(chaos.random.uniform(0.5, 25.0)), base, loss, &other);
      switch (chaos.random.below(6)) {
        case 0:
          base.restart(), ++station_starts;
          break;
        case 1:  // In the middle of a write.
          base.disk->cut_power_after(chaos.random.below(3000));
          chaos.pass(3s, base, loss, &other);
          base.disk->power_up();
          base.restart(), ++station_starts;
          break;
        case 2:
          chaos.pass(12s, base, loss, &other);  // It is on the robot's disk.
          chaos.restart(), ++robot_starts;
          break;
        case 3:
          chaos.correct();
          break;
        default:
          break;
      }
    }
    chaos.pass(200s, base, 0.2, &other);
    DiskStation witness(*chaos.strand, {2});
    chaos.pass(100s, witness, 0.0);
    ASSERT_GT(witness.replica->chunks().blocks(), 100U);
    const auto wants = voxels(witness.image());
    for (const DiskStation* station : {&base, &other}) {
      const auto has = voxels(station->image());
      std::size_t wrong = 0;
      for (const auto& [index, voxel] : wants) {
        const auto found = has.find(index);
        wrong += found == has.end() || found->second != voxel ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0U) << "seed " << seed << ", of " << wants.size()
                           << (station == &other ? ", other" : "");
      EXPECT_EQ(has.size(), wants.size()) << "seed " << seed;
    }
  }
  EXPECT_GT(station_starts, seeds);
  EXPECT_GT(robot_starts, seeds / 2);
}

}  // namespace
}  // namespace adit::agent
