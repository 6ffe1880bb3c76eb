// SPDX-License-Identifier: Apache-2.0
// Rule 11: honest poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/drive.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A robot whose pose comes from perception.
void locate(Record& r) {
  r.localisation = Localisation::ok;
  r.sigma = 0.02;
  r.take(1);
  r.enter("waypoint");
  r.pass(500ms);
}

/// Drives on by so much; the error grows by a share of the way.
void drive_on(Record& r, double way, double drift = 0.0) {
  for (const double end = r.pose.x + way; r.pose.x < end; r.pose.x += 0.02) {
    r.error.y() += 0.02 * drift;
    r.pass(40ms, kForward);
  }
}

TEST(CheckerPose, AnErrorWithinItsDeviationsIsHonest) {
  Record r;
  locate(r);
  r.error = {0.0, 0.19};
  drive_on(r, 3.0);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerPose, ALargerErrorMayLastTwoSeconds) {
  Record r;
  locate(r);
  r.error = {0.0, 0.3};
  r.pass(1900ms);
  r.error = {0.0, 0.0};
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  r.error = {0.0, 0.3};
  r.pass(2300ms);
  EXPECT_THAT(r.broken(), ElementsAre(11)) << r.texts();
}

TEST(CheckerPose, AStatedDeviationMakesTheErrorHonest) {
  Record r;
  locate(r);
  r.error = {0.0, 2.0};
  r.sigma = 0.5;
  r.pass(5s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerPose, WithoutPerceptionNothingIsPromised) {
  Record r;
  locate(r);
  r.localisation = Localisation::off;
  r.error = {0.0, 5.0};
  r.pass(5s);
  r.localisation = Localisation::starting;
  r.pass(5s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerPose, TheFirstPoseAndACommandedOneAreTheReference) {
  Record r;
  r.error = {4.0, 0.0};
  r.localisation = Localisation::ok;
  r.pass(5s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  r.take(1);
  const CommandHeard command = r.ask(1, Verb::pose);
  r.answer(command);
  r.error = {-3.0, 1.0};
  r.pass(5s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  r.error = {-3.5, 1.0};
  r.pass(5s);
  EXPECT_THAT(r.broken(), ElementsAre(11)) << r.texts();
}

TEST(CheckerPose, HealthIsNotOkWhileTheErrorGrows) {
  for (const Localisation said : {Localisation::ok, Localisation::weak}) {
    Record r;
    locate(r);
    r.sigma = 1.0;
    r.localisation = said;
    drive_on(r, 25.0, 0.07);
    if (said == Localisation::ok)
      EXPECT_THAT(r.broken(), ElementsAre(11)) << r.texts();
    else
      EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  }
}

TEST(CheckerPose, GrowthBelowItsShareAndACorrectionAreFine) {
  Record r;
  locate(r);
  r.sigma = 1.0;
  drive_on(r, 45.0, 0.04);
  r.error = {0.0, 0.0};
  drive_on(r, 5.0);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

}  // namespace
}  // namespace adit::sim
