// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/terrain_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "nav/geometry/stairs_geometry.hpp"

namespace adit::nav {
namespace {

constexpr std::size_t kUsualReturns = 32768;  ///< Within range.
constexpr std::size_t kMaxDeep = 32768;
constexpr std::size_t kMaxUnder = 16384;
constexpr double kStood = 0.005;   ///< A robot that moved less is stationary, m.
constexpr double kSteady = 0.002;  ///< Maximum rotation of a stationary robot, rad.
/// Uncertainty of a body's attitude with its suspension, lidar mount and IMU, rad.
constexpr float kSigmaTilt = 0.035f;
constexpr double kBuiltRamp = 0.2;  ///< Rise per run of the steepest ramps that are built for vehicles.
/// A first return up to this fraction of the lidar's height may be ground.
constexpr double kLidarShare = 0.7;

/// Angle between two rings of the lidar, rad.
double ring_angle(const Platform& platform) {
  const LidarConfig lidar = platform.lidar();
  return std::max(1e-4, (lidar.highest - lidar.lowest) * M_PI / 180 / std::max(1, lidar.rings - 1));
}

/// Range up to which a ray that passes the ground's height distinguishes a drop from a ramp, m. There the
/// rings are less than half a body apart on the ground, (r2 + h2) / h for each radian between them, and rays
/// are steeper than built ramps.
double sure_range(const Platform& platform) {
  const double h = platform.lidar_height, gap = platform.length / 2 + double{GroundGrid::kCell};
  return std::min(std::sqrt(std::max(0.0, gap * h / ring_angle(platform) - h * h)), h / kBuiltRamp);
}

GroundParams ground_params(const Platform& platform, double range) {
  const auto limits = Traversability::of(platform);
  const double rise =
      platform.stairs ? limits.obstacle + Traversability::kRiser : std::max(0.03, limits.step);
  GroundParams ground;
  ground.slope = static_cast<float>(limits.slope);
  ground.rise = static_cast<float>(std::max(rise, limits.slope * double{GroundGrid::kCell} + 0.02));
  ground.drop = static_cast<float>(limits.drop);
  ground.most = static_cast<float>(kLidarShare * platform.lidar_height);
  ground.sigma_tilt = kSigmaTilt;
  ground.rings = static_cast<float>(ring_angle(platform));
  ground.sure = static_cast<float>(sure_range(platform));
  ground.range = static_cast<float>(range);
  return ground;
}

SurfaceParams surface_params(const Platform& platform) {
  const auto limits = Traversability::of(platform);
  SurfaceParams surface;
  surface.slope = static_cast<float>(limits.slope);
  surface.step = static_cast<float>(std::max(limits.step, 0.02));
  // On stairs the edges seen from below are uncertain; steps too high for legs are obstacles anyway.
  if (!platform.stairs)
    surface.blocking_step = static_cast<float>(
        std::max(limits.step, limits.slope * double{GroundGrid::kCell}) + limits.obstacle - limits.step);
  return surface;
}

}  // namespace

TerrainMap::TerrainMap(const Platform& platform, double range)
    : platform_(platform),
      range_(range),
      limits_(Traversability::of(platform)),
      body_(platform),
      ground_(ground_params(platform, range)),
      obstacles_(body_, range),
      drops_({static_cast<float>(limits_.drop), static_cast<float>(sure_range(platform)),
              static_cast<float>(platform.length / 2), static_cast<float>(ring_angle(platform))},
             ground_),
      surface_(surface_params(platform), ground_.side()),
      solid_(ground_.cells(), 0) {
  near_.reserve(kUsualReturns);
  under_.reserve(platform.stairs ? kMaxUnder : 0);
  deep_.reserve(kMaxDeep);
}

void TerrainMap::clear() {
  ground_.clear();
  obstacles_.clear();
  drops_.clear();
  stairs_.clear();
  height_correction_ = 0;
  tilt_error_.setZero();
  begun_ = false;
}

void TerrainMap::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  if (!begun_) {
    epoch_ = stamp_s;
    last_body_ = body;
    begun_ = true;
  }
  now_ = static_cast<float>(stamp_s - epoch_);
  const Eigen::Vector3d lidar = scan.origin(platform_.lidar_origin());
  View view(body, lidar);
  view.raise(height_correction_);
  view.tilt_by(tilt_error_);
  ground_.begin_scan(view.base.x(), view.base.y(), now_);
  obstacles_.begin_scan(now_);
  rays_.clear();
  sort_in(scan, view);

  GroundGrid::Offset offset;
  register_scan(body, view, offset);
  const auto aside = static_cast<float>(lidar.head<2>().norm());
  const float blind = rays_.lowest() < 0 ? static_cast<float>(lidar.z()) / -rays_.lowest() + aside : 0.0f;
  const Eigen::Vector2f at = view.aside();
  const float high = view.sensor.z() - view.base.z() - view.tilt().dot(at);
  ground_.grow(offset, view.base.z(), view.tilt(), {at.x(), at.y(), high}, blind);
  // The standard deviation of the ground's height at range r is r times that of its gradient; that of a
  // return is its noise.
  const float known = ground_.plane().sigma_gradient;
  const auto depth = static_cast<float>(limits_.drop) / 3,
             noise = static_cast<float>(platform_.lidar().noise);
  mark_obstacles(view);
  find_drops(view, std::sqrt(std::max(0.0f, depth * depth - noise * noise)) / known);
  surface_.work_out(ground_, solid_);
}

void TerrainMap::register_scan(const Pose3& body, View& view, GroundGrid::Offset& offset) {
  if ((body.position - last_body_.position).norm() < kStood &&
      body.orientation.angularDistance(last_body_.orientation) < kSteady)
    return;
  last_body_ = body;
  offset = ground_.disagreement();
  if (offset.sigma_gradient > 0) {
    // The attitude is a measurement too: it pulls the map back as far as the registration is uncertain.
    const float share = offset.sigma_gradient / kSigmaTilt;
    const Eigen::Vector2f back = std::min(1.0f, share * share) * tilt_error_;
    offset.gradient -= back;
  }
  if (offset.none()) return;
  height_correction_ += offset.height;
  tilt_error_ += offset.gradient;
  const Eigen::Matrix3f before = view.turn;
  view.tilt_by(offset.gradient);
  const Eigen::Matrix3f rotation = view.turn * before.transpose();
  const Eigen::Vector3f base = view.base;
  view.raise(offset.height);
  for (auto* returns : {&near_, &deep_})
    for (Eigen::Vector3f& p : *returns) p = view.base + rotation * (p - base);
}

void TerrainMap::sort_in(const ScanPoints& scan, const View& view) {
  near_.clear();
  deep_.clear();
  std::size_t part = 0;
  scan.each_part(platform_.lidar_origin(), [&](auto points, const Eigen::Vector3d& origin) {
    const Eigen::Vector3f sensor = origin.cast<float>();
    if (part++ == 0) {
      sort_in(points, sensor, true, rays_, view);
      near_of_first_ = near_.size();
      return;
    }
    if (more_.size() < part - 1) more_.emplace_back();
    ObstacleCells::Seen& seen = more_[part - 2];
    seen.view = view;
    seen.view.lidar = sensor;
    seen.view.sensor = view.base + view.turn * sensor;
    seen.rays.clear();
    sort_in(points, sensor, false, seen.rays, view);
  });
  more_.resize(std::max<std::size_t>(part, 1) - 1);
}

void TerrainMap::sort_in(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& sensor, bool deep,
                         LidarRangeImage& rays, const View& view) {
  const auto range2 = static_cast<float>(range_ * range_);
  const auto min2 = static_cast<float>(kMinRange * kMinRange);
  const auto reach2 = static_cast<float>(std::pow(body_.radius(), 2));
  // Rays that cross the plane of the ground within range and end below it.
  const Eigen::Vector2f rise = ground_.grown() ? ground_.plane().gradient : view.tilt();
  const Eigen::Vector3f up = view.turn.transpose() * Eigen::Vector3f(-rise.x(), -rise.y(), 1.0f);
  const float above = up.dot(sensor);  // Of the lidar over that plane.
  const auto range = static_cast<float>(range_);
  const Eigen::Matrix3f straight = Eigen::Matrix3f::Identity();
  for (std::size_t begin = 0; begin < points.size(); begin += block_.count()) {
    block_.take(points.subspan(begin), sensor, straight);
    constexpr int kNoReturn = -2;
    std::array<int, RayBlock::kSize> bins;
    for (std::size_t n = 0; n < RayBlock::kSize; ++n) {
      const Ray ray = block_[n];
      const float flat2 = ray.range * ray.range, dz = block_.height(n);
      const float full2 = flat2 + dz * dz;
      // Written so that a NaN fails. A vertical ray has no bearing.
      const bool returned = (full2 > min2) & (flat2 > 1e-4f) & (full2 < 1e6f);
      bins[n] = returned ? LidarRangeImage::bin_of(ray) : kNoReturn;
    }
    for (std::size_t n = 0; n < block_.count(); ++n) {
      if (bins[n] == kNoReturn) continue;
      const Eigen::Vector3f& p = points[begin + n];
      const Ray ray = block_[n];
      rays.add(bins[n], ray);
      const float out2 = p.x() * p.x() + p.y() * p.y();  // From base_link.
      if (out2 <= range2) {
        if (out2 < reach2 && body_.depth(p.x(), p.y()) > 0.0f) continue;
        const Eigen::Vector3f world = view.in_map(p);
        ground_.add(world.x(), world.y(), world.z());
        near_.push_back(world);
      } else if (const float end = up.dot(p);
                 deep && end < 0 && above * ray.range < range * (above - end) && deep_.size() < kMaxDeep) {
        deep_.push_back(view.in_map(p));
      }
    }
  }
}

void TerrainMap::mark_obstacles(const View& view) {
  const auto step = static_cast<float>(limits_.obstacle);
  const auto top = static_cast<float>(limits_.headroom);
  under_.clear();
  for (std::size_t n = 0; n < near_.size(); ++n) {
    const Eigen::Vector3f& p = near_[n];
    const int index = ground_.window(p.x(), p.y());
    const float climb = p.z() - ground_.before(index);
    if (climb > step) {
      if (climb < top) obstacles_.mark(p.x(), p.y(), p.z(), climb);
    } else if (climb > step / 2) {
      if (under_.size() < under_.capacity()) under_.emplace_back(p.x(), p.y());
    } else if (climb < 0 && n < near_of_first_ && is_below(p) && deep_.size() < kMaxDeep) {
      deep_.push_back(p);
    }
  }
  for (const Eigen::Vector2f& p : under_) obstacles_.mark_under(p.x(), p.y());
  obstacles_.keep(view, rays_, more_, ground_, step);
  std::fill(solid_.begin(), solid_.end(), std::uint8_t{0});
  for (const auto& e : obstacles_.entries())
    if (e.again) solid_[ground_.window(e.x(), e.y())] = 1;
}

bool TerrainMap::is_below(const Eigen::Vector3f& p) const {
  const int index = ground_.window(p.x(), p.y());
  return p.z() - ground_.height(index) < -ground_.drop_limit(index);
}

void TerrainMap::find_drops(const View& view, float farthest) {
  drops_.begin_scan(ground_, solid_, now_, farthest);
  for (const Eigen::Vector3f& p : deep_)
    if (is_below(p)) drops_.below(view, p, ground_);
  drops_.count_missing_returns(view, rays_, ground_);
  drops_.finish(view, rays_, ground_);
}

void TerrainMap::set_stairs(std::span<const Staircase> stairs) {
  stairs_.clear();
  std::ranges::copy_if(stairs, std::back_inserter(stairs_),
                       [this](const Staircase& each) { return climbs(platform_, each); });
}

bool TerrainMap::is_on_stairs(const Eigen::Vector2f& at) const {
  // The cell of the edge and the one before it, which is written with a drop.
  constexpr double kEdge = 2 * double{GroundGrid::kCell};
  const double z = last_body_.position.z();
  return std::ranges::any_of(stairs_, [&](const Staircase& stairs) {
    if (z < stairs.floor_below() - kSameStorey || z > stairs.floor_above() + kSameStorey) return false;
    const OnStairs place = on_stairs(stairs, double{at.x()}, double{at.y()});
    return place.along >= -kStairsApproach && place.along <= length_of(stairs) + kEdge &&
           std::abs(place.across) <= stairs.width / 2;
  });
}

}  // namespace adit::nav
