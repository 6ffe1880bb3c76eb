// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_receiver.hpp"

#include <gtest/gtest.h>

#include "basestation/map/status.hpp"
#include "core/time/random.hpp"
#include "core/transfer/piece.hpp"

namespace adit::station {
namespace {

using perception::BlockUpdate;
using perception::SubmapKey;

constexpr std::uint8_t kBlocks = 1, kPoses = 2;

std::vector<std::uint8_t> some_blocks(const std::string& robot, Random& random) {
  std::vector<BlockUpdate> updates;
  for (int x = 0; x < 12; ++x) {
    const std::uint64_t known = random.next();
    updates.push_back({{{x, static_cast<int>(random.below(5)), 0}, known, known & random.next()},
                       static_cast<std::uint32_t>(random.below(1000) + 1)});
  }
  return perception::pack({robot, 5, 0}, updates, transfer::kMaxPieceBytes).bytes;
}

TEST(MapReceiver, StoresAPiece) {
  Random random(1);
  MapReceiver map;
  ASSERT_TRUE(map.take("r1", kBlocks, 30, some_blocks("r1", random), Time{}).ok());
  EXPECT_EQ(map.chunks().blocks(), 12U);
  EXPECT_EQ(map.chunks().robots().at("r1").waiting, 30U);
}

TEST(MapReceiver, RefusesAPieceOfAnotherRobotsMap) {
  Random random(1);
  MapReceiver map;
  EXPECT_EQ(map.take("r1", kBlocks, 0, some_blocks("r2", random), Time{}).reason(), Reason::malformed);
  EXPECT_EQ(map.chunks().blocks(), 0U);
  EXPECT_EQ(map.refused(), 1U);
}

TEST(MapReceiver, SaysThatItDoesNotKnowAKind) {
  MapReceiver map;
  EXPECT_EQ(map.take("r1", 77, 0, std::vector<std::uint8_t>{1, 2, 3}, Time{}).reason(),
            Reason::not_supported);
  EXPECT_EQ(map.refused(), 1U);
}

TEST(MapReceiver, SurvivesHostilePieces) {
  Random random(5);
  MapReceiver map;
  std::vector<std::vector<std::uint8_t>> genuine(
      300);  // Encoding takes far longer than decoding to an error.
  for (auto& piece : genuine) piece = some_blocks("r1", random);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> bytes = genuine[random.below(genuine.size())];
    for (std::uint64_t n = random.below(4) + 1; n > 0; --n) {
      switch (random.below(3)) {
        case 0:
          bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1U << random.below(8));
          break;
        case 1:
          bytes.resize(random.below(bytes.size()) + 1);
          break;
        default:
          bytes.push_back(static_cast<std::uint8_t>(random.next()));
      }
    }
    (void)map.take("r1", static_cast<std::uint8_t>(random.below(4)),
                   static_cast<std::uint32_t>(random.next()), bytes, Time{i * 1ms});
  }
  EXPECT_GT(map.refused(), 0U);
  for (const auto& [key, submap] : map.chunks().robots().at("r1").submaps) {
    EXPECT_EQ(key.robot, "r1");
    for (const auto& [index, block] : submap.blocks) EXPECT_EQ(block.occupied & ~block.known, 0U);
  }
  EXPECT_FALSE(map_status_text(map, Time{60s}).empty());
}

TEST(MapReceiver, StatusSaysWhatIsThereAndWhatIsMissing) {
  Random random(1);
  MapReceiver map;
  EXPECT_NE(map_status_text(map, Time{}).find("no map"), std::string::npos);
  ASSERT_TRUE(map.take("r1", kBlocks, 30, some_blocks("r1", random), Time{}).ok());
  EXPECT_NE(map_status_text(map, Time{3s}).find("the place of 1 submaps"), std::string::npos);
  const perception::SubmapPoses poses{{{{"r1", 5, 0}, Pose3{}, 1}}};
  ASSERT_TRUE(map.take("r1", kPoses, 0, perception::encode(poses), Time{}).ok());
  const auto json = map_status_json(map, Time{3s});
  EXPECT_GT(json["m2"].get<double>(), 1.0);
  EXPECT_EQ(json["robots"][0]["robot"], "r1");
  EXPECT_EQ(json["robots"][0]["age"], 3.0);
  EXPECT_EQ(json["robots"][0]["submaps_without_pose"], 0);
  EXPECT_EQ(json["robots"][0]["share"], 1.0);
  const auto blocks = static_cast<std::uint32_t>(map.chunks().robots().at("r1").blocks);
  ASSERT_TRUE(map.take("r1", kPoses, 3 * blocks, perception::encode(poses), Time{}).ok());
  EXPECT_EQ(map_status_json(map, Time{3s})["robots"][0]["share"], 0.25);
  EXPECT_NE(map_status_text(map, Time{3s}).find("25 %"), std::string::npos);
}

}  // namespace
}  // namespace adit::station
