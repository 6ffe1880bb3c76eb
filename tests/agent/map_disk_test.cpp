// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_disk.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/store/state_file.hpp"
#include "core/time/random.hpp"
#include "tests/agent/map_bench.hpp"

namespace adit::agent {
namespace {

std::vector<std::string> submap_files(const store::Disk& disk) {
  std::vector<std::string> out = disk.list().value();
  std::erase_if(out, [](const std::string& name) {
    return !name.starts_with("map-") || name == MapDisk::kPlacesFile || name.find('.') != std::string::npos;
  });
  return out;
}

TEST(MapDisk, AMapSurvivesARestartOfTheAgentUnderItsOldNames) {
  MapBench bench;
  bench.drive(0, 40);
  bench.run(31s);  // Then the blocks rest, and go in small voxels.
  const std::size_t blocks = bench.keeper->blocks(), submaps = bench.keeper->submaps();
  MapBench::Station before;
  bench.run(20s, &before);
  bench.restart();
  EXPECT_EQ(bench.loaded.text(), "");
  EXPECT_EQ(bench.keeper->blocks(), blocks);
  EXPECT_EQ(bench.keeper->submaps(), submaps);
  MapBench::Station after{.id = {2}};
  bench.run(20s, &after);
  ASSERT_EQ(after.poses.size(), before.poses.size());
  for (const auto& [key, pose] : before.poses) {
    ASSERT_TRUE(after.poses.contains(key));
    EXPECT_NEAR((after.poses[key].T_map_submap.position - pose.T_map_submap.position).norm(), 0.0, 1e-3);
    EXPECT_GT(after.poses[key].revision, pose.revision);
  }
  for (const auto& [key, own] : after.blocks)
    for (const auto& [index, update] : own)
      if (const auto same = before.blocks[key].find(index); same != before.blocks[key].end()) {
        EXPECT_EQ(same->second.block, update.block);
      }
}

TEST(MapDisk, AStationThatHasTheMapGetsNoBlockAgainAfterARestart) {
  MapBench bench;
  bench.drive(0, 40);
  MapBench::Station station;
  bench.run(120s, &station);
  const std::size_t received = station.received;
  EXPECT_GT(received, 100U);
  bench.restart();
  bench.run(20s, &station);
  EXPECT_EQ(station.received, received);
  bench.restart();
  station.start = 7;  // Now the station was started again, too.
  bench.run(20s, &station);
  EXPECT_GT(station.received, received);
}

TEST(MapDisk, SubmapsOfALaterStartComeLaterAndThoseOfEarlierOnesStayWhereTheyAre) {
  MapBench bench;
  bench.drive(0, 20);
  MapBench::Station station;
  bench.run(30s, &station);
  const auto earlier = station.poses;
  bench.restart();
  bench.drive(0, 5);
  bench.run(10s, &station);
  bench.frame.T_map_odom = Pose3::level({7, 1, 0}, 0);
  ++bench.frame.map_epoch;
  bench.run(10s, &station);
  ASSERT_GT(station.poses.size(), earlier.size());
  for (const auto& [key, pose] : earlier)
    EXPECT_NEAR((station.poses[key].T_map_submap.position - pose.T_map_submap.position).norm(), 0.0, 1e-3);
  const auto& newest = *station.poses.rbegin();
  EXPECT_GT(newest.first.start, earlier.rbegin()->first.start);
  EXPECT_NEAR(newest.second.T_map_submap.position.y(), 1.0, 0.01);
}

TEST(MapDisk, ACorrectionReachesTheDisk) {
  MapBench bench;
  bench.drive(0, 20);
  bench.frame.T_map_odom = Pose3::level({7, 1, 0}, 0);
  ++bench.frame.map_epoch;
  bench.run(21s);
  bench.restart();
  MapBench::Station station;
  bench.run(10s, &station);
  ASSERT_FALSE(station.poses.empty());
  for (const auto& [key, pose] : station.poses) EXPECT_NEAR(pose.T_map_submap.position.y(), 1.0, 0.01);
}

struct Harm {
  const char* name;
  void (*apply)(store::Bytes& bytes);
  std::size_t LoadedMap::*counted;
  Reason reason;
};

class HarmedMap : public testing::TestWithParam<Harm> {};

TEST_P(HarmedMap, IsReportedRenamedAndTheRestIsUsed) {
  MapBench bench;
  bench.drive(0, 40);
  bench.run(21s);
  const auto files = submap_files(*bench.disk);
  ASSERT_EQ(files.size(), 3U);
  store::Bytes bytes = *bench.disk->read(files[1]).value();
  GetParam().apply(bytes);
  bench.disk->plant(files[1], bytes);
  bench.restart();
  EXPECT_EQ(bench.loaded.*GetParam().counted, 1U) << bench.loaded.text();
  EXPECT_EQ(bench.loaded.reason, GetParam().reason);
  EXPECT_NE(bench.loaded.text(), "");
  EXPECT_EQ(bench.keeper->submaps(), 2U);
  const auto names = bench.disk->list().value();
  const auto aside = std::find_if(names.begin(), names.end(),
                                  [&](const std::string& name) { return name.starts_with(files[1] + "."); });
  ASSERT_NE(aside, names.end());
  EXPECT_EQ(*bench.disk->read(*aside).value(), bytes) << "nothing is deleted";
  bench.restart();
  EXPECT_EQ(bench.loaded.text(), "") << "reported once";
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, HarmedMap,
    testing::Values(
        Harm{"cut", [](store::Bytes& b) { b.resize(b.size() / 2); }, &LoadedMap::damaged, Reason::malformed},
        Harm{"flip", [](store::Bytes& b) { b[b.size() / 2] ^= 4; }, &LoadedMap::damaged, Reason::malformed},
        Harm{"empty", [](store::Bytes& b) { b.clear(); }, &LoadedMap::damaged, Reason::malformed},
        Harm{"version",
             [](store::Bytes& b) {
               const store::Bytes payload(b.begin() + 24, b.end() - 4);
               b = store::encode_envelope({{'S', 'M', 'A', 'P'}, 9, 1U << 22U}, 1, payload);
             },
             &LoadedMap::other_version, Reason::wrong_protocol},
        Harm{"robot",
             [](store::Bytes& b) {
               auto submap = perception::decode_stored_submap(std::span(b).subspan(24, b.size() - 28));
               submap->key.robot = "r9";
               b = store::encode_envelope({{'S', 'M', 'A', 'P'}, 1, 1U << 22U}, 1,
                                          perception::encode_stored(*submap));
             },
             &LoadedMap::foreign, Reason::wrong_robot}),
    [](const auto& harm) { return std::string(harm.param.name); });

TEST(MapDisk, DamagedPlacesLeaveTheSubmapsWhereTheyWereWritten) {
  MapBench bench;
  bench.drive(0, 40);
  bench.run(21s);
  bench.disk->plant(MapDisk::kPlacesFile, {1, 2, 3});
  bench.restart();
  EXPECT_EQ(bench.loaded.damaged, 1U);
  EXPECT_EQ(bench.keeper->submaps(), 3U);
  MapBench::Station station;
  bench.run(10s, &station);
  EXPECT_EQ(station.poses.size(), 3U);
}

TEST(MapDisk, AFullDiskIsReportedAndTheMapIsStoredWhenItHasRoomAgain) {
  MapBench bench;
  bench.disk->set_full(true);
  bench.drive(0, 20);
  bench.run(21s);
  EXPECT_TRUE(bench.failing);
  EXPECT_NE(bench.reported, "");
  EXPECT_TRUE(submap_files(*bench.disk).empty()) << "no half of a file under its name";
  bench.disk->set_full(false);
  bench.run(21s);
  EXPECT_FALSE(bench.failing);
  EXPECT_EQ(submap_files(*bench.disk).size(), bench.keeper->submaps());
}

TEST(MapDisk, LeavesRoomForTheRobotsState) {
  MapBench bench("r1", {.min_free = std::size_t{15} << 20U});
  bench.drive(0, 20);
  bench.disk->plant("other", store::Bytes(std::size_t{2} << 20U));
  bench.run(21s);
  EXPECT_TRUE(bench.failing);
  EXPECT_GT(bench.disk->free(), std::uint64_t{13} << 20U);
}

TEST(MapDisk, TheOldestSubmapsGoWhenTheMapTakesTooMuchSpace) {
  MapBench bench("r1", {.max_bytes = 3000});
  bench.drive(0, 150);
  bench.run(120s);
  EXPECT_LT(submap_files(*bench.disk).size(), 9U);
  EXPECT_EQ(submap_files(*bench.disk).size(), bench.keeper->stored_submaps());
  bench.restart();
  EXPECT_EQ(bench.loaded.text(), "");
  EXPECT_GT(bench.keeper->submaps(), 0U);
}

TEST(MapDisk, RemainingSubmapsFollowACorrectionAfterTheFirstOneWasDropped) {
  MapBench bench("r1", {.max_bytes = 3000});
  MapBench::Station early;
  for (double x = 0; x < 150; x += 15) {
    bench.drive(x, x + 15);
    bench.run(12s, &early);
  }
  ASSERT_LT(bench.keeper->stored_submaps(), bench.keeper->submaps());
  bench.frame.T_map_odom = Pose3::level({7, 1, 0}, 0);
  ++bench.frame.map_epoch;
  bench.run(20s, &early);
  MapBench::Station late{.id = {2}};
  bench.run(20s, &late);
  ASSERT_FALSE(late.blocks.empty());
  for (const MapBench::Station* station : {&early, &late})
    for (const auto& [key, blocks] : station->blocks) {
      ASSERT_TRUE(station->poses.contains(key));
      EXPECT_NEAR(station->poses.at(key).T_map_submap.position.y(), 1.0, 0.01);
    }
  EXPECT_LE(late.poses.size(), bench.keeper->stored_submaps() + 1) << "none without a name";
}

TEST(MapDisk, APowerCutAtAnyStepLeavesAMapThatCanBeRead) {
  for (std::uint64_t steps = 0; steps < 6000; steps += 997) {
    MapBench bench;
    bench.disk->cut_power_after(steps);
    bench.drive(0, 20);
    bench.run(21s);
    bench.disk->power_up();
    bench.restart();
    EXPECT_EQ(bench.loaded.text(), "") << steps;
  }
}

TEST(StoredMap, RefusesRandomBytesAndMutations) {
  perception::StoredSubmap submap{.key = {"r1", 5, 1}, .placed = true};
  Random random(7);
  for (int x = 0; x < 200; ++x) {
    const std::uint64_t known = random.next();
    submap.blocks.push_back({{{x, -x, 2}, known, known & random.next()}, static_cast<std::uint32_t>(x * 3)});
  }
  const auto good = perception::encode_stored(submap);
  const auto same = perception::decode_stored_submap(good);
  ASSERT_TRUE(same.ok());
  EXPECT_EQ(same->blocks, submap.blocks);
  perception::StoredPlaces places;
  for (std::uint32_t i = 0; i < 20; ++i) places.poses.push_back({{"r1", 5, i}, {}, i});
  places.peers.push_back({{3}, 9, {1, 2}});
  const auto good_places = perception::encode_stored(places);
  ASSERT_TRUE(perception::decode_stored_places(good_places).ok());
  std::size_t taken = 0;
  for (int n = 0; n < 3000; ++n) {
    auto bytes = n % 2 == 0 ? good : good_places;
    const std::size_t flips = 1 + random.below(4);
    for (std::size_t i = 0; i < flips; ++i)
      bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1U << random.below(8));
    if (random.chance(0.2)) bytes.resize(random.below(bytes.size()));
    taken += perception::decode_stored_submap(bytes).ok() ? 1U : 0U;
    taken += perception::decode_stored_places(bytes).ok() ? 1U : 0U;
  }
  EXPECT_LT(taken, 30U) << "the checksum finds nearly all; flips of unused bits are harmless";
}

}  // namespace
}  // namespace adit::agent
