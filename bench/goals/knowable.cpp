// SPDX-License-Identifier: Apache-2.0
#include "bench/goals/knowable.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace adit::bench {
namespace {

constexpr double kKnowableCell = 0.1;  // m
constexpr double kFreeBeside = 14.0;   // m of free ground around start and goal
constexpr double kSight = 20.0;        // m
constexpr int kRays = 720;             // of a turn
constexpr std::size_t kEvery = 5;      // poses from one look to the next

/// What was seen to stand, grown by the disc's radius.
class Seen {
 public:
  Seen(const Course& course, double pass)
      : origin_(course.start.cwiseMin(course.goal) - Eigen::Vector2d(kFreeBeside, kFreeBeside)),
        pass_(static_cast<int>(std::ceil(pass / kKnowableCell))),
        pass2_(pass * pass / (kKnowableCell * kKnowableCell)) {
    const Eigen::Vector2d size =
        course.start.cwiseMax(course.goal) + Eigen::Vector2d(kFreeBeside, kFreeBeside) - origin_;
    nx_ = static_cast<int>(size.x() / kKnowableCell);
    ny_ = static_cast<int>(size.y() / kKnowableCell);
    stands_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), false);
    closed_ = stands_;
  }

  void look(const sim::StandingMap& map, const Eigen::Vector2d& from) {
    for (int k = 0; k < kRays; ++k) {
      const Eigen::Vector2d way(std::cos(2 * M_PI * k / kRays), std::sin(2 * M_PI * k / kRays));
      for (double r = 0; r < kSight; r += kKnowableCell / 2) {
        const Eigen::Vector2d p = from + r * way;
        if (!map.blocked(p.x(), p.y())) continue;
        stand(column(p.x() - origin_.x()), column(p.y() - origin_.y()));
        break;
      }
    }
  }

  bool keeps_apart(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    std::vector<bool> been(closed_.size(), false);
    const std::pair start{column(from.x() - origin_.x()), column(from.y() - origin_.y())};
    std::vector<std::pair<int, int>> open{start};
    const std::pair goal{column(to.x() - origin_.x()), column(to.y() - origin_.y())};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (i < 0 || j < 0 || i >= nx_ || j >= ny_) return false;  // outside of what was mapped
      // A robot that passes something as near as it can is let out.
      const bool here = std::hypot(i - start.first, j - start.second) <= pass_ + 1;
      if (been[index(i, j)] || (closed_[index(i, j)] && !here) || stands_[index(i, j)]) continue;
      been[index(i, j)] = true;
      if (std::pair{i, j} == goal) return false;
      for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) open.push_back({i + a, j + b});
    }
    return true;
  }

 private:
  static int column(double v) { return static_cast<int>(std::floor(v / kKnowableCell)); }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  }
  void stand(int i, int j) {
    if (i < 0 || j < 0 || i >= nx_ || j >= ny_ || stands_[index(i, j)]) return;
    stands_[index(i, j)] = true;
    for (int b = std::max(0, j - pass_); b <= std::min(ny_ - 1, j + pass_); ++b)
      for (int a = std::max(0, i - pass_); a <= std::min(nx_ - 1, i + pass_); ++a)
        if ((a - i) * (a - i) + (b - j) * (b - j) < pass2_) closed_[index(a, b)] = true;
  }

  Eigen::Vector2d origin_;
  int pass_, nx_{}, ny_{};
  double pass2_;
  std::vector<bool> stands_{}, closed_{};
};

}  // namespace

std::optional<std::size_t> knowable_at(const Course& course, const sim::StandingMap& map, double pass,
                                       std::span<const Pose2> poses) {
  Seen seen(course, pass);
  for (std::size_t i = 0; i < poses.size(); i += kEvery) {
    seen.look(map, poses[i].position());
    if (seen.keeps_apart(poses[i].position(), course.goal)) return i;
  }
  return std::nullopt;
}

}  // namespace adit::bench
