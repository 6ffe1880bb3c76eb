// SPDX-License-Identifier: Apache-2.0
#include "nav/monitor/near_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::nav {
namespace {

constexpr double kShortestRange = 0.35;  ///< The lidar may see nothing at shorter range, m.
constexpr double kPlaceMemory = 10.0;    ///< Lifetime of a place that newer scans cannot show, s.
constexpr double kRangeNoise = 0.02;     ///< Standard deviation of a return's range, m.
/// Margin at the edge of the fan of rays, where an obstacle may be missed, rise per metre.
constexpr float kEdge = 0.06f;
constexpr float kLevel = 1e-3f;       ///< A smaller rise per metre counts as level.
constexpr float kWithinCell = 0.10f;  ///< Distance over which ground may rise within a 10 cm cell, m.
constexpr float kPast = 0.15f;        ///< A ray must pass a place by this much to show that it is free, m.
constexpr float kLevelRay = 0.1f;     ///< Returns at most this much below the lidar come from level rays, m.
constexpr float kNotSeen = 1e9f;      ///< Lowest return of a cell without returns.
/// Distances before a riser at which its tread is searched, m.
constexpr std::array kBefore{0.1f, 0.15f, 0.2f, 0.25f};
constexpr float kFlat = 0.14f;  ///< A cell with a larger height range holds a vertical face and no tread, m.
/// Noise of the height range of many returns, m.
constexpr float kSpread = 0.04f;
/// A cell with this many times the returns of the one before it shows that those are its noise.
constexpr int kTail = 2;
/// Minimum number of returns in a cell and its neighbours; a single one is noise.
constexpr int kMinReturns = 2;
constexpr double kKink = 0.35;     ///< Maximum change of the ground's gradient where level ground ends.
constexpr double kSteeper = 0.05;  ///< A ramp may get steeper than under the body by this much.
constexpr double kOutside = 0.01;  ///< Nothing this far outside of the circumscribed circle is inside, m.
constexpr double kBelow = 0.1;     ///< A flying robot must be at least this far above an object, m.

/// Limits for obstacles. A flying robot has no ground: everything in the height band of its body is an
/// obstacle.
Traversability near_limits(const Platform& platform) {
  Traversability limits = Traversability::of(platform);
  if (platform.flies()) {
    limits.obstacle = -kBelow;
    limits.slope = 0;
  }
  return limits;
}

}  // namespace

NearPoints::NearPoints(const Platform& platform, double reach)
    : platform_(platform),
      limits_(near_limits(platform)),
      body_(platform),
      reach_(static_cast<float>(std::min(reach, kCell * kSide / 2.0 - 2 * kCell))),
      lowest_(kCoarse * kCoarse),
      upper_(kCoarse * kCoarse),
      highest_(kSide * kSide),
      cells_(kSide * kSide) {
  used_.reserve(cells_.size());
  places_.reserve(kMax);
  remembered_.reserve(kMax);
}

bool NearPoints::seen_again(const Eigen::Vector2f& local) const {
  if (std::fabs(local.x()) >= reach_ || std::fabs(local.y()) >= reach_) return false;
  const auto step = static_cast<float>(limits_.obstacle);
  const std::size_t middle = fine(local.x(), local.y());
  int obstacle = 0;
  bool raised = false;
  for (int k = -1; k <= 1; ++k)
    for (const std::size_t i : {middle - kSide + k, middle + k, middle + kSide + k}) {
      raised |= highest_[i] > step;
      obstacle += cells_[i].count;
    }
  // A return that the newest scan shows to be an obstacle by itself counts alone.
  return raised && obstacle < kMinReturns;
}

bool NearPoints::tread_leads_to(const Eigen::Vector3f& p, float range, float highest, float rise) const {
  for (const float before : kBefore) {
    if (range <= before) return false;
    const float nearer = 1.0f - before / range;
    const std::size_t cell = coarse(nearer * p.x(), nearer * p.y());
    const float tread = lowest_[cell];
    if (tread <= highest && p.z() <= tread + rise && upper_[cell] <= tread + kFlat) return true;
  }
  return false;
}

NearPoints::Tilt NearPoints::tilt_of(const Pose3& body) const {
  Tilt tilt;
  const Eigen::Quaterniond heading(Eigen::AngleAxisd(body.yaw(), Eigen::Vector3d::UnitZ()));
  tilt.R_level_base = (heading.conjugate() * body.orientation).toRotationMatrix().cast<float>();
  const Eigen::Vector3f up = tilt.R_level_base.col(2);
  const auto steepest = static_cast<float>(limits_.slope);
  if (!platform_.flies() && up.z() > 0.2f) {
    tilt.rise = -up.head<2>() / up.z();
    // Steeper tilts are those of the body and not of the ground.
    if (tilt.rise.norm() > steepest) tilt.rise *= steepest / tilt.rise.norm();
  }
  tilt.slope = std::min(steepest,
                        std::max(static_cast<float>(kKink), tilt.rise.norm() + static_cast<float>(kSteeper)));
  return tilt;
}

NearPoints::Fan NearPoints::fan_of(const ScanPoints& scan) const {
  Fan fan{};
  fan.lidar = scan.origin(platform_.lidar_origin());
  const Eigen::Vector3f from = fan.lidar.cast<float>();
  const auto points = scan.first();
  // Four rays at a time. Comparisons that a value which is not a number makes false leave the limits alone.
  using Lanes = float __attribute__((vector_size(16)));
  constexpr std::size_t kLanes = 4;
  Lanes lowest = Lanes{} + fan.lowest, highest = Lanes{} + fan.highest;
  for (std::size_t n = 0; n < points.size(); n += kLanes) {
    Lanes x, y, z;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // The last ray fills up its group.
      const Eigen::Vector3f& p = points[std::min(n + lane, points.size() - 1)];
      x[lane] = p.x() - from.x();
      y[lane] = p.y() - from.y();
      z[lane] = p.z() - from.z();
    }
    // The rays belong to the lidar, which tilts with the body.
    Lanes range = x * x + y * y;
    for (std::size_t lane = 0; lane < kLanes; ++lane) range[lane] = std::sqrt(range[lane]);
    const Lanes rise = z / range;
    const auto far = range > 0.1f;
    lowest = far & (rise < lowest) ? rise : lowest;
    highest = far & (rise > highest) ? rise : highest;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    fan.lowest = std::min(fan.lowest, lowest[lane]);
    fan.highest = std::max(fan.highest, highest[lane]);
  }
  return fan;
}

void NearPoints::sort_in(const ScanPoints& scan, const Tilt& tilt) {
  const auto top = static_cast<float>(limits_.headroom);
  const Eigen::Matrix3f& R = tilt.R_level_base;
  // Of the lowest lidar, above base_link.
  float lidar = std::numeric_limits<float>::infinity();
  scan.each_part(platform_.lidar_origin(), [&](auto, const Eigen::Vector3d& origin) {
    lidar = std::min(lidar, R.row(2).dot(origin.cast<float>()));
  });
  const auto step = static_cast<float>(limits_.obstacle);
  const float slope = tilt.slope;
  const auto stairs = static_cast<float>(limits_.slope);
  // Within a cell stairs rise by one step, and a higher face is a wall. Excess below the noise is left to the
  // planner.
  const float within = platform_.stairs ? kSpread : slope * kWithinCell;
  /// Height of the plane under the body above the level plane.
  const auto plane_height = [&tilt](const Eigen::Vector3f& p) {
    return tilt.rise.x() * p.x() + tilt.rise.y() * p.y();
  };
  const auto inside = [this](const Eigen::Vector3f& p) {
    return std::fabs(p.x()) < reach_ && std::fabs(p.y()) < reach_ && std::isfinite(p.z());
  };
  std::fill(lowest_.begin(), lowest_.end(), kNotSeen);
  std::fill(upper_.begin(), upper_.end(), -kNotSeen);
  std::fill(highest_.begin(), highest_.end(), -1e9f);
  if (raised_.size() < scan.all().size()) raised_.resize(scan.all().size());
  std::size_t raised_count = 0;
  for (const Eigen::Vector3f& raw : scan.all()) {
    // R * raw, in the order of Eigen, which does not inline it here.
    const auto level = [&](int row) {
      return R(row, 0) * raw.x() + (R(row, 1) * raw.y() + R(row, 2) * raw.z());
    };
    const Eigen::Vector3f p(level(0), level(1), level(2));
    if (!inside(p)) continue;
    const std::size_t cell = coarse(p.x(), p.y());
    lowest_[cell] = std::min(lowest_[cell], p.z());
    if (p.z() > top) continue;
    upper_[cell] = std::max(upper_[cell], p.z());
    const float below = std::min(0.0f, plane_height(p));
    // Without a branch, which would be mispredicted often.
    raised_[raised_count] = {p, raw.x(), raw.y(), below};
    raised_count += p.z() - below <= step ? 0 : 1;
  }
  for (const std::uint32_t i : used_) cells_[i] = {};
  used_.clear();
  const auto body2 = static_cast<float>(std::pow(body_.radius() + kOutside, 2));
  for (const Raised& raised : std::span(raised_).first(raised_count)) {
    const Eigen::Vector3f& p = raised.at;
    const float range = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const bool led_to = platform_.stairs && tread_leads_to(p, range, step + stairs * range, step + within);
    // A wall as seen from below is a riser when the tread before it is visible.
    const auto index = static_cast<std::uint32_t>(fine(p.x(), p.y()));
    if (!led_to) highest_[index] = std::max(highest_[index], p.z() - raised.below);
    const float from_body2 = raised.x * raised.x + raised.y * raised.y;
    if (from_body2 < body2 && body_.depth(raised.x, raised.y) > 0.0f) continue;
    // Most returns of walls are far above the lowest one of their cell.
    if (p.z() <= lowest_[coarse(p.x(), p.y())] + step + within) {
      const float depth = body_.depth(p.x(), p.y());
      // A robot that climbs stairs has its centre on them, and they rise from there. A return as high as the
      // lidar comes from a level ray: there need be no ground below it, unless the tread before it is
      // visible.
      const bool riser = platform_.stairs && (p.z() < lidar - kLevelRay || led_to);
      // On a ramp the ground follows the body's plane up to the edge of the footprint and continues from
      // there.
      const float edge =
          std::max(0.0f, plane_height(p) * (1 + std::min(0.0f, depth) / std::max(range, 0.1f)));
      const float ground = edge + (riser ? step + stairs * range : step - slope * depth);
      if (p.z() <= ground) continue;
    }
    Cell& cell = cells_[index];
    if (cell.count == 0) used_.push_back(index);
    if (cell.count == 60000) continue;
    cell.x += p.x();
    cell.y += p.y();
    cell.z = std::max(cell.z, p.z());
    ++cell.count;
  }
}

bool NearPoints::hidden(const Eigen::Vector3d& local, const Fan& fan) const {
  if (static_cast<float>(std::hypot(local.x(), local.y())) > reach_) return false;
  const Eigen::Vector3d ray = local - fan.lidar;
  const auto range = static_cast<float>(std::hypot(ray.x(), ray.y()));
  if (range < static_cast<float>(kShortestRange)) return true;
  const float rise = static_cast<float>(ray.z()) / range;
  const float edge = kEdge * (fan.highest - fan.lowest) - kLevel;
  return rise < fan.lowest + edge || rise > fan.highest - edge;
}

bool NearPoints::seen_past(const Eigen::Vector3d& local, const Pose3& body, const Fan& fan,
                           const UprightRangeImage& seen) const {
  const Eigen::Vector3f d = (body.orientation * (local - fan.lidar)).cast<float>();
  return seen.saw_past(Ray::to(d.x(), d.y(), d.z()), kPast);
}

void NearPoints::remember(const Pose3& body, const Tilt& tilt, const Fan& fan, double stamp_s,
                          const UprightRangeImage& seen) {
  remembered_.clear();
  const PlanarTransform back(body.planar().inverse());
  for (Place& place : places_) {
    if (stamp_s - place.seen > kPlaceMemory) continue;
    const Eigen::Vector2d at = back * Eigen::Vector2d(place.x, place.y);
    const bool again = seen_again(at.cast<float>());
    if (again) place.seen = stamp_s;
    const Eigen::Vector3d level(at.x(), at.y(), place.z - body.position.z());
    const Eigen::Vector3d local = tilt.R_level_base.cast<double>().transpose() * level;
    // An obstacle nearer than the lidar's minimum range would block the rays that went past.
    if (again || (hidden(local, fan) && !seen_past(local, body, fan, seen))) remembered_.push_back(place);
  }
}

void NearPoints::take(const ScanPoints& scan, const Pose3& body, double stamp_s,
                      const UprightRangeImage& seen) {
  const Tilt tilt = tilt_of(body);
  const Fan fan = fan_of(scan);
  sort_in(scan, tilt);
  remember(body, tilt, fan, stamp_s, seen);
  std::swap(places_, remembered_);
  // Nearest first, in case there are more than the maximum.
  const auto rank = [this](std::uint32_t i) {
    return std::pair{cells_[i].x * cells_[i].x + cells_[i].y * cells_[i].y, i};
  };
  for (const std::uint32_t i : used_) {
    cells_[i].x /= static_cast<float>(cells_[i].count);
    cells_[i].y /= static_cast<float>(cells_[i].count);
  }
  // The mean of a cell's returns. Where a cell beyond it along the rays, within the noise of a range, has
  // many more, these few are noise of the same surface, and the mean of both counts. Of few returns that is
  // not known.
  const auto surface = [this](std::uint32_t i) -> Eigen::Vector2f {
    const Cell& cell = cells_[i];
    const Eigen::Vector2f at(cell.x, cell.y);
    const Cell* most = nullptr;
    visit_around(i, [&](const Cell& other) {
      if (other.count < kTail * cell.count) return;
      const float beyond = (Eigen::Vector2f(other.x, other.y) - at).dot(at.normalized());
      const bool noise = beyond > 0 && beyond < 3 * static_cast<float>(kRangeNoise);
      if (noise && (!most || other.count > most->count)) most = &other;
    });
    if (!most) return at;
    const float own = static_cast<float>(cell.count) / static_cast<float>(cell.count + most->count);
    return own * at + (1 - own) * Eigen::Vector2f(most->x, most->y);
  };
  const PlanarTransform to_odom(body.planar());
  const std::size_t room = kMax - places_.size();
  if (used_.size() > room) std::ranges::sort(used_, {}, rank);
  for (const std::uint32_t i : used_) {
    if (places_.size() == kMax) break;
    int around = 0;
    visit_around(i, [&around](const Cell& cell) { around += cell.count; });
    if (around < kMinReturns) continue;
    const double uncertainty =
        std::min(kMaxUncertainty, 3 * kRangeNoise / std::sqrt(static_cast<double>(around)));
    const bool certain = uncertainty < kRangeNoise / 2;
    const Eigen::Vector2f place = certain ? surface(i) : Eigen::Vector2f(cells_[i].x, cells_[i].y);
    const Eigen::Vector2d at = to_odom * place.cast<double>();
    places_.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                       cells_[i].z + static_cast<float>(body.position.z()), static_cast<float>(uncertainty),
                       stamp_s});
  }
}

}  // namespace adit::nav
