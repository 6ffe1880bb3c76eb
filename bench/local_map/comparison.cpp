// SPDX-License-Identifier: Apache-2.0
#include "bench/local_map/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace adit::bench {
namespace {

using nav::CellClass;
using nav::LocalCell;
using nav::LocalMap;

constexpr float kReach = kRings.back();
constexpr double kNearReach = 2.0;       // m
constexpr float kHeightsApart = 0.05f;   // m
constexpr std::uint64_t kEachScans = 5;  // Of the map of the routes: one comparison a second.

/// Four cells of the local map, as one of 0.1 m.
struct Quarters {
  CellClass kind{};
  bool blocked{}, measured{}, fresh{};
  float low{LocalCell::kNone};
};

/// The quarters whose cell with the smallest coordinates is (ix, iy), both even.
Quarters quarters(const LocalMap& map, int ix, int iy) {
  constexpr std::array kWorst{CellClass::drop, CellClass::mover, CellClass::obstacle,
                              CellClass::step, CellClass::slope, CellClass::ground};
  Quarters out;
  std::array<bool, nav::kCellClasses> has{};
  for (const int dy : {0, 1})
    for (const int dx : {0, 1}) {
      if (!map.inside(ix + dx, iy + dy)) continue;
      const LocalCell& cell = map.at(ix + dx, iy + dy);
      has[static_cast<std::size_t>(cell.kind)] = true;
      out.blocked |= cell.impassable();
      out.measured |= cell.measured;
      out.fresh |= cell.fresh;
      out.low = cell.low;
    }
  for (const CellClass kind : kWorst)
    if (has[static_cast<std::size_t>(kind)]) {
      out.kind = kind;
      break;
    }
  return out;
}

template <class Visit>
void visit_quarters(const LocalMap& map, float reach, Visit&& visit) {
  map.visit(reach, [&](int ix, int iy, const LocalCell&) {
    if (ix % 2 == 0 && iy % 2 == 0) visit(ix, iy, quarters(map, ix, iy));
  });
}

std::size_t ring_of(const LocalMap& map, int ix, int iy) {
  const Eigen::Vector2d from = map.scan().body.position.head<2>();
  const double range =
      std::hypot(double{LocalMap::centre(ix)} - from.x(), double{LocalMap::centre(iy)} - from.y());
  const auto ring = std::ranges::lower_bound(kRings, static_cast<float>(range));
  return std::min<std::size_t>(static_cast<std::size_t>(ring - kRings.begin()), kRings.size() - 1);
}

std::size_t class_of(const nav::GroundCell* cell) {
  if (!cell || (!cell->known && !cell->blocked)) return 0;
  if (cell->blocked) return cell->obstacle_height == nav::kHoleHeight ? 4 : 3;
  return cell->guessed() ? 1 : 2;
}

bool is_blocked(const nav::GroundCell* cell) { return cell && cell->blocked; }

}  // namespace

void Counts::operator+=(const Counts& other) {
  scans += other.scans;
  const auto add = [](auto& to, const auto& from) {
    for (std::size_t n = 0; n < to.size(); ++n) to[n] += from[n];
  };
  for (std::size_t ring = 0; ring < route.size(); ++ring)
    for (std::size_t kind = 0; kind < route[ring].size(); ++kind)
      add(route[ring][kind], other.route[ring][kind]);
  add(only_local, other.only_local);
  add(only_route, other.only_route);
  add(local_blocked, other.local_blocked);
  add(route_blocked, other.route_blocked);
  add(why_local, other.why_local);
  add(why_route, other.why_route);
  heights += other.heights;
  heights_off += other.heights_off;
  near += other.near;
  only_near += other.only_near;
  near_local += other.near_local;
  not_near += other.not_near;
}

Comparison::Comparison(const Platform& platform)
    : detector_(platform, 3.0), step_(static_cast<float>(Traversability::of(platform).obstacle)) {}

void Comparison::look(const agent::PlanJob& job, const nav::LocalNavigation& local) {
  map_ = local.map();
  ++counts_.scans;
  compare_near(job);
}

void Comparison::compare_near(const agent::PlanJob& job) {
  const auto& found = detector_.look(job.scan->measured(), job.scan->body, map_->scan().stamp_s);
  const Eigen::Vector2d from = map_->scan().body.position.head<2>();
  const auto is_near = [&](float x, float y) {
    return std::hypot(double{x} - from.x(), double{y} - from.y()) < kNearReach;
  };
  for (const auto& place : found.places) {
    if (!is_near(place.x, place.y)) continue;
    ++counts_.near;
    bool also = false;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int ix = LocalMap::cell(place.x) + dx, iy = LocalMap::cell(place.y) + dy;
        also |= map_->inside(ix, iy) && map_->at(ix, iy).impassable();
      }
    counts_.only_near += !also;
  }
  constexpr float kBeside = 0.15f;  // m
  map_->visit(static_cast<float>(kNearReach), [&](int ix, int iy, const LocalCell& cell) {
    if (cell.kind != CellClass::obstacle && cell.kind != CellClass::mover) return;
    ++counts_.near_local;
    const float x = LocalMap::centre(ix), y = LocalMap::centre(iy);
    counts_.not_near += std::ranges::none_of(
        found.places, [&](const auto& place) { return std::hypot(place.x - x, place.y - y) < kBeside; });
  });
}

void Comparison::look(const agent::RouteJob& job, const nav::RoutePlanner& planner) {
  if (!map_ || map_->scan().odom_epoch != job.odom_epoch || map_->scan().jumps != job.scan->jumps) return;
  if (route_scans_++ % kEachScans != 0) return;
  const Pose3 into = map_->scan().located * map_->scan().body.inverse();
  const nav::SurfaceMap& map = planner.map();
  visit_quarters(*map_, kReach, [&](int ix, int iy, const Quarters& mine) {
    const double z = std::isnan(mine.low) ? map_->scan().body.position.z() : double{mine.low};
    const double edge = double{LocalMap::kCell} / 2;
    const Eigen::Vector3d at =
        into * Eigen::Vector3d(double{LocalMap::centre(ix)} + edge, double{LocalMap::centre(iy)} + edge, z);
    const int rx = nav::route_cell(at.x()), ry = nav::route_cell(at.y());
    const nav::GroundCell* theirs = map.cell(rx, ry, at.z());
    const std::size_t ring = ring_of(*map_, ix, iy), kind = class_of(theirs);
    ++counts_.route[ring][static_cast<std::size_t>(mine.kind)][kind];
    const auto low = static_cast<float>(at.z());
    if (mine.kind == CellClass::ground && kind == 2 && mine.measured && theirs->measured) {
      ++counts_.heights;
      counts_.heights_off += std::abs(theirs->z - low) > kHeightsApart;
    }
    bool local_around = false, route_around = false;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        local_around |= quarters(*map_, ix + 2 * dx, iy + 2 * dy).blocked;
        route_around |= is_blocked(map.cell(rx + dx, ry + dy, at.z()));
      }
    counts_.local_blocked[ring] += mine.blocked;
    counts_.route_blocked[ring] += is_blocked(theirs);
    if (mine.blocked && !route_around) {
      ++counts_.only_local[ring];
      std::size_t why = 5;
      if (mine.kind == CellClass::drop)
        why = 3;
      else if (mine.kind == CellClass::step || mine.kind == CellClass::slope)
        why = 4;
      else if (kind < 2)
        why = 2;
      else if (theirs->z > low + step_)
        why = 0;
      else if (theirs->evidence > 0)
        why = 1;
      ++counts_.why_local[why];
    }
    if (is_blocked(theirs) && !local_around) {
      ++counts_.only_route[ring];
      std::size_t why = 0;
      if (mine.kind != CellClass::unknown) why = mine.fresh ? 1 : 2;
      if (why == 1 && theirs->z - low > step_) why = 3;
      ++counts_.why_route[why];
    }
  });
}

std::string tables_of(const std::string& name, const Counts& c) {
  const auto percent = [](std::uint64_t part, std::uint64_t all) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(1, all));
  };
  std::string out = fmt::format(
      "\n## {}\n\n{} scans.\n"
      "Ground that both measured: {}, of it more than {:.0f} cm apart: {:.1f} %.\n"
      "Places of the monitor within 2 m: {}, without an impassable cell beside them: {:.1f} %. Obstacles "
      "within 2 m: {}, without a place of the monitor beside them: {:.1f} %.\n",
      name, c.scans, c.heights, 100.0 * double{kHeightsApart}, percent(c.heights_off, c.heights), c.near,
      percent(c.only_near, c.near), c.near_local, percent(c.not_near, c.near_local));
  out +=
      "\n| m | local | of these only local | routes | of these only routes |\n| --- | --- | --- | --- | --- "
      "|\n";
  for (std::size_t ring = 0; ring < kRings.size(); ++ring)
    out += fmt::format("| up to {} | {} | {} | {} | {} |\n", kRings[ring], c.local_blocked[ring],
                       c.only_local[ring], c.route_blocked[ring], c.only_route[ring]);
  out += "\nonly local:";
  for (std::size_t n = 0; n < kOnlyLocal.size(); ++n)
    out += fmt::format(" {} {},", kOnlyLocal[n], c.why_local[n]);
  out += "\nonly routes:";
  for (std::size_t n = 0; n < kOnlyRoute.size(); ++n)
    out += fmt::format(" {} {},", kOnlyRoute[n], c.why_route[n]);
  out += "\n\n| local \\ routes |";
  for (const char* name_of : kRouteClasses) out += fmt::format(" {} |", name_of);
  out += "\n| --- | --- | --- | --- | --- | --- |\n";
  for (std::size_t kind = 0; kind < nav::kCellClasses; ++kind) {
    out += fmt::format("| {} |", nav::kCellClassNames[kind]);
    for (std::size_t theirs = 0; theirs < kRouteClasses.size(); ++theirs) {
      std::uint64_t sum = 0;
      for (const auto& ring : c.route) sum += ring[kind][theirs];
      out += fmt::format(" {} |", sum);
    }
    out += "\n";
  }
  return out;
}

}  // namespace adit::bench
