// SPDX-License-Identifier: Apache-2.0
#include "sim/world/distance_transform.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

constexpr double kUnreached = 1e18;

/// Replaces `f` by the lower envelope of the parabolas that stand on its values.
class Line {
 public:
  explicit Line(int longest) : vertex_(longest), border_(longest + 1), out_(longest) {}

  void transform(double* f, int length, int stride) {
    const auto at = [&](int n) -> double& { return f[static_cast<std::size_t>(n) * stride]; };
    int last = -1;
    for (int q = 0; q < length; ++q) {
      if (at(q) >= kUnreached) continue;
      double from = -kUnreached;
      while (last >= 0) {
        const double v = vertex_[last];
        from = ((at(q) + static_cast<double>(q) * q) - (at(vertex_[last]) + v * v)) / (2.0 * (q - v));
        if (from > border_[last]) break;
        from = -kUnreached;
        --last;
      }
      vertex_[++last] = q;
      border_[last] = from;
    }
    if (last < 0) return;
    for (int q = 0, k = 0; q < length; ++q) {
      while (k < last && border_[k + 1] < q) ++k;
      const double d = q - vertex_[k];
      out_[q] = d * d + at(vertex_[k]);
    }
    for (int q = 0; q < length; ++q) at(q) = out_[q];
  }

 private:
  std::vector<int> vertex_;
  std::vector<double> border_;
  std::vector<double> out_;
};

}  // namespace

std::vector<float> distance_transform(const std::vector<std::uint8_t>& targets, int width, int height) {
  std::vector<double> squares(targets.size());
  for (std::size_t n = 0; n < targets.size(); ++n) squares[n] = targets[n] ? 0.0 : kUnreached;
  Line line(std::max(width, height));
  for (int i = 0; i < width; ++i) line.transform(squares.data() + i, height, width);
  for (int j = 0; j < height; ++j)
    line.transform(squares.data() + static_cast<std::size_t>(j) * width, width, 1);
  std::vector<float> distances(targets.size());
  for (std::size_t n = 0; n < targets.size(); ++n) distances[n] = static_cast<float>(std::sqrt(squares[n]));
  return distances;
}

}  // namespace adit::sim
