// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/ladder.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <random>

namespace adit::perception {
namespace {

/// Whole pictures of a scene; 1: as the ladder expects.
std::size_t bytes_on(const Rung& rung, double scene) {
  const double pixels = rung.width * rung.height;
  return static_cast<std::size_t>(scene * pixels * (rung.colour ? 0.11 : 0.12) *
                                  std::pow(rung.quality / 35.0, 0.6) * std::pow(76'800.0 / pixels, 0.15));
}

struct LadderRun {
  Ladder ladder{};
  Time now{};
  LadderInput input{1e4, 2000, 30.0};
  Ladder::Choice choice{};
  int changes{};
  double bytes{};

  void run(Duration time, const auto& scene) {
    const Time end = now + time;
    while (now < end) {
      const Ladder::Choice next = ladder.choose(input, now);
      if (!(next.rung == choice.rung)) ++changes;
      choice = next;
      const std::size_t size = bytes_on(choice.rung, scene());
      ladder.coded(choice.rung, size, true);
      bytes += static_cast<double>(size);
      now += choice.period;
    }
  }
  double rate() const { return 1.0 / seconds(choice.period); }
};

double usual() { return 1.0; }

TEST(CameraLadder, ReachesThePointsOfTheDesign) {
  const auto at = [](double bits_per_second) {
    LadderRun run;
    run.input.bytes_per_second = bits_per_second / 8.0;
    run.run(30s, usual);
    return run;
  };
  const LadderRun thin = at(30e3), middle = at(150e3), wide = at(6e6);
  EXPECT_EQ(thin.choice.rung.width, 160);
  EXPECT_EQ(thin.choice.rung.quality, 25);
  EXPECT_FALSE(thin.choice.rung.colour);
  EXPECT_GE(thin.rate(), 1.0);
  EXPECT_LE(thin.rate(), 2.0);
  EXPECT_EQ(middle.choice.rung.width, 320);
  EXPECT_EQ(middle.choice.rung.quality, 35);
  EXPECT_GE(middle.rate(), 2.0);
  EXPECT_LE(middle.rate(), 4.0);
  EXPECT_EQ(wide.choice.rung.width, 640);
  EXPECT_EQ(wide.choice.rung.quality, 70);
  EXPECT_GT(wide.rate(), 12.0);
  EXPECT_LE(wide.rate(), 15.0 + 1e-6);
}

TEST(CameraLadder, NeverSendsMoreThanTheLinkLeaves) {
  for (const double room : {300.0, 2e3, 2e4, 2e5, 2e6})
    for (const double scene : {0.4, 1.0, 3.0}) {
      LadderRun run;
      run.input.bytes_per_second = room;
      run.run(60s, [&] { return scene; });
      EXPECT_LT(run.bytes, 1.1 * room * seconds(run.now.time_since_epoch()) + 50'000) << room << " " << scene;
      EXPECT_LE(run.changes, 4) << room << " " << scene;
    }
}

TEST(CameraLadder, DoesNotSwing) {
  // Pictures vary by a third, and the room by a tenth.
  std::minstd_rand random(6);
  const auto vary = [&](double part) {
    return 1.0 + part * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
  };
  LadderRun run;
  for (double room = 2'000.0; room < 1e6; room *= 1.7) {
    for (int i = 0; i < 80; ++i) {
      if (i == 20) run.changes = 0;
      run.input.bytes_per_second = room * vary(0.1);
      run.run(1s, [&] { return vary(0.33); });
    }
    EXPECT_LE(run.changes, 2) << room;
  }
}

TEST(CameraLadder, StepsDownAtOnceAndUpAfterSomeTime) {
  LadderRun run;
  run.input.bytes_per_second = 750e3;
  run.run(5s, usual);
  EXPECT_EQ(run.choice.rung.width, 640);
  run.input.bytes_per_second = 4e3;
  EXPECT_EQ(run.ladder.choose(run.input, run.now).rung.width, 160);
  run.input.bytes_per_second = 750e3;
  EXPECT_EQ(run.ladder.choose(run.input, run.now).rung.width, 160);
  EXPECT_EQ(run.ladder.choose(run.input, run.now + 2900ms).rung.width, 160);
  EXPECT_EQ(run.ladder.choose(run.input, run.now + 3000ms).rung.width, 640);
}

TEST(CameraLadder, LearnsTheSceneAndTheRung) {
  LadderRun run;
  run.input.bytes_per_second = 20e3;
  run.run(10s, usual);
  const Rung before = run.choice.rung;
  run.run(20s, [] { return 4.0; });
  EXPECT_LT(run.choice.rung.width, before.width);
  run.run(60s, usual);
  EXPECT_EQ(run.choice.rung, before);
}

TEST(CameraLadder, SendsFasterWhatDoesNotChangeButOnTheSameRung) {
  LadderRun run;
  run.input.bytes_per_second = 20e3;
  run.run(10s, usual);
  const Rung rung = run.choice.rung;
  for (int i = 0; i < 40; ++i) run.ladder.coded(rung, 500, false);
  const auto still = run.ladder.choose(run.input, run.now);
  EXPECT_EQ(still.rung, rung);
  EXPECT_NEAR(1.0 / seconds(still.period), rung.most_rate, 0.01);
  // One large picture is enough to slow down.
  run.ladder.coded(rung, 10'000, false);
  EXPECT_GE(seconds(run.ladder.choose(run.input, run.now).period), 0.5);
}

TEST(CameraLadder, SendsNoMoreThanIsLookedAt) {
  LadderRun run;
  run.input = {1e6, 300, 2.0};
  run.run(10s, usual);
  EXPECT_EQ(run.choice.rung.width, 320);
  EXPECT_EQ(run.choice.rung.quality, 50);
  EXPECT_NEAR(run.rate(), 2.0, 0.01);
  for (const LadderInput none :
       {LadderInput{1e6, 0, 5.0}, LadderInput{1e6, 640, 0.0}, LadderInput{0.0, 640, 5.0}})
    EXPECT_EQ(run.ladder.choose(none, run.now).period, Ladder::kNoPicture);
}

}  // namespace
}  // namespace adit::perception
