// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/terrain_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/riser.hpp"

namespace adit::nav {
namespace {

constexpr std::size_t kUsualReturns = 32768;  ///< within range
constexpr std::size_t kMostDeep = 32768;
constexpr std::size_t kMostUnder = 16384;
constexpr double kStood = 0.005;     ///< m: a robot that moved less stands
constexpr double kLidarShare = 0.7;  ///< of the lidar's height: a first return as high as this may be ground

GroundParams ground_params(const Platform& platform, const TerrainParams& params) {
  const auto limits = Traversability::of(platform);
  const double rise = platform.stairs ? limits.obstacle + kRiser : std::max(0.03, limits.step);
  GroundParams ground;
  ground.slope = static_cast<float>(limits.slope);
  ground.rise = static_cast<float>(std::max(rise, limits.slope * double{GroundGrid::kCell} + 0.02));
  ground.drop = static_cast<float>(limits.drop);
  ground.most = static_cast<float>(kLidarShare * platform.lidar_height);
  ground.memory = static_cast<float>(params.ground_memory);
  return ground;
}

SurfaceParams surface_params(const Platform& platform) {
  const auto limits = Traversability::of(platform);
  SurfaceParams surface;
  surface.slope = static_cast<float>(limits.slope);
  surface.step = static_cast<float>(std::max(limits.step, 0.02));
  // On stairs the edges seen from below are uncertain; what is too high for legs stands in the way anyway.
  if (!platform.stairs)
    surface.blocking_step = static_cast<float>(
        std::max(limits.step, limits.slope * double{GroundGrid::kCell}) + limits.obstacle - limits.step);
  return surface;
}

}  // namespace

TerrainMap::TerrainMap(const Platform& platform, const TerrainParams& params)
    : platform_(platform),
      params_(params),
      limits_(Traversability::of(platform)),
      body_(platform),
      ground_(ground_params(platform, params)),
      obstacles_(body_, params),
      drops_(params),
      surface_(surface_params(platform)),
      solid_(GroundGrid::kSide * GroundGrid::kSide, 0),
      drop_(GroundGrid::kSide * GroundGrid::kSide, 0) {
  near_.reserve(kUsualReturns);
  under_.reserve(platform.stairs ? kMostUnder : 0);
  deep_.reserve(kMostDeep);
  cells_.reserve(kMaxCells);
}

void TerrainMap::clear() {
  ground_.clear();
  obstacles_.clear();
  drops_.clear();
  cells_.clear();
  lift_ = 0;
  begun_ = false;
}

void TerrainMap::add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
  if (!begun_) {
    epoch_ = stamp_s;
    last_body_ = body;
    begun_ = true;
  }
  now_ = static_cast<float>(stamp_s - epoch_);
  View view(body, platform_.lidar_height);
  view.raise(lift_);
  ground_.begin_scan(view.base.x(), view.base.y(), now_);
  obstacles_.begin_scan(now_);
  drops_.begin_scan(ground_, now_);
  rays_.clear();
  sort_in(points, view);

  float lift = 0;
  if ((body.position - last_body_.position).norm() > kStood) {
    lift = ground_.disagreement();
    last_body_ = body;
    lift_ += lift;
    view.raise(lift);
    for (auto* returns : {&near_, &deep_})
      for (Eigen::Vector3f& p : *returns) p.z() += lift;
  }
  ground_.grow(lift, view.base.z(), view.tilt());
  classify(view);
  drops_.silent(view, rays_, ground_);
  drops_.finish(view, rays_, ground_);
  obstacles_.keep(view, rays_, ground_, static_cast<float>(limits_.obstacle));
  std::fill(solid_.begin(), solid_.end(), std::uint8_t{0});
  for (const auto& e : obstacles_.entries())
    if (e.again) solid_[static_cast<std::size_t>(ground_.window(e.x(), e.y()))] = 1;
  surface_.work_out(ground_, solid_);
  write_cells();
}

void TerrainMap::sort_in(std::span<const Eigen::Vector3f> points, const View& view) {
  near_.clear();
  deep_.clear();
  const auto lidar = static_cast<float>(platform_.lidar_height);
  const auto range2 = static_cast<float>(params_.range * params_.range);
  const auto min2 = static_cast<float>(params_.min_range * params_.min_range);
  const auto reach2 = static_cast<float>(std::pow(body_.radius() + params_.body_margin, 2));
  const auto own = static_cast<float>(-params_.body_margin);
  const auto deep = -lidar / static_cast<float>(params_.range);
  const Eigen::Vector3f sensor(0.0f, 0.0f, lidar);
  const Eigen::Matrix3f straight = Eigen::Matrix3f::Identity();
  for (std::size_t first = 0; first < points.size(); first += block_.count()) {
    block_.take(points.subspan(first), sensor, straight);
    for (std::size_t n = 0; n < block_.count(); ++n) {
      const Eigen::Vector3f& p = points[first + n];
      const Ray ray = block_[n];
      const float flat2 = ray.range * ray.range, dz = p.z() - lidar;
      const float full2 = flat2 + dz * dz;
      // Written so that a NaN fails; straight up and down says nothing about the way.
      if (!(full2 > min2 && flat2 > 1e-4f && full2 < 1e6f)) continue;
      rays_.add(ray);
      if (flat2 <= range2) {
        if (flat2 < reach2 && body_.depth(p.x(), p.y()) >= own) continue;
        const Eigen::Vector3f world = view.base + view.turn * p;
        ground_.add(world.x(), world.y(), world.z());
        near_.push_back(world);
      } else if (dz < deep * ray.range && deep_.size() < kMostDeep) {
        deep_.push_back(view.base + view.turn * p);
      }
    }
  }
}

void TerrainMap::classify(const View& view) {
  const auto step = static_cast<float>(limits_.obstacle);
  const auto top = static_cast<float>(limits_.headroom);
  const auto drop = static_cast<float>(-limits_.drop);
  under_.clear();
  for (const Eigen::Vector3f& p : near_) {
    const float climb = p.z() - ground_.before(p.x(), p.y());
    if (climb > step) {
      if (climb < top) obstacles_.mark(p.x(), p.y(), p.z(), climb);
    } else if (climb > step / 2) {
      if (under_.size() < under_.capacity()) under_.emplace_back(p.x(), p.y());
    } else if (climb < drop && p.z() - ground_.at(p.x(), p.y()) < drop) {
      drops_.below(view, p, ground_);
    }
  }
  for (const Eigen::Vector2f& p : under_) obstacles_.mark_under(p.x(), p.y());
  for (const Eigen::Vector3f& p : deep_)
    if (p.z() - ground_.at(p.x(), p.y()) < drop) drops_.below(view, p, ground_);
}

// With the last cell of the ground before each: where in its cell a drop begins nobody knows.
void TerrainMap::write_drops() {
  constexpr int kSide = GroundGrid::kSide;
  std::fill(drop_.begin(), drop_.end(), std::uint8_t{0});
  const auto write = [this](int index) {
    if (std::exchange(drop_[static_cast<std::size_t>(index)], std::uint8_t{1})) return;
    const Eigen::Vector2f at = ground_.middle(index);
    cells_.push_back({at.x(), at.y(), 1.0f, 0.0f, Layer::drop});
  };
  for (const int index : drops_.cells()) {
    write(index);
    const int i = index / kSide, j = index % kSide;
    if (i == 0 || j == 0 || i == kSide - 1 || j == kSide - 1) continue;
    for (const int beside : {index - kSide, index - 1, index + 1, index + kSide})
      if (ground_.measured(beside)) write(beside);
  }
}

void TerrainMap::write_cells() {
  cells_.clear();
  for (const auto& e : obstacles_.entries())
    if (e.again) cells_.push_back({e.mean_x, e.mean_y, 1.0f, now_ - e.since});
  write_drops();
  for (const Surface::Place& place : surface_.places()) {
    const Eigen::Vector2f at = ground_.middle(place.index);
    cells_.push_back({at.x(), at.y(), place.cost, 0.0f, place.layer});
  }
}

}  // namespace adit::nav
