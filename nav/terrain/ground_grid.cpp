// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/ground_grid.hpp"

#include <cmath>
#include <cstdlib>

namespace adit::nav {
namespace {

constexpr float kLongAgo = -1e9f;
constexpr float kFlat = 0.02f;  ///< Unevenness that does not count as slope, m.
/// Deviation of the ground's gradient from the fitted plane: a road's crown, 2.5 % to each side.
constexpr float kBend = 0.05f;
constexpr int kBlindCells = 5;   ///< Over more cells without a measurement the ground cannot be extrapolated.
constexpr int kFallCells = 3;    ///< The same for falling ground: rays pass over lower ground.
constexpr float kNewest = 0.5f;  ///< Weight of a scan in a cell's height.
constexpr float kSame = 0.05f;   ///< Heights that differ by more belong to different surfaces, m.
constexpr std::size_t kEnough = 40;            ///< Minimum number of cells to register a scan to the map.
constexpr float kRecent = 5.0f;                ///< Maximum age of those cells, s.
constexpr float kUnsure = 0.003f;              ///< A smaller difference is noise, also of a tilt at kArm, m.
constexpr float kArm = 2.0f;                   ///< Lever arm for tilts, m.
constexpr float kMaxHeightCorrection = 0.25f;  ///< Maximum height correction per scan, m.
constexpr float kMaxTilt = 0.0524f;            ///< Maximum tilt correction per scan, rad: 3 degrees.
constexpr std::size_t kMaxSamples = 1024;      ///< Maximum number of samples of a fit.
constexpr float kSampleNoise = 0.02f;          ///< Noise of the lowest return of a cell, m.
constexpr float kSigmaHeight = 0.03f;          ///< Uncertainty of the lidar's height above the ground, m.
constexpr float kExplained = 0.6f;             ///< Minimum inlier fraction of an accepted plane.
constexpr float kNearGround = 1.0f;            ///< Margin around the blind ring for the plane's samples, m.
constexpr float kSeenFrom = 1.0f, kSeenTo = 6.0f;  ///< The ring that gives the plane in the first scan, m.

/// The gap of a cell whose neighbour has this gap.
constexpr std::uint8_t after(std::uint8_t gap) {
  return gap >= GroundGrid::kNever - 1 ? gap : static_cast<std::uint8_t>(gap + 1);
}

int half_of(float range) { return static_cast<int>(std::ceil((range + 0.25f) / GroundGrid::kCell)); }

/// Address bits per axis of a torus that holds the window around the robot.
int bits_of(int half) {
  int bits = 7;
  while ((1 << bits) < 2 * half + 1 + 8) ++bits;
  return bits;
}

/// Thins the samples out evenly to at most kMaxSamples.
void thin_out(std::vector<Eigen::Vector3f>& samples) {
  const std::size_t every = (samples.size() + kMaxSamples - 1) / kMaxSamples;
  if (every < 2) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); i += every) samples[count++] = samples[i];
  samples.resize(count);
}

}  // namespace

GroundGrid::GroundGrid(const GroundParams& params)
    : params_(params),
      half_(half_of(params.range)),
      side_(2 * half_ + 1),
      bits_(bits_of(half_)),
      mask_((1 << bits_) - 1),
      memory_half_((1 << bits_) / 2 - 1) {
  const std::size_t places = std::size_t{1} << (2 * bits_);
  const auto cells = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
  low_.assign(places, kNothing);
  high_.assign(places, -kNothing);
  height_.assign(places, 0.0f);
  stamp_.assign(places, kLongAgo);
  is_ground_.assign(places, 0);
  ground_.assign(cells, 0.0f);
  floor_.assign(cells, 0.0f);
  gap_.assign(cells, kNever);
  fresh_.assign(cells, 0);
  samples_.reserve(cells);
  entered_.reserve(places);
  steps_.reserve(cells);
  for (int dx = -half_; dx <= half_; ++dx)
    for (int dy = -half_; dy <= half_; ++dy) {
      if (dx == 0 && dy == 0) continue;
      // One step towards the middle along the longer axis, and one along the diagonal if there is one.
      const int sx = (dx > 0) - (dx < 0), sy = (dy > 0) - (dy < 0);
      const bool along_x = std::abs(dx) >= std::abs(dy), diagonal = std::abs(dx) == std::abs(dy);
      // On the diagonal both neighbours would be the same outer cell, so only the diagonal step counts. On
      // the axes there is no diagonal; the cell beside counts, so that no path depends on single cells.
      int ax = along_x ? dx - sx : dx, ay = along_x ? dy : dy - sy;
      int bx = dx - sx, by = dy - sy;
      if (diagonal) ax = bx, ay = by;
      if (dy == 0 && std::abs(dx) > 1) by = 1;
      if (dx == 0 && std::abs(dy) > 1) bx = 1;
      const auto index = [this](int i, int j) {
        return static_cast<std::uint32_t>((i + half_) * side_ + j + half_);
      };
      const auto byte = [](int v) { return static_cast<std::int8_t>(v); };
      steps_.push_back({index(dx, dy), index(ax, ay), index(bx, by), static_cast<std::int16_t>(dx),
                        static_cast<std::int16_t>(dy), byte(dx - ax), byte(dy - ay), byte(dx - bx),
                        byte(dy - by)});
    }
  const auto ring = [](const Step& s) { return std::max(std::abs(s.dx), std::abs(s.dy)); };
  // A ring depends on the one inside of it alone: its cells are visited in the order of memory.
  std::stable_sort(steps_.begin(), steps_.end(),
                   [&](const Step& a, const Step& b) { return ring(a) < ring(b); });
  for (std::size_t gap = 0; gap < rise_.size(); ++gap) {
    const int cells_away = gap >= kNever ? 0 : static_cast<int>(gap);
    // Up to a few cells the ground may be as steep as the platform permits; beyond, it bends as it usually
    // does.
    const auto by_slope = [&](int most) {
      const int steep = std::min(cells_away, most);
      return kCell *
             (params_.slope * static_cast<float>(steep) + kBend * static_cast<float>(cells_away - steep));
    };
    rise_[gap] = std::min(std::max(params_.rise, kFlat + by_slope(kBlindCells)), params_.most);
    fall_[gap] = std::max(std::min(std::max(params_.rise, kFlat + by_slope(kFallCells)), params_.drop),
                          kFlat + kBend * kCell * static_cast<float>(cells_away));
    climb_[gap] = std::max(by_slope(kBlindCells), params_.slope * kCell);
    limit_[gap] = std::max(params_.drop, fall_[gap]);
  }
}

void GroundGrid::clear() {
  std::fill(stamp_.begin(), stamp_.end(), kLongAgo);
  placed_ = false;
  grown_ = false;
}

void GroundGrid::roll(int x, int y) {
  entered_.clear();
  const int old_x = centre_x_, old_y = centre_y_;
  centre_x_ = x;
  centre_y_ = y;
  if (placed_ && x == old_x && y == old_y) return;
  const bool all = !placed_ || std::abs(x - old_x) > side_ || std::abs(y - old_y) > side_;
  placed_ = true;
  // Calls `each` for the cells of a square around the robot that were not in it before.
  const auto entering = [&](int half, const auto& each) {
    for (int i = x - half; i <= x + half; ++i) {
      const bool new_row = all || std::abs(i - old_x) > half;
      if (!new_row && y == old_y) continue;
      for (int j = y - half; j <= y + half; ++j)
        if (new_row || std::abs(j - old_y) > half) each(slot(i, j));
    }
  };
  // Stairs that the robot climbed are not visible from the landing, and it needs them when it turns round.
  entering(memory_half_, [&](std::size_t s) { stamp_[s] = kLongAgo; });
  entering(half_, [&](std::size_t s) { entered_.push_back(s); });
}

void GroundGrid::begin_scan(float x, float y, float now) {
  now_ = now;
  roll(cell(x), cell(y));
  std::fill(low_.begin(), low_.end(), kNothing);
  std::fill(high_.begin(), high_.end(), -kNothing);
}

GroundGrid::Offset GroundGrid::disagreement() {
  samples_.clear();
  for (int i = -half_; i <= half_; ++i)
    for (int j = -half_; j <= half_; ++j) {
      const std::size_t s = slot(centre_x_ + i, centre_y_ + j);
      // Cells with returns at different heights belong to walls: their lowest return changes with the
      // viewpoint.
      if (low_[s] < kNothing && high_[s] - low_[s] < kSame && is_ground_[s] && now_ - stamp_[s] <= kRecent)
        samples_.emplace_back(kCell * static_cast<float>(i), kCell * static_cast<float>(j),
                              height_[s] - low_[s]);
    }
  if (samples_.size() < kEnough) return {};
  thin_out(samples_);
  // Starts at the median, which is robust against the few cells with other contents.
  const auto middle = samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() / 2);
  std::nth_element(samples_.begin(), middle, samples_.end(),
                   [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a.z() < b.z(); });
  const float median = middle->z();
  for (Eigen::Vector3f& sample : samples_) sample.z() -= median;
  const PlanePrior prior{0.0f, {0, 0}, kMaxHeightCorrection, kMaxTilt / 3};
  PlaneFit fit = fit_plane(samples_, prior, prior.gradient, kSampleNoise, 2 * kSame, kSame / 2);
  if (fit.inliers < kExplained) return {};
  fit.height += median;
  Offset offset;
  offset.sigma_gradient = fit.sigma_gradient;
  if (const float sure = std::fabs(fit.height) - kUnsure; sure > 0)
    offset.height = std::copysign(std::min(sure, kMaxHeightCorrection), fit.height);
  const float tilt = fit.gradient.norm();
  if (const float sure = tilt - kUnsure / kArm; sure > 0)
    offset.gradient = std::min(sure, kMaxTilt) / tilt * fit.gradient;
  return offset;
}

void GroundGrid::fit_ground(const Offset& offset, float z, const Eigen::Vector2f& tilt, float blind) {
  samples_.clear();
  const auto around = [this](float metres) { return std::min(half_, static_cast<int>(metres / kCell)); };
  const auto collect = [&](int reach, int stride, const auto& height_of) {
    for (int i = -reach; i <= reach; i += stride)
      for (int j = -reach; j <= reach; j += stride) {
        const std::size_t s = slot(centre_x_ + i, centre_y_ + j);
        const float dx = kCell * static_cast<float>(i), dy = kCell * static_cast<float>(j);
        if (float height; height_of(s, dx, dy, height)) samples_.emplace_back(dx, dy, height);
      }
  };
  // The height of the ground under the robot is known as exactly as the height of its lidar.
  const PlanePrior prior{z, tilt, kSigmaHeight, params_.sigma_tilt + kBend};
  // Between walls the lidar sees the walls' feet before the floor, and no plane explains most of the returns.
  // Then the body's attitude is the best estimate.
  const auto take = [&](const Eigen::Vector2f& start) {
    plane_ = fit_plane(samples_, prior, start, kSampleNoise, 2 * kSame, kSame / 2);
    if (plane_.inliers < kExplained) plane_ = {z, tilt, prior.sigma_height, params_.sigma_tilt, 0};
  };
  reach_ = std::max(blind + kNearGround, 2 * kNearGround);
  collect(around(reach_), 2, [&](std::size_t s, float, float, float& height) {
    height = height_[s];
    return is_ground_[s] && now_ - stamp_[s] <= params_.memory;
  });
  if (grown_ && samples_.size() >= kEnough / 4) {
    take(plane_.gradient);
    return;
  }
  const float bend2 = 9 * prior.sigma_gradient * prior.sigma_gradient;
  samples_.clear();
  collect(around(std::max(kSeenTo, blind + kNearGround)), 1,
          [&](std::size_t s, float dx, float dy, float& height) {
            // A return higher than ground can be, counted from the body's attitude, belongs to an obstacle.
            height = low_[s] + offset.height + offset.gradient.dot(Eigen::Vector2f(dx, dy));
            const float off = std::fabs(height - z - tilt.x() * dx - tilt.y() * dy), far2 = dx * dx + dy * dy;
            return low_[s] < kNothing && far2 > kSeenFrom * kSeenFrom && off < params_.most &&
                   off * off < bend2 * far2;
          });
  plane_ = {z, tilt, prior.sigma_height, params_.sigma_tilt, 0};
  if (samples_.size() < kEnough) return;
  thin_out(samples_);
  take(search_gradient(samples_, prior, kFlat, 3 * prior.sigma_gradient));
}

float GroundGrid::below_plane(const Eigen::Vector3f& p) const {
  const Eigen::Vector2f way = p.head<2>() - at_;
  return plane_.height + plane_.gradient.dot(way) - p.z() - kBend * std::max(0.0f, way.norm() - reach_);
}

bool GroundGrid::falls_by_slope(const Step& s, float rise, std::uint8_t gap,
                                const Eigen::Vector3f& lidar) const {
  const float dx = static_cast<float>(s.dx) - lidar.x() / kCell,
              dy = static_cast<float>(s.dy) - lidar.y() / kCell;
  const float range = kCell * std::sqrt(dx * dx + dy * dy), high = lidar.z();
  if (range * high < params_.sure * (high - rise))
    return false;  // The ray would have shown an edge at this place.
  const float spacing = (range * range + high * high) / high * params_.rings;
  const float run = std::min(2 * spacing, kCell * static_cast<float>(gap));
  return rise >= -(kFlat + params_.slope * run);
}

void GroundGrid::grow(const Offset& offset, float z, const Eigen::Vector2f& tilt,
                      const Eigen::Vector3f& lidar, float blind) {
  at_ = kCell * Eigen::Vector2f(static_cast<float>(centre_x_), static_cast<float>(centre_y_));
  fit_ground(offset, z, tilt, blind);
  const float steep = plane_.gradient.norm() / params_.slope;
  const Eigen::Vector2f cell_gradient = kCell / std::max(1.0f, steep) * plane_.gradient;
  const float gradient_uncertainty = kBend + plane_.sigma_gradient;
  limit_[kNever] = std::max(params_.drop, kFlat + gradient_uncertainty * blind);
  const auto middle = static_cast<std::size_t>(half_ * side_ + half_);
  ground_[middle] = z;
  floor_[middle] = z;
  gap_[middle] = kNever;
  for (const Step& s : steps_) {
    const std::size_t at = slot(centre_x_ + s.dx, centre_y_ + s.dy);
    const bool seen = low_[at] < kNothing;
    if (seen) {
      const float low = low_[at] + offset.height +
                        kCell * (offset.gradient.x() * static_cast<float>(s.dx) +
                                 offset.gradient.y() * static_cast<float>(s.dy));
      const bool same = now_ - stamp_[at] <= params_.memory && std::fabs(low - height_[at]) < kSame;
      height_[at] = same ? height_[at] + kNewest * (low - height_[at]) : low;
      stamp_[at] = now_;
    }
    const float a = ground_[s.inner_a] + cell_gradient.x() * static_cast<float>(s.from_a_x) +
                    cell_gradient.y() * static_cast<float>(s.from_a_y);
    const float b = ground_[s.inner_b] + cell_gradient.x() * static_cast<float>(s.from_b_x) +
                    cell_gradient.y() * static_cast<float>(s.from_b_y);
    // The cell is ground when it is consistent with either neighbour; the better one is used.
    const bool by_a = std::fabs(height_[at] - a) <= std::fabs(height_[at] - b);
    const std::uint8_t gap = after(gap_[by_a ? s.inner_a : s.inner_b]);
    const float rise = height_[at] - (by_a ? a : b);
    float most = rise_[gap], least = -fall_[gap], climb = climb_[gap];
    if (gap >= kNever) {
      // Over the blind ring the tolerance grows until a first cell is accepted.
      const float grown =
          kFlat + gradient_uncertainty * kCell * static_cast<float>(std::max(std::abs(s.dx), std::abs(s.dy)));
      most = std::min(std::max(most, grown), params_.most);
      least = std::min(least, -grown);
      climb = std::max(climb, grown);
    }
    bool ground = now_ - stamp_[at] <= params_.memory && rise <= most;
    if (ground && rise < least) ground = lidar.z() > 0 && falls_by_slope(s, rise, gap, lidar);
    ground_[s.index] = ground ? height_[at] : 0.5f * (a + b);
    floor_[s.index] = std::min(ground_[s.index], (ground ? height_[at] - rise : std::min(a, b)) + climb);
    gap_[s.index] = ground ? std::uint8_t{0} : after(std::min(gap_[s.inner_a], gap_[s.inner_b]));
    fresh_[s.index] = ground && seen;
    is_ground_[at] = ground;
  }
  grown_ = true;
}

}  // namespace adit::nav
