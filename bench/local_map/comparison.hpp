// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "nav/local_navigation.hpp"
#include "nav/monitor/obstacle_detector.hpp"
#include "nav/routing/route_planner.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/router.hpp"

namespace adit::bench {

/// Distances from the robot for which cells are counted apart, m.
inline constexpr std::array kRings{1.0f, 2.0f, 3.0f, 4.4f};
/// What the map of the routes has at a place: no tile or an unknown cell; the height before an obstacle;
/// ground; an obstacle; the edge of missing ground.
inline constexpr std::array<const char*, 5> kRouteClasses{"unknown", "guessed", "ground", "obstacle", "hole"};
/// Why a place is impassable in the local map alone.
inline constexpr std::array<const char*, 6> kOnlyLocal{"higher ground", "one hit",       "not known",
                                                       "drop",          "step or slope", "other"};
/// Why a place is blocked in the map of the routes alone.
inline constexpr std::array<const char*, 4> kOnlyRoute{"remembered", "seen to be free", "free a while ago",
                                                       "low in the local map"};

/// Counts of cells of 0.1 m, summed over scans.
struct Counts {
  std::uint64_t scans{};
  /// By ring, class of the local map and class of the map of the routes.
  std::array<std::array<std::array<std::uint64_t, kRouteClasses.size()>, nav::kCellClasses>, kRings.size()>
      route{};
  /// Impassable in one map, and passable there and in all cells around it in the other, by ring.
  std::array<std::uint64_t, kRings.size()> only_local{}, only_route{}, local_blocked{}, route_blocked{};
  std::array<std::uint64_t, kOnlyLocal.size()> why_local{};
  std::array<std::uint64_t, kOnlyRoute.size()> why_route{};
  std::uint64_t heights{}, heights_off{};  ///< Ground that both measured; more than 5 cm apart.
  /// Places of the collision monitor within 2 m, and those without an impassable cell of the local map within
  /// 0.1 m; impassable cells within 2 m, and those without a place of the monitor within 0.15 m.
  std::uint64_t near{}, only_near{}, near_local{}, not_near{};

  void operator+=(const Counts& other);
};

/// The maps of one robot in a rehearsal, compared with its local map. Calls must not overlap.
class Comparison {
 public:
  explicit Comparison(const Platform& platform);

  /// After a scan entered the local map.
  void look(const agent::PlanJob& job, const nav::LocalNavigation& local);
  /// After a scan entered the map of the routes.
  void look(const agent::RouteJob& job, const nav::RoutePlanner& planner);
  const Counts& counts() const { return counts_; }

 private:
  void compare_near(const agent::PlanJob& job);

  nav::ObstacleDetector detector_;
  float step_;  ///< m
  std::shared_ptr<const nav::LocalMap> map_{};
  std::uint64_t route_scans_{};
  Counts counts_{};
};

/// The tables of a comparison, in Markdown.
std::string tables_of(const std::string& name, const Counts& counts);

}  // namespace adit::bench
