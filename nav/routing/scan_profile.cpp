// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/scan_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace adit::nav {
namespace {

constexpr float kStack = 0.15f;      // m: returns this close above each other belong to one object.
constexpr float kNextReturn = 1.0f;  // m: 16 rings over 30 degrees are this far apart at 28 m.
constexpr float kRun = 0.8f;         // m: the ground cannot be extrapolated over a longer distance.
constexpr float kWallGap = 1.5f;     // m
constexpr float kStraight = 0.1f;    // m
constexpr float kGap = 0.5f;         // m
constexpr float kFirst = 1.5f;  // m: the ground is unknown within this distance of a lidar with few rings.

// Approximates std::atan2 within 1e-5 rad by an odd minimax polynomial of degree 11; runs for every return.
float bearing(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y), most = std::max(ax, ay);
  if (most == 0.0f) return 0.0f;
  const float t = std::min(ax, ay) / most, u = t * t;
  float angle =
      t * (0.99997726f +
           u * (-0.33262347f + u * (0.19354346f + u * (-0.11643287f + u * (0.05265332f - u * 0.01172120f)))));
  constexpr auto kPi = static_cast<float>(M_PI);
  if (ay > ax) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

/// Maximum rise of ground per metre between two returns. Steeper ground gives more returns; with a larger
/// value a box of half a metre between two rings would pass for a ramp.
double rise_between_returns(const Traversability& limits) {
  constexpr double kMax = 0.35;
  return std::min(kMax, limits.slope);
}

}  // namespace

ScanProfile::ScanProfile(const Platform& platform, const RouteParams& params)
    : platform_(platform),
      params_(params),
      clear_(static_cast<float>(Traversability::of(platform).headroom)),
      step_(static_cast<float>(Traversability::of(platform).obstacle)),
      drop_(static_cast<float>(Traversability::of(platform).drop)),
      slope_(static_cast<float>(rise_between_returns(Traversability::of(platform)))) {
  list_sectors();
}

float ScanProfile::most_wrong(const Platform& platform) {
  constexpr double kNoise = 0.05;  // m
  const auto limits = Traversability::of(platform);
  return static_cast<float>(std::max(limits.obstacle + kNoise, limits.drop) +
                            rise_between_returns(limits) * double{kRun});
}

void ScanProfile::sort(std::span<const Eigen::Vector3f> points, const Pose3& body) {
  const Eigen::Matrix3f turn = body.orientation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f foot(from_.lidar.x(), from_.lidar.y(), 0);
  const Eigen::Vector3f at = (body * foot.cast<double>()).cast<float>();
  const float half_length = static_cast<float>(platform_.length / 2) + 0.05f;
  const float half_width = static_cast<float>(platform_.width / 2) + 0.05f;
  const float most = static_cast<float>(params_.range);
  unsorted_.clear();
  direction_.clear();
  begin_.assign(kDirections + 1, 0);
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite() || (std::abs(p.x()) < half_length && std::abs(p.y()) < half_width)) continue;
    const Eigen::Vector3f offset = turn * (p - foot);
    const float range = std::sqrt(offset.x() * offset.x() + offset.y() * offset.y());
    if (range > most) continue;
    const int d = static_cast<int>((bearing(offset.y(), offset.x()) + static_cast<float>(M_PI)) *
                                   (kDirections / (2 * static_cast<float>(M_PI))));
    const Eigen::Vector3f place = at + offset;
    unsorted_.push_back({range, place.x(), place.y(), place.z()});
    direction_.push_back(std::clamp(d, 0, kDirections - 1));
    ++begin_[static_cast<std::size_t>(direction_.back()) + 1];
  }
  for (std::size_t d = 1; d < begin_.size(); ++d) begin_[d] += begin_[d - 1];
  sorted_.resize(unsorted_.size());
  std::vector<int>& next = begin_;
  for (std::size_t i = 0; i < unsorted_.size(); ++i)
    sorted_[next[static_cast<std::size_t>(direction_[i])]++] = unsorted_[i];
  // Each entry is now the end of its direction, which is the beginning of the next.
  for (std::size_t d = kDirections; d > 0; --d) begin_[d] = begin_[d - 1];
  begin_[0] = 0;
  for (std::size_t d = 0; d < kDirections; ++d)
    std::sort(
        sorted_.begin() + begin_[d], sorted_.begin() + begin_[d + 1],
        [](const Return& a, const Return& b) { return std::tie(a.range, a.z) < std::tie(b.range, b.z); });
}

// Whether a return behind the first obstacle belongs to an obstacle and not to higher ground that the lidar
// looks down on, like a ramp seen from the side, where a robot may drive.
bool ScanProfile::is_face(std::span<const Return> returns, std::size_t which) const {
  constexpr float kBelow = 0.05f;  // m below the lidar: it cannot look down on higher ground.
  return returns[which].z > from_.sensor.z() - kBelow || is_obstacle(returns, which);
}

// Whether other returns are right above or below it.
bool ScanProfile::is_obstacle(std::span<const Return> returns, std::size_t which) const {
  const Return& r = returns[which];
  const auto near = [&](const Return& other) { return std::abs(other.range - r.range) < kStack; };
  const auto apart = [&](const Return& other) { return std::abs(other.z - r.z) > kStack; };
  for (std::size_t i = which; i-- > 0 && near(returns[i]);)
    if (apart(returns[i])) return true;
  for (std::size_t i = which + 1; i < returns.size() && near(returns[i]); ++i)
    if (apart(returns[i])) return true;
  return false;
}

// Marks the obstacles of a direction and stores the free pieces before the first of them for write_free().
void ScanProfile::walk(std::span<const Return> returns, SurfaceMap& map, Hit& hit) {
  hit = {};
  const std::size_t first = pieces_.size();
  float z = from_.ground, at = 0.0f;  // The last ground.
  float z_before = from_.ground;      // The ground before it.
  const Return* last_ground = nullptr;
  bool ended = false;
  for (const Return& r : returns) {
    const float run = std::min(r.range - at, kRun);
    const auto which = static_cast<std::size_t>(&r - returns.data());
    // Before the first return the ground continues the plane under the body, or becomes level.
    const bool begins = !last_ground && !ended;
    if (const float on = ground_at(r.x, r.y); begins)
      z = std::abs(r.z - on) <= step_ && !is_obstacle(returns, which) ? on : from_.ground;
    const float rise = r.z - z;
    // The foot of an obstacle was taken for rising ground: the next return is right above it.
    const bool foot = !ended && last_ground && r.range - at < kStack && z - z_before > step_ &&
                      rise > step_ && rise < kNextReturn;
    if (!foot && rise > clear_ + (ended ? 0.0f : slope_ * run)) continue;
    if (ended) {
      if (rise > step_ && is_face(returns, which)) see_obstacle(r.x, r.y, z, rise, map);
      continue;
    }
    if (foot || rise > step_ + slope_ * run) {
      float base = z;
      if (foot) {
        base = z_before;
        see_obstacle(last_ground->x, last_ground->y, base, z - base, map);
        if (pieces_.size() > first) pieces_.back().z_to = base;
      }
      see_obstacle(r.x, r.y, base, r.z - base, map);
      pieces_.push_back({at, r.range - kRouteCellF, begins ? from_.ground : base, base, r.z});
      hit = {r.range, r.x, r.y, base, r.z - base};
      z = base;
      ended = true;
    } else if (rise < -(drop_ + slope_ * run)) {
      // There is no ground where the ray passed the ground's height. A ray over ground that rose above the
      // lidar never does.
      if (z >= from_.sensor.z()) return;
      const float share = (from_.sensor.z() - z) / (from_.sensor.z() - r.z);
      const float there = share * r.range;
      if (there > std::max(at, kFirst)) {
        see_obstacle(from_.sensor.x() + share * (r.x - from_.sensor.x()),
                     from_.sensor.y() + share * (r.y - from_.sensor.y()), z, 0.02f, map);
      }
      return;
    } else {
      pieces_.push_back({at, r.range, begins ? from_.ground : z, r.z, r.z});
      z_before = z;
      z = r.z;
      at = r.range;
      last_ground = &r;
    }
  }
}

// Closes gaps between the returns of neighbouring directions, far away and along walls, that are too narrow
// for a robot; unknown space would leak out of a closed room. Longer gaps are closed if a wall continues
// straight.
void ScanProfile::close_gaps(SurfaceMap& map) const {
  const auto at = [this](std::size_t d) -> const Hit& { return hits_[(d + kDirections) % kDirections]; };
  for (std::size_t d = 0; d < kDirections; ++d) {
    const Hit& a = at(d);
    const Hit& b = at(d + 1);
    if (a.range <= 0 || b.range <= 0 || std::abs(a.base - b.base) > step_) continue;
    const float gap = std::hypot(a.x - b.x, a.y - b.y);
    const auto in_line = [&](const Hit& c) {
      return c.range > 0 && std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) < kStraight * gap;
    };
    if (gap > kWallGap || (gap > kGap && !(in_line(at(d + kDirections - 1)) && in_line(at(d + 2))))) continue;
    const int parts = static_cast<int>(std::ceil(gap / kRouteCellF));
    for (int i = 1; i < parts; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(parts);
      see_obstacle(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.base,
                   std::min(a.obstacle_height, b.obstacle_height), map);
    }
  }
}

void ScanProfile::see_obstacle(float x, float y, float z, float height, SurfaceMap& map) const {
  const NearGround::Cell* cell = near_->find(route_cell(double{x}), route_cell(double{y}));
  if (!cell || cell->what == NearGround::Cell::What::unknown) map.see_obstacle(x, y, z, height);
}

// Assigns each cell within range to the one direction that contains its centre.
void ScanProfile::list_sectors() {
  const int reach = static_cast<int>(params_.range / kRouteCell);
  std::array<std::vector<SectorCell>, kQuarter> sectors;
  for (int dx = 1; dx <= reach; ++dx)
    for (int dy = 0; dy <= reach; ++dy) {
      const double range = std::hypot(dx, dy) * kRouteCell;
      const int sector = static_cast<int>(std::atan2(dy, dx) * (kDirections / (2 * M_PI)));
      if (range <= params_.range && sector < kQuarter)
        sectors[sector].push_back(
            {static_cast<std::int16_t>(dx), static_cast<std::int16_t>(dy), static_cast<float>(range)});
    }
  for (std::size_t d = 0; d < kQuarter; ++d) {
    std::ranges::sort(sectors[d], {}, &SectorCell::range);
    quarter_.insert(quarter_.end(), sectors[d].begin(), sectors[d].end());
    first_[d + 1] = quarter_.size();
  }
}

void ScanProfile::write_free(int direction, std::span<const Piece> pieces, SurfaceMap& map) const {
  const auto sector = static_cast<std::size_t>(direction % kQuarter);
  const int turns = direction / kQuarter + 2;  // Quarter turns: direction 0 is -x.
  // Ranges are from the lidar's foot.
  const int cx = route_cell(from_.at.x()), cy = route_cell(from_.at.y());
  std::size_t i = first_[sector];
  for (const Piece& p : pieces) {
    const float run = std::max(p.to - p.from, 1e-3f);
    while (i < first_[sector + 1] && quarter_[i].range < p.from) ++i;
    for (; i < first_[sector + 1] && quarter_[i].range <= p.to; ++i) {
      int dx = quarter_[i].dx, dy = quarter_[i].dy;
      if (turns & 1) dx = -std::exchange(dy, dx);
      if (turns & 2) dx = -dx, dy = -dy;
      const float r = quarter_[i].range;
      float z = p.z_from + (p.z_to - p.z_from) * (r - p.from) / run;
      bool there = p.to - r < kRouteCellF;  // At a return, or at the foot of an obstacle.
      if (const NearGround::Cell* cell = near_->find(cx + dx, cy + dy)) {
        if (cell->what > NearGround::Cell::What::ground) continue;
        if (cell->measured || std::abs(z - cell->low) > step_) z = cell->low;
        there = there && !cell->measured;
      }
      const float ray = from_.sensor.z() + (p.ray_z - from_.sensor.z()) * r / std::max(p.to, r);
      map.see_free(cx + dx, cy + dy, z, std::max(0.0f, ray - z),
                   there ? SurfaceMap::Seen::measured : SurfaceMap::Seen::between);
    }
  }
}

float ScanProfile::ground_at(double x, double y) const {
  return from_.ground +
         gradient_.dot(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - from_.at);
}

void ScanProfile::stand(const Pose3& body, SurfaceMap& map) const {
  const double radius = std::min(platform_.length, platform_.width) / 2;
  const int reach = static_cast<int>(radius / kRouteCell) + 1;
  const int cx = route_cell(body.position.x()), cy = route_cell(body.position.y());
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x)
      if (std::hypot((x + 0.5) * kRouteCell - body.position.x(),
                     (y + 0.5) * kRouteCell - body.position.y()) <= radius)
        map.see_free(x, y, ground_at((x + 0.5) * kRouteCell, (y + 0.5) * kRouteCell), 0.0f,
                     SurfaceMap::Seen::stood_on);
}

ScanProfile::Viewpoint ScanProfile::viewpoint(const Eigen::Vector3d& lidar, const Pose3& body) {
  const Eigen::Vector3d foot = body * Eigen::Vector3d(lidar.x(), lidar.y(), 0);
  return {lidar.cast<float>(), (body * lidar).cast<float>(), foot.head<2>().cast<float>(),
          static_cast<float>(foot.z())};
}

void ScanProfile::walk_all(std::span<const Eigen::Vector3f> points, const Pose3& body, SurfaceMap& map,
                           Ends& ends) {
  sort(points, body);
  for (std::size_t d = 0; d < kDirections; ++d) {
    const auto from = static_cast<std::size_t>(begin_[d]), to = static_cast<std::size_t>(begin_[d + 1]);
    walk(std::span(sorted_).subspan(from, to - from), map, hits_[d]);
    ends[d] = pieces_.size();
  }
  close_gaps(map);
}

void ScanProfile::add(const ScanPoints& scan, const Pose3& body, const NearGround& near, SurfaceMap& map) {
  near_ = &near;
  const Eigen::Vector3d usual = platform_.lidar_origin();
  from_ = viewpoint(scan.origin(usual), body);
  const Eigen::Vector3f up = (body.orientation * Eigen::Vector3d::UnitZ()).cast<float>();
  gradient_ = up.z() > 0.5f ? Eigen::Vector2f(-up.x() / up.z(), -up.y() / up.z()) : Eigen::Vector2f(0, 0);
  map.begin_scan(body.position.x(), body.position.y());
  near.write(map);
  stand(body, map);
  // All obstacles first, so that a neighbouring ray does not free an occupied cell.
  pieces_.clear();
  parts_.clear();
  scan.each_part(usual, [&](auto points, const Eigen::Vector3d& lidar) {
    from_ = viewpoint(lidar, body);
    Part& part = parts_.emplace_back(Part{from_, {}});
    walk_all(points, body, map, part.ends);
  });
  std::size_t begin = 0;
  for (const Part& part : parts_) {
    from_ = part.from;
    for (std::size_t d = 0; d < kDirections; begin = part.ends[d++])
      write_free(static_cast<int>(d), std::span(pieces_).subspan(begin, part.ends[d] - begin), map);
  }
}

}  // namespace adit::nav
