// SPDX-License-Identifier: Apache-2.0
// Errors of trajectories: small cases by hand; the numbers of a longer pair come from elsewhere, see below.
#include "sim/cloud/evaluation.hpp"

#include <gtest/gtest.h>

#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

std::vector<StampedPose> line_of(std::size_t count, double step) {
  std::vector<StampedPose> out;
  for (std::size_t n = 0; n < count; ++n) {
    const double x = step * static_cast<double>(n);
    out.push_back({0.1 * static_cast<double>(n), {{x, x * x, 0}, Eigen::Quaterniond::Identity()}});
  }
  return out;
}

TEST(Evaluation, StatisticsOfAList) {
  const ErrorStatistics s = statistics(std::vector<double>{4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.sse, 30);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(statistics(std::vector<double>{5, 1, 2}).median, 2);
}

TEST(Evaluation, AlignmentUndoesAMotion) {
  const std::vector<StampedPose> truth = line_of(30, 0.2);
  const Pose3 moved{{4, -2, 1},
                    Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()))};
  std::vector<StampedPose> estimate = truth;
  for (StampedPose& pose : estimate) pose.pose = moved * pose.pose;
  EXPECT_GT(evaluate(truth, estimate, {}).value().ate.min, 1.0);
  const Evaluation aligned = evaluate(truth, estimate, {.align = true}).value();
  EXPECT_LT(aligned.ate.max, 1e-9);
  EXPECT_LT(aligned.ate_deg.max, 1e-6);
  EXPECT_LT(aligned.rpe.max, 1e-9);
  EXPECT_EQ(aligned.poses, 30u);
  EXPECT_EQ(aligned.pairs, 29u);
}

TEST(Evaluation, AssociatesTheNearestStampsOfTheShorterOne) {
  std::vector<StampedPose> truth = line_of(10, 1.0), estimate;
  estimate.push_back({0.105, {{1, 1, 0}}});   // Belongs to 0.1.
  estimate.push_back({0.15, {{99, 0, 0}}});   // Belongs to none.
  estimate.push_back({0.491, {{5, 25, 0}}});  // Belongs to 0.5.
  for (const bool shuffled : {false, true}) {
    if (shuffled) std::swap(truth[1], truth[8]);
    const auto result = evaluate(truth, estimate, {});
    ASSERT_TRUE(result.ok()) << result.error().text;
    EXPECT_EQ(result->poses, 2u);
    EXPECT_EQ(result->ate.max, 0.0);
    EXPECT_EQ(evaluate(estimate, truth, {}).value().poses, 2u);
  }
}

TEST(Evaluation, RelativeErrorsByPosesOrMetres) {
  std::vector<StampedPose> truth = line_of(11, 0.0), estimate = truth;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    truth[n].pose.position = {1.0 * static_cast<double>(n), 0, 0};
    estimate[n].pose.position = {1.1 * static_cast<double>(n), 0, 0};
  }
  EXPECT_NEAR(evaluate(truth, estimate, {}).value().rpe.mean, 0.1, 1e-12);
  const Evaluation five = evaluate(truth, estimate, {.delta = 5}).value();
  EXPECT_EQ(five.pairs, 2u);
  EXPECT_NEAR(five.rpe.max, 0.5, 1e-12);
  // The marks are at poses 2, 4, 6, 8 and 10.
  const Evaluation metres = evaluate(truth, estimate, {.delta = 2, .delta_in_metres = true}).value();
  EXPECT_EQ(metres.pairs, 4u);
  EXPECT_NEAR(metres.rpe.mean, 0.2, 1e-12);
}

TEST(Evaluation, ComparisonOfDifferentTypesIsAnError) {
  const std::vector<StampedPose> truth = line_of(10, 1.0);
  std::vector<StampedPose> later = truth;
  for (StampedPose& pose : later) pose.stamp_s += 100;
  EXPECT_EQ(evaluate(truth, later, {}).reason(), Reason::bad_argument);
  EXPECT_EQ(evaluate(truth, {}, {}).reason(), Reason::bad_argument);
  EXPECT_EQ(evaluate({}, {}, {}).reason(), Reason::bad_argument);
  EXPECT_EQ(evaluate(truth, truth, {.delta = 50}).reason(), Reason::bad_argument);
  std::vector<StampedPose> straight = truth;
  for (StampedPose& pose : straight) pose.pose.position.y() = 0;
  EXPECT_EQ(evaluate(straight, straight, {.align = true}).reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::sim
