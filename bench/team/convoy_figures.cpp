// SPDX-License-Identifier: Apache-2.0
#include "bench/team/convoy_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::bench {
namespace {

const double kPeriod = seconds(sim::Trail::kPeriod);
constexpr double kStands = 0.05;   // m/s
constexpr double kSmoothed = 1.0;  // s: a speed is the mean over so long.
constexpr double kSettled = 8.0;   // s: the steady state at a speed is its last part.
constexpr double kSpliced = 0.3;   // Share of the wanted gap.

std::size_t index(double at_s) { return static_cast<std::size_t>(std::lround(at_s / kPeriod)); }

/// The poses of a convoy, as figures are computed from them. Times are indices of the trails.
class Run {
 public:
  Run(const ConvoyCourse& course, const sim::RunOutcome& run) : course_(course) {
    end_ = std::numeric_limits<std::size_t>::max();
    for (int i = 0; i < course.robots; ++i) {
      trails_.push_back(&run.trails.at(course.name(i)).poses);
      end_ = std::min(end_, trails_.back()->size());
    }
    // The leader's path: from where the last robot starts, and only where it moved.
    path_.push_back(trails_.back()->front().position());
    for (const Pose2& pose : *trails_.front())
      if ((pose.position() - path_.back()).norm() > 0.02) path_.push_back(pose.position());
    for (std::size_t n = 0; n < path_.size(); ++n)
      lengths_.push_back(n == 0 ? 0.0 : lengths_.back() + (path_[n] - path_[n - 1]).norm());
    for (int i = 0; i < course.robots; ++i) project(i);
  }

  std::size_t end() const { return end_; }
  double offset(int robot, std::size_t t) const { return offsets_[static_cast<std::size_t>(robot)][t]; }
  /// From outline to outline along the leader's path, m.
  double gap(int ahead, int robot, std::size_t t) const {
    const auto along = [&](int r) { return alongs_[static_cast<std::size_t>(r)][t]; };
    return along(ahead) - along(robot) - (course_.length(ahead) + course_.length(robot)) / 2;
  }
  /// Mean of the speed over `over` seconds around t, m/s.
  double speed(int robot, std::size_t t, double over = kSmoothed) const {
    const std::size_t half = std::max<std::size_t>(1, index(over) / 2);
    const std::size_t from = t < half ? 0 : t - half, to = std::min(end_ - 1, t + half);
    const auto& poses = *trails_[static_cast<std::size_t>(robot)];
    double way = 0.0;
    for (std::size_t n = from; n < to; ++n) way += (poses[n + 1].position() - poses[n].position()).norm();
    return way / (kPeriod * static_cast<double>(std::max<std::size_t>(1, to - from)));
  }
  /// The first time from `from` on after which the robot does not move until `until`.
  std::size_t stands_from(int robot, std::size_t from, std::size_t until) const {
    std::size_t t = until;
    while (t > from && speed(robot, t - 1, kPeriod) < kStands) --t;
    return t;
  }

 private:
  void project(int robot) {
    auto& alongs = alongs_.emplace_back();
    auto& offsets = offsets_.emplace_back();
    double last = 0.0;
    for (const Pose2& pose : *trails_[static_cast<std::size_t>(robot)]) {
      double best = std::numeric_limits<double>::infinity(), along = last;
      for (std::size_t n = 0; n + 1 < path_.size(); ++n) {
        if (lengths_[n + 1] < last - 5.0 || lengths_[n] > last + 5.0) continue;
        const Eigen::Vector2d step = path_[n + 1] - path_[n];
        const double part = std::clamp((pose.position() - path_[n]).dot(step) / step.squaredNorm(), 0.0, 1.0);
        const double offset = (path_[n] + part * step - pose.position()).norm();
        if (offset >= best) continue;
        best = offset;
        along = lengths_[n] + part * (lengths_[n + 1] - lengths_[n]);
      }
      if (alongs.empty()) along = along_at_start(robot);
      alongs.push_back(along);
      offsets.push_back(best);
      last = along;
    }
  }
  double along_at_start(int robot) const {
    return (trails_[static_cast<std::size_t>(robot)]->front().position() - path_.front()).norm();
  }

  const ConvoyCourse& course_;
  std::vector<const std::vector<Pose2>*> trails_{};
  std::size_t end_{};
  std::vector<Eigen::Vector2d> path_{};
  std::vector<double> lengths_{};  ///< Of the path up to each of its points, m.
  std::vector<std::vector<double>> alongs_{}, offsets_{};
};

double root_mean_square(double sum, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

ConvoyFigures figures_of(const ConvoyCourse& course, const sim::RunOutcome& outcome) {
  const Run run(course, outcome);
  ConvoyFigures out;
  const auto step = index(seconds(ConvoyCourse::kStep)), let_go = index(seconds(ConvoyCourse::kLetGo)),
             corner = index(seconds(ConvoyCourse::kCorner)), peel = index(seconds(ConvoyCourse::kPeelOff));
  const int last = course.robots - 1;

  double sum = 0.0;
  std::size_t count = 0;
  for (int i = 1; i <= last; ++i)
    for (std::size_t t = let_go - index(kSettled); t < let_go; ++t, ++count)
      sum +=
          std::pow(run.gap(i - 1, i, t) - ConvoyCourse::kGap - ConvoyCourse::kHeadway * run.speed(i, t), 2);
  out.gap_error = root_mean_square(sum, count);

  out.smallest_gap = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= last; ++i)
    for (std::size_t t = 0; t < (course.robots > 2 ? peel : run.end()); ++t)
      out.smallest_gap = std::min(out.smallest_gap, run.gap(i - 1, i, t));

  // The robot that leaves is no follower any more, and those behind it drive around it.
  sum = 0.0;
  count = 0;
  for (int i = 1; i <= last; ++i)
    for (std::size_t t = step; t < (course.robots > 2 ? peel : run.end()); ++t, ++count) {
      sum += std::pow(run.offset(i, t), 2);
      out.largest_cross_track = std::max(out.largest_cross_track, run.offset(i, t));
    }
  out.cross_track = root_mean_square(sum, count);

  const std::size_t leader = run.stands_from(0, let_go, corner),
                    follower = run.stands_from(last, let_go, corner);
  if (follower < corner) out.stop = kPeriod * (static_cast<double>(follower) - static_cast<double>(leader));

  double before = 0.0;
  for (int i = 0; i <= last; ++i) {
    double slow = 0.0, fast = 0.0;
    for (std::size_t t = step - index(5.0); t < step; ++t)
      slow += run.speed(i, t) / static_cast<double>(index(5.0));
    for (std::size_t t = step; t < let_go; ++t) fast = std::max(fast, run.speed(i, t, 2 * kSmoothed));
    if (i > 0) out.amplification = std::max(out.amplification, (fast - slow) / before);
    before = fast - slow;
  }

  if (course.robots > 2)
    for (std::size_t t = peel; t < run.end() && !out.splice; ++t) {
      const double wanted = ConvoyCourse::kGap + ConvoyCourse::kHeadway * run.speed(2, t);
      if (run.gap(0, 2, t) < (1 + kSpliced) * wanted) out.splice = kPeriod * static_cast<double>(t - peel);
    }

  out.contacts = static_cast<int>(outcome.collisions.size());
  out.complaints = outcome.report.complaints();
  return out;
}

}  // namespace adit::bench
