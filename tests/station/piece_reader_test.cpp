// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/piece_reader.hpp"

#include <gtest/gtest.h>

namespace adit::station {
namespace {

using namespace std::chrono_literals;

class PieceReaderTest : public testing::Test {
 protected:
  void take(std::uint32_t session, std::uint32_t id, std::uint8_t kind = 3, const std::string& robot = "r1") {
    reader.take({robot, session, id, kind, 0, {}});
  }
  /// The receipt of a robot's pieces.
  transfer::Receipt receipt(const std::string& robot = "r1") {
    now += 5s;
    if (const auto due = reader.due(1e5))
      for (const auto& [name, receipt] : *due)
        if (name == robot) return receipt;
    return {};
  }

  Time now{};
  Result<void> result{};
  std::map<std::uint32_t, PieceReader::Stored> stored{};
  PieceReader reader{[this] { return now; },
                     [this](const PieceReader::Piece& piece, PieceReader::Stored done) {
                       stored[piece.id] = std::move(done);
                       return result;
                     }};
};

TEST_F(PieceReaderTest, AcknowledgesAPieceOnceItsContentIsStored) {
  take(5, 1);
  take(5, 2);
  EXPECT_FALSE(receipt().has(1));
  stored.at(2)();
  EXPECT_FALSE(receipt().has(1));
  EXPECT_TRUE(receipt().has(2));
  stored.at(1)();
  EXPECT_TRUE(receipt().has(1));
  EXPECT_EQ(reader.refused(transfer::Kind::findings), 0U);
}

TEST_F(PieceReaderTest, WhatIsStoredAfterARestartOfTheRobotIsNotAcknowledged) {
  take(5, 1);
  take(6, 1);
  stored.at(1)();  // Of session 6.
  EXPECT_EQ(receipt().session, 6U);
  take(5, 3);
  take(6, 4);
  stored.at(3)();
  EXPECT_EQ(receipt().session, 6U) << "the receipt stays the one of the present session";
  EXPECT_TRUE(receipt().has(1));
  EXPECT_FALSE(receipt().has(3));
}

TEST_F(PieceReaderTest, CountsWhatIsRefusedByKind) {
  result = {Reason::malformed, "damaged"};
  take(5, 1);
  take(5, 2);
  EXPECT_EQ(reader.refused(transfer::Kind::findings), 2U);
  EXPECT_EQ(reader.refused(transfer::Kind::map_blocks), 0U);
}

TEST_F(PieceReaderTest, AcknowledgesARefusedPieceIfItsTakerWantsThat) {
  result = {Reason::not_supported, "unknown"};
  take(5, 2, 77);
  stored.at(2)();
  EXPECT_TRUE(receipt().has(2));
}

TEST_F(PieceReaderTest, IsBoundedWhateverTheNumberOfRobots) {
  for (int i = 0; i < 1000; ++i) take(5, 1, 3, "r" + std::to_string(i));
  take(5, 1, 3, "r1");
  stored.at(1)();
  EXPECT_TRUE(receipt("r1").has(1));
}

TEST_F(PieceReaderTest, ASurplusOfRobotsDoesNotDisplaceThoseThatAreHeard) {
  take(5, 1, 3, "r1");
  const PieceReader::Stored of_r1 = stored.at(1);
  for (int i = 0; i < 200; ++i) {
    take(5, 2, 3, "surplus" + std::to_string(i));
    stored.at(2)();
  }
  of_r1();
  EXPECT_TRUE(receipt("r1").has(1)) << "its disk took some time";
  now += 31s;
  take(5, 3, 3, "late");
  stored.at(3)();
  EXPECT_TRUE(receipt("late").has(3)) << "others are silent";
}

}  // namespace
}  // namespace adit::station
