// SPDX-License-Identifier: Apache-2.0
// The mode `external`, and a second writer of the driver's velocities.
#include "robot_agent/behaviour/modes/external.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "robot_agent/behaviour/decider.hpp"
#include "robot_agent/motion/rival.hpp"
#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

struct ExternalMotion : NavigationInput {
  void accept(MuxKey, const Motion& motion, Time) override { last = motion; }
  Motion last{};
};

class External : public testing::Test {
 protected:
  ExternalMotion nav{};
  Mux mux{nav};
  ExternalMode external{{.output = mux.connect("external", ExternalMode::kFresh)}};
  Time now{Duration{1h}};

  void step(Duration time) {
    now += time;
    mux.step(now);
  }
};

TEST_F(External, PassesWhileItsSourceIsEnabled) {
  external.steer({0.4, 0, 0.1}, now);
  step(50ms);
  EXPECT_EQ(nav.last, Motion{Stand{}}) << "nobody enabled it";
  mux.enable("external", now);
  step(100ms);
  external.steer({0.4, 0, 0.1}, now);
  step(50ms);
  EXPECT_EQ(nav.last, (Motion{Velocity{{0.4, 0, 0.1}, true}}));
}

TEST_F(External, SilenceIsZeroAfterHalfASecond) {
  mux.enable("external", now);
  step(100ms);
  external.steer({0.4, 0, 0}, now);
  step(450ms);
  EXPECT_NE(nav.last, Motion{Stand{}});
  EXPECT_TRUE(external.fresh(now));
  step(100ms);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_FALSE(external.fresh(now));
}

TEST_F(External, ANonFiniteVelocityCountsAsSilence) {
  mux.enable("external", now);
  step(100ms);
  external.steer({std::numeric_limits<double>::quiet_NaN(), 0, 0}, now);
  external.steer({0, std::numeric_limits<double>::infinity(), 0}, now);
  step(50ms);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_FALSE(external.fresh(now));
}

TEST(ExternalTree, ATreeWithoutTheModeReportsItAsNotInstalled) {
  std::ifstream file(source_folder() + "/config/trees/robot.xml");
  std::stringstream text;
  text << file.rdbuf();
  std::string xml = text.str();
  const std::string leaf = "<Mode mode=\"external\"/>";
  const auto decider = Decider::load_text(xml.erase(xml.find(leaf), leaf.size()));
  ASSERT_TRUE(decider) << decider.error().text;
  EXPECT_FALSE((*decider)->installed(*ModeTable::shipped().find("external")));
  EXPECT_TRUE((*decider)->installed(*ModeTable::shipped().find("waypoint")));
  const auto complete = Decider::load(source_folder() + "/config/trees/robot.xml");
  ASSERT_TRUE(complete) << complete.error().text;
  EXPECT_TRUE((*complete)->installed(*ModeTable::shipped().find("external")));
}

class Rival : public testing::Test {
 protected:
  static constexpr wire::ParticipantId kA{1}, kB{2};
  Time start{Duration{1h}};
  RivalWatch watch{start};
};

TEST_F(Rival, IsReportedAtItsThirdSampleAndNotAgainSoon) {
  Time now = start + 10s;
  EXPECT_FALSE(watch.heard(kA, now));
  EXPECT_FALSE(watch.heard(kA, now += 50ms));
  EXPECT_TRUE(watch.heard(kA, now += 50ms));
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(watch.heard(kA, now += 100ms));
  int reports = 0;
  for (int i = 0; i < 200; ++i) reports += watch.heard(kA, now += 100ms);
  EXPECT_EQ(reports, 1) << "once more after half a minute";
}

TEST_F(Rival, ASingleSampleIsAProbeByHand) {
  Time now = start + 10s;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(watch.heard(kA, now += 2s));
}

TEST_F(Rival, TheParentsZerosAtTheStartAreNoRival) {
  Time now = start;
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(watch.heard(kB, now += 50ms));
}

}  // namespace
}  // namespace adit::agent
