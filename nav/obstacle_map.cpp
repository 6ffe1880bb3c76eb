#include "nav/obstacle_map.hpp"

#include <algorithm>

namespace adit::nav {
namespace {

constexpr std::size_t kUsualReturns = 32768;  ///< more returns than a scan has
constexpr int kMany = 8;               ///< a surface has this many times the hits of the noise before it
constexpr double kForgetBeyond = 0.3;  ///< m beyond the range

GroundMapParams ground_params(const Platform& platform, const ObstacleMapParams& params) {
  // The ground may rise from cell to cell by less than the robot's step, else a stack of small rises would
  // carry it up onto what it cannot climb.
  return {.slope = params.slope, .tolerance = std::clamp(0.75 * platform.step, 0.03, 0.12)};
}

}  // namespace

ObstacleMap::ObstacleMap(const Platform& platform, const ObstacleMapParams& params)
    : platform_(platform),
      params_(params),
      ground_(ground_params(platform, params)),
      slots_(kTorus * kTorus, 0) {
  near_.reserve(kUsualReturns);
  entries_.reserve(kMaxCells);
  cells_.reserve(kMaxCells);
}

void ObstacleMap::clear() {
  entries_.clear();
  cells_.clear();
  std::fill(slots_.begin(), slots_.end(), std::uint16_t{0});
  ground_ = GroundMap(ground_params(platform_, params_));
}

bool ObstacleMap::in_body(float dx, float dy, double margin) const {
  const float x = body_cos_ * dx + body_sin_ * dy, y = body_cos_ * dy - body_sin_ * dx;
  return std::fabs(x) <= platform_.length / 2 + margin && std::fabs(y) <= platform_.width / 2 + margin;
}

void ObstacleMap::add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
  ++scan_;
  const Eigen::Matrix3f turn = body.orientation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f lidar(0.0f, 0.0f, static_cast<float>(platform_.lidar_height));
  const Eigen::Vector3f sensor = body.position.cast<float>() + turn * lidar;
  body_x_ = static_cast<float>(body.position.x());
  body_y_ = static_cast<float>(body.position.y());
  body_cos_ = static_cast<float>(std::cos(body.yaw()));
  body_sin_ = static_cast<float>(std::sin(body.yaw()));

  ground_.begin_scan(stamp_s);
  rays_.clear();
  near_.clear();
  const auto range2 = static_cast<float>(params_.range * params_.range);
  const auto min2 = static_cast<float>(params_.min_range * params_.min_range);
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f d = turn * (p - lidar);
    const float flat2 = d.x() * d.x() + d.y() * d.y();
    const float full2 = flat2 + d.z() * d.z();
    // Written so that a NaN fails; straight up and down says nothing about the way.
    if (!(full2 > min2 && flat2 > 1e-4f && full2 < 1e6f)) continue;
    rays_.add(d.x(), d.y(), d.z(), std::sqrt(flat2));
    if (flat2 > range2) continue;
    const Eigen::Vector3f world = sensor + d;
    ground_.add(world.x(), world.y(), world.z());
    near_.push_back(world);
  }
  ground_.grow(body.position.x(), body.position.y(), body.position.z());

  const auto step = static_cast<float>(platform_.step + params_.step_margin);
  const auto top =
      static_cast<float>(std::max(platform_.height, platform_.lidar_height) + params_.height_margin);
  const auto drop = static_cast<float>(-std::max(params_.drop, 2.0 * platform_.step));
  const auto reach = static_cast<float>(std::hypot(platform_.length, platform_.width) / 2 + 0.1);
  for (const Eigen::Vector3f& p : near_) {
    const float height = p.z() - ground_.at(p.x(), p.y());
    if (height <= step && height >= drop) continue;
    if (height >= top) continue;
    const float dx = p.x() - body_x_, dy = p.y() - body_y_;
    if (dx * dx + dy * dy < reach * reach && in_body(dx, dy, params_.body_margin)) continue;
    mark(p, stamp_s);
  }

  std::size_t kept = 0;
  cells_.clear();
  for (Entry& entry : entries_) {
    if (!keep(entry, sensor, stamp_s)) {
      slots_[slot(entry.ix, entry.iy)] = 0;
      continue;
    }
    entries_[kept] = entry;
    slots_[slot(entry.ix, entry.iy)] = static_cast<std::uint16_t>(++kept);
    cells_.emplace_back((static_cast<float>(entry.ix) + 0.5f) * kCell,
                        (static_cast<float>(entry.iy) + 0.5f) * kCell);
  }
  entries_.resize(kept);
}

void ObstacleMap::mark(const Eigen::Vector3f& point, double stamp_s) {
  const int ix = cell(point.x()), iy = cell(point.y());
  std::uint16_t& index = slots_[slot(ix, iy)];
  if (index != 0) {
    Entry& e = entries_[index - 1u];
    if (e.ix == ix && e.iy == iy) {
      e.z_low = std::min(e.z_low, point.z());
      e.z_high = std::max(e.z_high, point.z());
      e.hits = e.scan == scan_ ? e.hits + 1 : 1;
      e.scan = scan_;
      return;
    }
    // Left behind on the other side of the torus: its place is taken.
    e = {ix, iy, point.z(), point.z(), scan_, 1, 0, false, stamp_s};
    return;
  }
  if (entries_.size() >= kMaxCells) return;
  entries_.push_back({ix, iy, point.z(), point.z(), scan_, 1, 0, false, stamp_s});
  index = static_cast<std::uint16_t>(entries_.size());
}

bool ObstacleMap::stray(const Entry& entry, float dx, float dy, float range) const {
  if (entry.hits >= kMany || range < 0.05f) return false;
  for (int further = 1; further <= 2; ++further) {
    const float along = static_cast<float>(further) / range;
    const int ix = entry.ix + floor_int(along * dx + 0.5f), iy = entry.iy + floor_int(along * dy + 0.5f);
    const std::uint16_t index = slots_[slot(ix, iy)];
    if (index == 0) continue;
    const Entry& behind = entries_[index - 1u];
    if (behind.ix == ix && behind.iy == iy && behind.scan == scan_ && behind.hits >= kMany * entry.hits)
      return true;
  }
  return false;
}

bool ObstacleMap::keep(Entry& entry, const Eigen::Vector3f& sensor, double stamp_s) const {
  const float x = (static_cast<float>(entry.ix) + 0.5f) * kCell;
  const float y = (static_cast<float>(entry.iy) + 0.5f) * kCell;
  const float dx = x - sensor.x(), dy = y - sensor.y();
  const float range = std::sqrt(dx * dx + dy * dy);
  if (entry.scan == scan_) {
    entry.misses = 0;
    if (stray(entry, dx, dy, range)) return entry.solid && stamp_s - entry.stamp <= params_.memory;
    entry.solid = true;
    entry.stamp = stamp_s;
    return true;
  }
  if (range > params_.range + kForgetBeyond) return false;
  // Where the robot stands nothing else does.
  if (in_body(x - body_x_, y - body_y_, -0.05)) return false;
  const float low = entry.z_low - sensor.z(), high = entry.z_high - sensor.z();
  if (range < 0.05f || high < (rays_.lowest() - 0.01f) * range) {
    entry.stamp = stamp_s;  // in the blind spot: nothing can be said against it
    return true;
  }
  if (rays_.saw_through(dx, dy, low, high, range, 3.0f * kCell)) {
    if (++entry.misses >= params_.misses) return false;
  } else {
    entry.misses = 0;
  }
  // A lidar has a shortest range, too: what came so close is not gone because it is no longer seen.
  return range < params_.blind_range || stamp_s - entry.stamp <= params_.memory;
}

}  // namespace adit::nav
