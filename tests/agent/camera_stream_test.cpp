// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/camera_stream.hpp"

#include <gtest/gtest.h>

namespace adit::agent {
namespace {

constexpr transfer::PeerId kOne{1}, kTwo{2};

class CameraStreamTest : public testing::Test {
 protected:
  static contract::CameraView view(std::uint16_t width, float rate = 15.0F, std::uint32_t shot = 0) {
    return {.robot = "r1", .camera = "front", .width = width, .rate = rate, .shot = shot};
  }
  /// Codes a textured picture of the present rung; `x`: where the texture is.
  void code(int x = 0) {
    const perception::Rung rung = stream.rung();
    perception::Picture picture{.width = rung.width, .height = rung.height};
    for (std::uint32_t i = 0; i < picture.width * picture.height; ++i)
      picture.bytes.push_back(static_cast<std::uint8_t>((i + static_cast<unsigned>(x)) * 37 % 251));
    stream.begin(now);
    stream.prepare_encoder();
    stream.coded(
        stream.encoder()->encode(
            picture, {.width = rung.width, .height = rung.height, .quality = rung.quality}, 300, now),
        5, std::nullopt, now - 40ms, 356, now);
  }
  std::size_t drain() {
    std::size_t pieces = 0;
    while (stream.has_pieces()) {
      last = perception::decode_picture_piece(stream.next_piece(now)).value();
      ++pieces;
    }
    return pieces;
  }
  CameraStream stream{77};
  Time now{100s};
  perception::PicturePiece last{};
};

TEST_F(CameraStreamTest, IsWatchedForThreeSecondsFromTheLastView) {
  EXPECT_FALSE(stream.is_active(now));
  stream.look(kOne, view(640), now);
  EXPECT_TRUE(stream.is_watched(now + 2900ms));
  EXPECT_FALSE(stream.is_watched(now + 3100ms));
  stream.look(kOne, view(0), now);
  EXPECT_FALSE(stream.is_watched(now)) << "a width of 0 ends it at once";
}

TEST_F(CameraStreamTest, CodesTheNextPictureOnlyWhenAllPiecesOfTheLastOneAreSent) {
  stream.look(kOne, view(160), now);
  stream.adapt(50e3, now);
  ASSERT_TRUE(stream.is_ready(now));
  code();
  EXPECT_TRUE(stream.has_pieces());
  now += 2s;
  stream.look(kOne, view(160), now);
  EXPECT_FALSE(stream.is_ready(now)) << "never two pictures are queued";
  EXPECT_GT(drain(), 1U);
  EXPECT_EQ(last.header.run, 77U);
  EXPECT_EQ(last.header.frame, 1U);
  EXPECT_EQ(last.header.age, 2040) << "at the sending, from the exposure, ms";
  EXPECT_TRUE(stream.is_ready(now));
}

TEST_F(CameraStreamTest, TheOneThatWantsMostDecides) {
  stream.look(kOne, view(160, 1.0F), now);
  stream.adapt(1e6, now);
  const auto narrow = stream.rung().width;
  EXPECT_LE(narrow, 160);
  stream.look(kTwo, view(640, 15.0F), now);
  for (int i = 0; i < 10; ++i) stream.adapt(1e6, now += 500ms), stream.look(kTwo, view(640), now);
  EXPECT_GT(stream.rung().width, narrow);
}

TEST_F(CameraStreamTest, SendsAgainWhatAStationLacks) {
  stream.look(kOne, view(160), now);
  stream.adapt(50e3, now);
  code();
  drain();
  code();
  EXPECT_EQ(drain(), 1U);
  EXPECT_TRUE(last.stripes.empty()) << "nothing changed";
  contract::CameraView lacks = view(160);
  lacks.run = 77;
  lacks.frame = 2;
  lacks.missing = {0b101};
  stream.look(kOne, lacks, now);
  code();
  std::vector<std::uint16_t> sent;
  while (stream.has_pieces()) {
    const auto piece = perception::decode_picture_piece(stream.next_piece(now)).value();
    for (const perception::Stripe& stripe : piece.stripes) sent.push_back(stripe.index);
  }
  EXPECT_EQ(sent, (std::vector<std::uint16_t>{0, 2}));
}

TEST_F(CameraStreamTest, AStationThatBeginsToLookGetsAllStripes) {
  stream.look(kOne, view(160), now);
  stream.adapt(50e3, now);
  code();
  const std::size_t all = drain();
  code();
  drain();
  stream.look(kTwo, view(160), now);
  code();
  EXPECT_EQ(drain(), all);
}

TEST_F(CameraStreamTest, ReportsWhatArrived) {
  stream.look(kOne, view(160), now);
  stream.adapt(50e3, now);
  code();
  const auto pieces = static_cast<std::uint32_t>(drain());
  contract::CameraView half = view(160);
  half.run = 77;
  half.frame = 1;
  half.arrived = pieces / 2;
  stream.look(kOne, half, now);
  EXPECT_EQ(stream.take_arrivals().sent, 0U) << "of the first report it is not known what could arrive";
  code(100);
  const auto more = static_cast<std::uint32_t>(drain());
  half.frame = 2;
  half.arrived += more / 2;
  stream.look(kOne, half, now);
  const auto arrivals = stream.take_arrivals();
  EXPECT_EQ(arrivals.sent, more);
  EXPECT_EQ(arrivals.arrived, more / 2);
  half.run = 5;
  stream.look(kOne, half, now);
  EXPECT_EQ(stream.take_arrivals().sent, 0U) << "of another run";
}

TEST_F(CameraStreamTest, AShotIsTakenOnceForEachRequest) {
  stream.look(kOne, view(0, 0, 4), now);
  EXPECT_TRUE(stream.shot_wanted(now));
  EXPECT_FALSE(stream.is_watched(now));
  EXPECT_EQ(stream.wanted_shots(now).size(), 1U);
  EXPECT_TRUE(stream.shot_wanted(now)) << "until it was taken: a broken picture is none";
  stream.took_shot(kOne, 4);
  stream.look(kOne, view(0, 0, 4), now);
  EXPECT_FALSE(stream.shot_wanted(now)) << "the request is repeated until the picture is there";
  stream.look(kOne, view(0, 0, 5), now);
  EXPECT_TRUE(stream.shot_wanted(now));
  EXPECT_FALSE(stream.shot_wanted(now + CameraStream::kShotWait));
}

TEST_F(CameraStreamTest, ARateThatWasLowDoesNotDelayTheNextOne) {
  stream.look(kOne, view(160, 0.1F), now);
  stream.adapt(50e3, now);
  code();
  drain();
  now += 1s;
  stream.adapt(50e3, now);
  EXPECT_FALSE(stream.is_ready(now));
  stream.look(kTwo, view(160, 15.0F), now);
  stream.adapt(50e3, now);
  EXPECT_TRUE(stream.is_ready(now));
}

TEST_F(CameraStreamTest, PiecesOfAnotherTimeAreNotSent) {
  stream.look(kOne, view(160), now);
  stream.adapt(50e3, now);
  code();
  EXPECT_TRUE(stream.has_pieces());
  now += 60s;
  stream.look(kOne, view(160), now);
  EXPECT_FALSE(stream.has_pieces());
}

TEST_F(CameraStreamTest, IsBoundedInLookers) {
  for (std::uint8_t i = 0; i < 40; ++i) stream.look(transfer::PeerId{i}, view(64), now);
  stream.look(transfer::PeerId{200}, view(640), now);
  stream.adapt(1e7, now);
  EXPECT_LE(stream.rung().width, 80) << "the last one had no room";
}

}  // namespace
}  // namespace adit::agent
