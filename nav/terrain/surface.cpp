// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/surface.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr float kCell = GroundGrid::kCell;
constexpr float kMinCells = 8;  ///< Minimum number of measured cells of a plane.
/// Minimum variance of their positions in the direction of less spread, m2.
constexpr float kSpread = 0.006f;
constexpr float kCertain = 18;  ///< Minimum number of cells of a plane that is too steep.
constexpr float kCertainSpread = 0.02f;
constexpr float kMinCost = 0.1f;  ///< Lower costs are ignored.
/// Factor on the maximum slope above which ground is certainly too steep.
constexpr float kOverSlope = 1.08f;
constexpr float kMaxCost = 0.9f;  ///< Maximum cost of passable ground.

}  // namespace

Surface::Surface(const SurfaceParams& params, int side) : params_(params), side_(side) {
  const auto along = static_cast<std::size_t>(side), cells = along * along;
  weight_.assign(cells, 0.0f);
  followed_.assign(cells, 0);
  places_.reserve(cells * 5 / 4);
  for (auto* sum : {&sums_.n, &sums_.x, &sums_.xx, &sums_.z, &sums_.xz, &sums_.zz}) sum->assign(along, 0.0f);
}

float Surface::cost(float share) const {
  if (share <= params_.easy) return 0.0f;
  return std::min(kMaxCost,
                  kMinCost + (params_.hard - kMinCost) * (share - params_.easy) / (1 - params_.easy));
}

void Surface::work_out(const GroundGrid& ground, std::span<const std::uint8_t> solid) {
  places_.clear();
  std::fill(followed_.begin(), followed_.end(), 0);
  const std::uint8_t* gaps = ground.gaps();
  for (std::size_t k = 0; k < weight_.size(); ++k) weight_[k] = gaps[k] == 0 && solid[k] == 0 ? 1.0f : 0.0f;
  for (int i = kReach; i < side_ - kReach; i += 2) {
    add_rows(ground, i);
    for (int j = kReach; j < side_ - kReach; j += 2) judge(ground, i, j);
  }
}

void Surface::add_rows(const GroundGrid& ground, int i) {
  for (auto* sum : {&sums_.n, &sums_.x, &sums_.xx, &sums_.z, &sums_.xz, &sums_.zz})
    std::fill(sum->begin(), sum->end(), 0.0f);
  float *n = sums_.n.data(), *sx = sums_.x.data(), *sxx = sums_.xx.data(), *sz = sums_.z.data(),
        *sxz = sums_.xz.data(), *szz = sums_.zz.data();
  // Heights relative to the one under the robot keep the squares small.
  const float level = ground.height(static_cast<int>(ground.cells() / 2));
  for (int di = -kReach; di <= kReach; ++di) {
    const float x = static_cast<float>(di) * kCell;
    const float* w = &weight_[(i + di) * side_];
    const float* h = ground.heights() + (i + di) * side_;
    for (std::size_t j = 0; j < static_cast<std::size_t>(side_); ++j) {
      const float wx = w[j] * x, z = h[j] - level, wz = w[j] * z;
      n[j] += w[j];
      sx[j] += wx;
      sxx[j] += wx * x;
      sz[j] += wz;
      sxz[j] += wx * z;
      szz[j] += wz * z;
    }
  }
}

Surface::Step Surface::step_at(const GroundGrid& ground, int middle, float gx, float gy) const {
  constexpr float kRun = 2 * kCell, kShare = 1 - kRun * 1.5f / ((2 * kReach + 1) * kCell);
  Step step;
  const auto edge = [&](int before, int after, float gradient) {
    if (weight_[before] == 0 || weight_[after] == 0) return;
    const float rise = ground.height(after) - ground.height(before);
    const float height = std::min(std::fabs(rise - kRun * gradient) / kShare, std::fabs(rise));
    if (height > step.height) step = {height, rise > 0 ? after : before};
  };
  edge(middle - side_, middle + side_, gx);
  edge(middle - 1, middle + 1, gy);
  return step;
}

void Surface::follow_step(const GroundGrid& ground, int i, int j, float gx, float gy) {
  const auto add = [&](int cell) {
    std::uint8_t& followed = followed_[cell];
    if (!followed) places_.push_back({static_cast<std::uint32_t>(cell), CellClass::step, 1.0f});
    followed = 1;
  };
  for (int a = i - 1; a <= i + 1; ++a)
    for (int b = j - 1; b <= j + 1; ++b) {
      const int cell = a * side_ + b;
      const Step step = step_at(ground, cell, gx, gy);
      if (step.height <= params_.blocking_step) continue;
      add(cell);
      // A robot above the step touches nothing in the upper cell: the step begins where the ground ends.
      const bool high =
          weight_[cell] != 0 && ground.height(step.above) - ground.height(cell) < step.height / 2;
      if (!high) add(step.above);
    }
}

void Surface::judge(const GroundGrid& ground, int i, int j) {
  float n = 0, x = 0, xx = 0, z = 0, xz = 0, zz = 0, y = 0, yy = 0, xy = 0, yz = 0;
  for (int dj = -kReach; dj <= kReach; ++dj) {
    const auto k = static_cast<std::size_t>(j + dj);
    const float at = static_cast<float>(dj) * kCell;
    n += sums_.n[k];
    x += sums_.x[k];
    xx += sums_.xx[k];
    z += sums_.z[k];
    xz += sums_.xz[k];
    zz += sums_.zz[k];
    y += at * sums_.n[k];
    yy += at * at * sums_.n[k];
    xy += at * sums_.x[k];
    yz += at * sums_.z[k];
  }
  if (n < kMinCells) return;
  const float sxx = xx - x * x / n, syy = yy - y * y / n, sxy = xy - x * y / n;
  const float sxz = xz - x * z / n, syz = yz - y * z / n, szz = zz - z * z / n;
  const float det = sxx * syy - sxy * sxy;
  if (!(det > kSpread * n * (sxx + syy))) return;
  const float gx = (sxz * syy - syz * sxy) / det, gy = (syz * sxx - sxz * sxy) / det;
  const float slope = std::sqrt(gx * gx + gy * gy) / params_.slope;
  const float rms = std::sqrt(std::max(0.0f, szz - gx * sxz - gy * syz) / n);

  const int middle = i * side_ + j;
  const float step = step_at(ground, middle, gx, gy).height;
  if (step > params_.blocking_step) follow_step(ground, i, j, gx, gy);
  const bool certain = n >= kCertain && det > kCertainSpread * n * (sxx + syy);
  Place place{static_cast<std::uint32_t>(middle), CellClass::slope,
              certain && slope > kOverSlope ? 1.0f : cost(slope)};
  // Handled by follow_step().
  const float step_cost = step > params_.blocking_step ? 0.0f : cost(step / params_.step);
  const float uneven = std::max(step_cost, cost(rms / (params_.rough * params_.step)));
  if (uneven > place.cost) place = {place.index, CellClass::step, uneven};
  if (place.cost >= kMinCost) places_.push_back(place);
}

}  // namespace adit::nav
