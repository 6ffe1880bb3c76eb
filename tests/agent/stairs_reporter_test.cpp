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

  StairsReporter::Submaps submaps() {
    return {[this](const findings::Anchor& at) {
              ++lookups_;
              return at.start == 2 && at.submap == 4 ? T_map_submap_ : std::nullopt;
            },
            [this] { return pose_changes_; }};
  }
  void move_submap(std::optional<Pose3> to) {
    T_map_submap_ = to;
    ++pose_changes_;
  }
  std::optional<findings::Anchor> anchor(const std::array<double, 3>& place) const {
    if (!T_map_submap_) return std::nullopt;
    const Eigen::Vector3f offset =
        (T_map_submap_->inverse() * Eigen::Vector3d(place[0], place[1], place[2])).cast<float>();
    return findings::Anchor{
        2, 4, {offset.x(), offset.y(), offset.z()}, static_cast<float>(T_map_submap_->yaw())};
  }

  VirtualScheduler scheduler_{1};
  std::unique_ptr<Runtime> machine_{scheduler_.machine("r1", 5s)};
  std::shared_ptr<Executor> strand_{machine_->strand("command")};
  /// Of the one submap, with the number 4 of start 2.
  std::optional<Pose3> T_map_submap_{};
  FindingSource source_{{.robot = "r1"}, nullptr, *strand_, nullptr, {.anchor = [this](const auto& place) {
                          return anchor(place);
                        }}};
  std::uint64_t pose_changes_{};
  int lookups_{};
  StairsReporter reporter_{"r1", source_, submaps()};
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

TEST_F(StairsReporterTest, ThoseThatItKnowsMoveWithTheirSubmapAndAreRecognisedThere) {
  move_submap(Pose3::level({5, 2, 0}, 0));
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  // The map was corrected by 0.5 m and 0.1 rad about the submap's origin.
  move_submap(Pose3::level({5, 2.5, 0.1}, 0));
  ASSERT_EQ(reporter_.all().size(), 1U);
  const Staircase now = reporter_.all()[0];
  const Eigen::Vector3d foot = *T_map_submap_ * Eigen::Vector3d(3.0, 0.5, 0.1);
  EXPECT_LT((now.foot - foot).norm(), 1e-5) << now.foot.transpose();
  EXPECT_NEAR(now.heading, six_steps().heading + 0.1, 1e-4);
  // What is seen where it is now is the same flight and is no change, also after a restart.
  StairsReporter again("r1", source_, submaps());
  EXPECT_TRUE(again.take({7, now}, 2));
  ASSERT_EQ(stored().size(), 1U);
  EXPECT_NEAR(stored()[0].foot.y(), 2.5, 1e-9) << "no new revision";
  // One whose submap is unknown stays where it was reported.
  move_submap(std::nullopt);
  EXPECT_NEAR(reporter_.all().at(0).foot.y(), 2.5, 1e-9);
}

TEST_F(StairsReporterTest, DecodesThemOnceForEachChange) {
  move_submap(Pose3::level({5, 2, 0}, 0));
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  const auto lookups_of_all = [this] {
    const int before = lookups_;
    EXPECT_FALSE(reporter_.all().empty());
    return lookups_ - before;
  };
  EXPECT_EQ(lookups_of_all(), 1);
  EXPECT_EQ(lookups_of_all(), 0);
  move_submap(Pose3::level({5, 3, 0}, 0));
  EXPECT_EQ(lookups_of_all(), 1);
  Staircase upper = six_steps();
  upper.foot.z() += 3.0;
  EXPECT_TRUE(reporter_.take({2, upper}, 1));
  EXPECT_EQ(lookups_of_all(), 2);
  EXPECT_EQ(lookups_of_all(), 0);
}

TEST_F(StairsReporterTest, AfterARestartItRecognisesWhatItReported) {
  EXPECT_TRUE(reporter_.take({1, six_steps()}, 1));
  StairsReporter again("r1", source_, {});
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
