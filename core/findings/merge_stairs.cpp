// SPDX-License-Identifier: Apache-2.0
#include "core/findings/merge_stairs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace adit::findings {
namespace {

constexpr double kConfidence = 2.58;    // Standard deviations, of 99 %.
constexpr double kMaxTurn = M_PI / 12;  // Between two headings, rad.
constexpr double kLeastLanding = 0.6;   // Length of a landing between two flights, m.
constexpr double kHalfHeadroom = 1.0;   // Half of the least height between two flights, m.
constexpr double kRiseSlack = 0.03;     // m
constexpr double kRunSlack = 0.06;      // m
constexpr double kLeastSigma = 1e-3;    // m or rad: no report outweighs all others.

/// The axis of a flight.
struct Axis {
  explicit Axis(const Staircase& s)
      : stairs(&s),
        direction(s.direction()),
        middle((s.foot + s.top()) / 2),
        length((s.steps - 1) * s.run),
        height((s.steps - 1) * s.rise) {}
  const Staircase* stairs;
  Eigen::Vector2d direction;
  Eigen::Vector3d middle;
  double length, height;  // m, between the lowest and the highest riser
};

bool is_same_flight(const Axis& a, const Axis& b) {
  static const double least_cosine = std::cos(kMaxTurn);
  const Staircase &p = *a.stairs, &q = *b.stairs;
  if (a.direction.dot(b.direction) < least_cosine) return false;
  const Eigen::Vector3d between = b.middle - a.middle;
  const Eigen::Vector2d ahead = (a.direction + b.direction).normalized();
  const double along = between.head<2>().dot(ahead);
  const double aside = between.y() * ahead.x() - between.x() * ahead.y();
  const double run = std::max(p.run, q.run), rise = std::max(p.rise, q.rise);
  const double place = kConfidence * std::hypot(p.sigma.place, q.sigma.place);
  const auto agree = [](double one, double other, double slack, double sigma_one, double sigma_other) {
    return std::abs(one - other) <= std::max(slack, kConfidence * std::hypot(sigma_one, sigma_other));
  };
  // Flights in one place whose lines of climbing differ by the headroom are above one another.
  const double off_line = between.z() - along * (p.rise + q.rise) / (p.run + q.run);
  return std::abs(aside) < std::min(p.width, q.width) / 2 &&
         std::abs(along) - (a.length + b.length) / 2 <= std::min(run + place, kLeastLanding) &&
         std::abs(between.z()) - (a.height + b.height) / 2 <= std::min(rise + place, kHalfHeadroom) &&
         std::abs(off_line) <= std::min(rise + place, kHalfHeadroom) &&
         agree(p.rise, q.rise, kRiseSlack, p.sigma.rise, q.sigma.rise) &&
         agree(p.run, q.run, kRunSlack, p.sigma.run, q.sigma.run);
}

/// A mean weighted by information, the inverse of the variance.
class WeightedMean {
 public:
  void add(double value, double sigma) {
    const double weight = 1 / std::pow(std::max(sigma, kLeastSigma), 2);
    sum_ += weight * value;
    weight_ += weight;
  }
  double value() const { return sum_ / weight_; }
  double sigma() const { return 1 / std::sqrt(weight_); }

 private:
  double sum_{}, weight_{};
};

/// The report with the most steps, of several the one with the best place, of several the first.
const Staircase& longest(std::span<const SeenStairs> seen) {
  return std::min_element(seen.begin(), seen.end(),
                          [](const SeenStairs& a, const SeenStairs& b) {
                            if (a.stairs.steps != b.stairs.steps) return a.stairs.steps > b.stairs.steps;
                            return a.stairs.sigma.place < b.stairs.sigma.place;
                          })
      ->stairs;
}

/// Number of the step of `reference` that is the lowest one of `s`; negative below its foot. Reports with the
/// same count of steps have seen the same ones where their places allow it.
int first_step(const Staircase& s, const Staircase& reference, const Eigen::Vector3d& step) {
  const double steps = (s.foot - reference.foot).dot(step) / step.squaredNorm();
  const double place = kConfidence * std::hypot(s.sigma.place, reference.sigma.place) / step.norm();
  if (s.steps == reference.steps && std::abs(steps) <= place) return 0;
  return static_cast<int>(std::lround(steps));
}

}  // namespace

bool is_same_flight(const Staircase& a, const Staircase& b) { return is_same_flight(Axis(a), Axis(b)); }

Staircase combined(std::span<const SeenStairs> seen) {
  if (seen.size() == 1) return seen.front().stairs;
  const Staircase& reference = longest(seen);
  WeightedMean heading, rise, run, width;
  for (const auto& [key, s] : seen) {
    heading.add(std::remainder(s.heading - reference.heading, 2 * M_PI), s.sigma.heading);
    rise.add(s.rise, s.sigma.rise);
    run.add(s.run, s.sigma.run);
    width.add(s.width, s.sigma.width);
  }
  Staircase out;
  out.heading = std::remainder(reference.heading + heading.value(), 2 * M_PI);
  // A mean of values at a bound may round beyond it.
  out.rise = std::clamp(rise.value(), Staircase::kLeastRise, Staircase::kMostRise);
  out.run = std::clamp(run.value(), Staircase::kLeastRun, Staircase::kMostRun);
  out.width = std::clamp(width.value(), Staircase::kLeastWidth, Staircase::kMostWidth);
  const Eigen::Vector2d ahead = out.run * out.direction();
  const Eigen::Vector3d step(ahead.x(), ahead.y(), out.rise);
  std::vector<int> firsts;
  int lowest = 0, end = reference.steps;
  for (const auto& [key, s] : seen) {
    const int first = first_step(s, reference, step);
    firsts.push_back(first);
    lowest = std::min(lowest, first);
    end = std::max(end, first + s.steps);
  }
  out.steps = std::min(end - lowest, Staircase::kMostSteps);
  std::array<WeightedMean, 3> foot;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Staircase& s = seen[i].stairs;
    const int below = firsts[i] - lowest;  // Steps between its foot and that of all.
    const double sigma =
        std::hypot(s.sigma.place, below * s.sigma.run, below * step.norm() * s.sigma.heading);
    for (int axis = 0; axis < 3; ++axis)
      foot[static_cast<std::size_t>(axis)].add(s.foot[axis] - below * step[axis], sigma);
  }
  out.foot = {foot[0].value(), foot[1].value(), foot[2].value()};
  out.sigma = {.place = foot[0].sigma(),
               .heading = heading.sigma(),
               .rise = rise.sigma(),
               .run = run.sigma(),
               .width = width.sigma()};
  return out;
}

std::vector<MergedStairs> merge_stairs(std::vector<SeenStairs> seen) {
  std::sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  std::vector<Axis> axes;
  for (const SeenStairs& one : seen) axes.emplace_back(one.stairs);
  // The groups: each report names an earlier one of its group, the first one itself.
  std::vector<std::size_t> earlier(seen.size());
  std::iota(earlier.begin(), earlier.end(), std::size_t{0});
  const auto group_of = [&](std::size_t i) {
    while (earlier[i] != i) i = earlier[i] = earlier[earlier[i]];
    return i;
  };
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const std::size_t a = group_of(k), b = group_of(i);
      if (a != b && is_same_flight(axes[k], axes[i])) earlier[std::max(a, b)] = std::min(a, b);
    }
  std::vector<MergedStairs> out;
  std::vector<std::size_t> place(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::size_t first = group_of(i);
    if (first == i) {
      place[i] = out.size();
      out.emplace_back();
    }
    out[place[first]].seen.push_back(std::move(seen[i]));
  }
  for (MergedStairs& stairs : out) stairs.stairs = combined(stairs.seen);
  return out;
}

}  // namespace adit::findings
