#include "nav/ground_map.hpp"

#include <cmath>
#include <cstdlib>

namespace adit::nav {

GroundMap::GroundMap(const GroundMapParams& params)
    : params_(params), cells_(kTorus * kTorus), ground_(kSide * kSide, 0.0f) {
  for (int dx = -kHalf; dx <= kHalf; ++dx)
    for (int dy = -kHalf; dy <= kHalf; ++dy) {
      if (dx == 0 && dy == 0) continue;
      // One step towards the middle along the longer axis, and diagonally where there is a diagonal.
      const int sx = (dx > 0) - (dx < 0), sy = (dy > 0) - (dy < 0);
      const bool along_x = std::abs(dx) >= std::abs(dy);
      const auto index = [](int i, int j) { return (i + kHalf) * kSide + j + kHalf; };
      steps_.push_back({index(dx, dy), dx, dy, along_x ? index(dx - sx, dy) : index(dx, dy - sy),
                        index(dx - sx, dy - sy)});
    }
  const auto ring = [](const Step& s) { return std::max(std::abs(s.dx), std::abs(s.dy)); };
  const auto off_axis = [](const Step& s) { return std::min(std::abs(s.dx), std::abs(s.dy)); };
  std::stable_sort(steps_.begin(), steps_.end(), [&](const Step& a, const Step& b) {
    return ring(a) != ring(b) ? ring(a) < ring(b) : off_axis(a) < off_axis(b);
  });
  // On the diagonal itself both neighbours would be the same outer one: the diagonal step alone counts.
  for (Step& s : steps_)
    if (std::abs(s.dx) == std::abs(s.dy)) s.inner_a = s.inner_b;
}

void GroundMap::begin_scan(double stamp_s) {
  ++scan_;
  stamp_ = stamp_s;
}

void GroundMap::grow(double x, double y, double z) {
  centre_x_ = cell(static_cast<float>(x));
  centre_y_ = cell(static_cast<float>(y));
  ground_[kHalf * kSide + kHalf] = static_cast<float>(z);
  const auto allowed = static_cast<float>(std::min(params_.tolerance, params_.slope * kCell + 0.02));
  for (const Step& s : steps_) {
    const float base = 0.5f * (ground_[s.inner_a] + ground_[s.inner_b]);
    const int ix = centre_x_ + s.dx, iy = centre_y_ + s.dy;
    const Cell& c = cells_[slot(ix, iy)];
    const bool known = c.ix == ix && c.iy == iy && stamp_ - c.stamp <= params_.memory;
    ground_[s.index] = known && std::fabs(c.lowest - base) <= allowed ? c.lowest : base;
  }
}

}  // namespace adit::nav
