// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_reporter.hpp"

#include <gtest/gtest.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::agent {
namespace {

class StairsReporterTest : public ::testing::Test {
 protected:
  Staircase six_steps() const {
    return {.foot = {8.0, 2.5, 0.1},
            .rise = 0.2,
            .run = 0.3,
            .width = 1.2,
            .steps = 6,
            .sigma = {.place = 0.02, .heading = 0.01, .rise = 0.004, .run = 0.005, .width = 0.05}};
  }
  /// Those of all findings, after changes had time to get a revision.
  std::vector<Staircase> stored() {
    source_.tick(Time{} + 5s);
    source_.tick(Time{} + 10s);
    std::vector<Staircase> out;
    for (const auto& [key, finding] : source_.finding_store().all())
      out.push_back(findings::stairs_of(finding).value());
    return out;
  }

  VirtualScheduler scheduler_{1};
  std::unique_ptr<Runtime> machine_{scheduler_.machine("r1", 5s)};
  std::shared_ptr<Executor> strand_{machine_->strand("command")};
  FindingSource source_{{.robot = "r1"}, nullptr, *strand_, nullptr, {}};
  StairsReporter reporter_{"r1", source_};
};

TEST_F(StairsReporterTest, ReportsOnce) {
  for (int n = 0; n < 5; ++n) EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_EQ(stored()[0].steps, 6);
}

TEST_F(StairsReporterTest, NamesAllThatItReportedAndHasNotWithdrawn) {
  EXPECT_TRUE(reporter_.all().empty());
  Staircase upper = six_steps();
  upper.foot.z() += 3.0;
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  EXPECT_TRUE(reporter_.take({2, upper}, 1));
  ASSERT_EQ(reporter_.all().size(), 2U);
  EXPECT_TRUE(source_.withdraw(source_.finding_store().all().begin()->first.id));
  EXPECT_EQ(stored().size(), 2U);
  EXPECT_EQ(reporter_.all().size(), 1U);
}

TEST_F(StairsReporterTest, ACorrectedMapMovesItAndMakesNoSecondOne) {
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  Staircase moved = six_steps();
  moved.foot.y() += 3.0;  // Farther than the width.
  EXPECT_TRUE(reporter_.take({1, moved}, 2));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_NEAR(stored()[0].foot.y(), 5.5, 1e-9);
}

TEST_F(StairsReporterTest, AfterARestartItRecognisesWhatItReported) {
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  StairsReporter again("r1", source_);
  Staircase part = six_steps();
  part.steps = 4;
  EXPECT_TRUE(again.take({7, part}, 2));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_EQ(stored()[0].steps, 6) << "fewer are in view";
}

TEST_F(StairsReporterTest, AnotherStaircaseIsAnotherFinding) {
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  Staircase other = six_steps();
  other.foot.y() += 3.0;
  EXPECT_TRUE(reporter_.take({2, other}, 2));
  EXPECT_EQ(stored().size(), 2U);
}

TEST_F(StairsReporterTest, OneThatIsGoneIsWithdrawnAndComesBackWhenItIsSeenAgain) {
  const auto withdrawn = [&] { return source_.finding_store().all().begin()->second.withdrawn; };
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  ASSERT_EQ(stored().size(), 1U);
  reporter_.withdraw(2);
  (void)stored();
  EXPECT_FALSE(withdrawn()) << "another one is gone";
  reporter_.withdraw(1);
  (void)stored();
  EXPECT_TRUE(withdrawn());
  EXPECT_TRUE(reporter_.take({3, six_steps()}, 2));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_FALSE(withdrawn());
}

TEST_F(StairsReporterTest, AStepThatWasRefutedIsTakenBackAlsoWhenItWasReported) {
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  Staircase five = six_steps();
  five.steps = 5;
  EXPECT_TRUE(reporter_.take({.id = 1, .stairs = five, .top_known = true}, 2));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_EQ(stored()[0].steps, 5);
}

}  // namespace
}  // namespace adit::agent
