// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/model.hpp"

#include <gtest/gtest.h>

namespace adit::wire {
namespace {

double share_lost(const LinkProfile& link, const Path& path, std::uint32_t bytes, int frames = 20000) {
  Random random(7);
  LossModel channel;
  int lost = 0;
  for (int i = 0; i < frames; ++i) lost += channel.lost(link, path, bytes, std::nullopt, random);
  return static_cast<double>(lost) / frames;
}

LinkProfile subt() {
  LinkProfile link;
  link.range = 50;
  link.fading = 2.5;
  link.window = 1.0;
  return link;
}

TEST(LinkModel, FramesBelow250KilobitAreSmall) {
  LinkProfile link;
  link.bandwidth = 249e3;
  EXPECT_EQ(link.frame_bytes(), 500U);
  link.bandwidth = 250e3;
  EXPECT_EQ(link.frame_bytes(), 1400U);
  link.frame = 1500;
  EXPECT_EQ(link.frame_bytes(), 1500U);
}

TEST(LinkModel, LosesItsShareOneByOneOrInBursts) {
  LinkProfile link;
  link.loss = 0.2;
  EXPECT_NEAR(share_lost(link, {}, 100), 0.2, 0.01);
  link.burst = 8;
  EXPECT_NEAR(share_lost(link, {}, 100, 200000), 0.2, 0.02);
  Random random(3);
  LossModel channel;
  int bursts = 0, lost = 0;
  bool before = false;
  for (int i = 0; i < 200000; ++i) {
    const bool now = channel.lost(link, {}, 100, std::nullopt, random);
    bursts += now && !before;
    lost += now;
    before = now;
  }
  EXPECT_NEAR(static_cast<double>(lost) / bursts, 8.0, 0.8);
}

TEST(LinkModel, DegradedLinkLosesTheGivenShare) {
  LinkProfile link;
  Random random(1);
  LossModel channel;
  EXPECT_TRUE(channel.lost(link, {}, 100, 1.0, random));
  EXPECT_FALSE(channel.lost(link, {}, 100, 0.0, random));
}

TEST(LinkModel, ReceivedPowerFallsWithDistanceAndWalls) {
  const LinkProfile link = subt();
  EXPECT_FALSE(received_power(link, {}));
  EXPECT_NEAR(*received_power(link, {1.0, 0.0}), -13.0, 1e-9);
  EXPECT_NEAR(*received_power(link, {0.1, 0.0}), -13.0, 1e-9);
  EXPECT_NEAR(*received_power(link, {10.0, 0.0}), -38.0, 1e-9);
  EXPECT_NEAR(*received_power(link, {10.0, 12.0}), -50.0, 1e-9);
  EXPECT_LT(*received_power(link, {51.0, 0.0}), -300.0);
  EXPECT_FALSE(received_power(LinkProfile{}, {10.0, 0.0}));
}

TEST(LinkModel, WeakSignalsLoseFramesAndLongFramesMoreThanShortOnes) {
  EXPECT_LT(fading_loss(-70, -90, 1500), 1e-9);
  EXPECT_GT(fading_loss(-90, -90, 100), 0.99);
  const double shorter = fading_loss(-80.2, -90, 100), longer = fading_loss(-80.2, -90, 1500);
  EXPECT_GT(shorter, 0.0);
  EXPECT_GT(longer, 5 * shorter);
  const LinkProfile link = subt();
  EXPECT_EQ(share_lost(link, {20.0, 0.0}, 1500), 0.0);
  EXPECT_GT(share_lost(link, {20.0, 60.0}, 1500), 0.9);
  EXPECT_EQ(share_lost(link, {51.0, 0.0}, 1500), 1.0);
}

TEST(LinkModel, ShadowingSpreadsTheEdge) {
  LinkProfile link = subt();
  const Path edge{40.0, 24.0};  // a few dB above where frames begin to be lost
  EXPECT_LT(share_lost(link, edge, 1500), 0.01);
  link.shadowing = 10;
  EXPECT_GT(share_lost(link, edge, 1500), 0.05);
}

TEST(LinkModel, AWindowAdmitsASecondsBitsAndThenDrops) {
  LinkProfile link;
  link.bandwidth = 80e3;
  link.window = 1.0;
  Window window;
  int admitted = 0;
  for (int i = 0; i < 20; ++i) admitted += window.admit(link, 1000, 0ms);
  EXPECT_EQ(admitted, 10);
  EXPECT_FALSE(window.admit(link, 1000, 999ms));
  EXPECT_TRUE(window.admit(link, 1000, 1000ms));
}

TEST(LinkModel, JitterIsAddedToTheLatency) {
  LinkProfile link;
  link.latency = 0.1;
  Random random(1);
  EXPECT_EQ(transit(link, random), 100ms);
  link.jitter = 0.05;
  Duration least = 1s, most{};
  for (int i = 0; i < 1000; ++i) {
    const Duration t = transit(link, random);
    least = std::min(least, t), most = std::max(most, t);
  }
  EXPECT_GE(least, 100ms);
  EXPECT_LT(least, 102ms);
  EXPECT_LE(most, 150ms);
  EXPECT_GT(most, 148ms);
}

}  // namespace
}  // namespace adit::wire
