// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/shot_source.hpp"

#include <gtest/gtest.h>

#include "core/transfer/shot_piece.hpp"

namespace adit::agent {
namespace {

constexpr transfer::PeerId kAsks{1}, kOther{2};

TakenShot shot(std::size_t bytes = 1000) {
  TakenShot out{.station = kAsks, .number = 1, .camera = "front"};
  out.jpeg.assign(bytes, 7);
  return out;
}

class ShotSourceTest : public testing::Test {
 protected:
  std::optional<transfer::Source::Content> next(std::initializer_list<transfer::PeerId> peers,
                                                std::size_t most = 350) {
    const std::vector<transfer::PeerId> all(peers);
    return source.next(all, most, now);
  }
  ShotSource source{};
  Time now{};
};

TEST_F(ShotSourceTest, GoesToTheStationThatAskedOnly) {
  source.add(shot(), now);
  EXPECT_EQ(source.missing(kAsks), 4U) << "blocks of 256 bytes";
  EXPECT_EQ(source.missing(kOther), 0U);
  EXPECT_FALSE(next({kOther, kAsks}).has_value()) << "the peer that lacks most comes first";
  EXPECT_TRUE(next({kAsks, kOther}).has_value());
}

TEST_F(ShotSourceTest, LostBlocksComeAgainAndItEndsWhenAllAreThere) {
  source.add(shot(), now);
  const auto first = next({kAsks});
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(source.missing(kAsks), 3U);
  source.lost(kAsks, first->token);
  source.settled(first->token);
  EXPECT_EQ(source.missing(kAsks), 4U);
  std::vector<std::uint8_t> jpeg(1000);
  while (const auto content = next({kAsks})) {
    EXPECT_LE(content->data.size(), 350U);
    const auto piece = transfer::decode_shot_piece(content->data);
    ASSERT_TRUE(piece.ok());
    std::ranges::copy(piece->data,
                      jpeg.begin() + static_cast<std::ptrdiff_t>(piece->first * transfer::kShotBlock));
    source.acknowledged(kAsks, content->token);
    source.settled(content->token);
  }
  EXPECT_EQ(jpeg, shot().jpeg);
  EXPECT_EQ(source.size(), 0U);
}

TEST_F(ShotSourceTest, AStationThatComesBackGetsAll) {
  source.add(shot(), now);
  const auto content = next({kAsks});
  source.acknowledged(kAsks, content->token);
  source.join(kAsks);
  EXPECT_EQ(source.missing(kAsks), 4U);
}

TEST_F(ShotSourceTest, IsBoundedInNumberAndTime) {
  for (std::uint32_t i = 1; i <= 10; ++i) {
    TakenShot each = shot();
    each.number = i;
    source.add(std::move(each), now);
  }
  EXPECT_EQ(source.size(), ShotSource::kMost);
  source.tick(now + ShotSource::kPatience + 1s);
  EXPECT_EQ(source.size(), 0U);
  source.add(shot(transfer::ShotPiece::kMaxPicture + 1), now);
  EXPECT_EQ(source.size(), 0U);
}

TEST_F(ShotSourceTest, OneThatIsNotWantedAnyMoreGoes) {
  source.add(shot(), now);
  source.wanted(kOther, "front", 0);
  source.wanted(kAsks, "back", 0);
  source.wanted(kAsks, "front", 1);
  EXPECT_EQ(source.size(), 1U);
  source.wanted(kAsks, "front", 2);
  EXPECT_EQ(source.size(), 0U);
}

TEST_F(ShotSourceTest, AStationNeverCostsAnotherOneItsPicture) {
  for (std::uint32_t i = 1; i <= ShotSource::kMost; ++i) {
    TakenShot each = shot();
    each.number = i;
    source.add(std::move(each), now);
  }
  TakenShot other = shot();
  other.station = kOther;
  source.add(std::move(other), now);
  EXPECT_EQ(source.missing(kOther), 0U);
  EXPECT_EQ(source.size(), ShotSource::kMost);
}

TEST_F(ShotSourceTest, ARepeatedRequestReplacesItsPicture) {
  source.add(shot(), now);
  source.add(shot(300), now);
  EXPECT_EQ(source.size(), 1U);
  EXPECT_EQ(source.missing(kAsks), 2U);
}

}  // namespace
}  // namespace adit::agent
