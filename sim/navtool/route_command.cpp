// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"
#include "sim/navtool/commands.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/navtool/world_route.hpp"
#include "sim/picture/picture.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::navtool {
namespace {

const char* name_of(nav::RouteStatus status) {
  switch (status) {
    case nav::RouteStatus::found:
      return "found";
    case nav::RouteStatus::unreachable:
      return "unreachable";
    case nav::RouteStatus::start_blocked:
      return "start_blocked";
    case nav::RouteStatus::too_far:
      break;
  }
  return "too_far";
}

nlohmann::json json_of(const nav::Route& route, const nav::RoutePlanner& planner, double map_ms,
                       double search_ms) {
  nlohmann::json points = nlohmann::json::array();
  for (const Eigen::Vector3d& p : route.points) points.push_back({p.x(), p.y(), p.z()});
  return {{"status", name_of(route.status)},
          {"length", route.length},
          {"unknown_length", route.unknown_length},
          {"cost", route.cost},
          {"legs", route.unknown.size()},
          {"points", points},
          {"unknown", route.unknown},
          {"map_ms", map_ms},
          {"search_ms", search_ms},
          {"expanded", planner.expanded()},
          {"memory_bytes", planner.memory()}};
}

Result<void> draw(const World& world, const RouteOptions& options, const Platform& platform,
                  const nav::Route& route) {
  PictureSpec spec{.title = "Route of a " + platform.name + " robot", .subtitle = world.name()};
  PictureTrail trail{.id = "route", .label = "route", .length = platform.length, .width = platform.width};
  for (auto p = route.points.rbegin(); p != route.points.rend(); ++p)
    trail.poses.push_back({p->x(), p->y(), 0});
  if (trail.poses.empty()) trail.poses.push_back({options.from.x(), options.from.y(), 0});
  spec.trails.push_back(std::move(trail));
  spec.goals.push_back({"route", options.to.head<2>()});
  return write_picture(world, spec, options.picture);
}

}  // namespace

int route(const RouteOptions& options) {
  const auto platform = config::load_platform(options.platform);
  if (!platform) return report_error("navtool", platform.error());
  std::error_code ignored;
  const bool here = std::filesystem::is_regular_file(options.map, ignored);
  const auto file = here ? Result<std::string>(options.map) : config::find_file(options.map);
  if (!file) return report_error("navtool", file.error());
  const auto world = load_octomap(*file);
  if (!world) return report_error("navtool", world.error());

  // The map is complete: what is unknown in it is no ground.
  nav::RouteParams params;
  params.through_unknown = false;
  nav::RoutePlanner planner(*platform, params);
  const double begin = cpu_ms();
  add_world(*world, *platform, planner);
  const double added = cpu_ms();
  const nav::Route route = planner.plan(options.from, options.to);
  const double searched = cpu_ms();
  if (options.json)
    std::printf("%s\n", json_of(route, planner, added - begin, searched - added).dump().c_str());
  else if (route.found())
    std::printf(
        "%.2f m in %zu legs, %.2f m of it through unknown space; map %.0f ms, search %.2f ms, %.1f MB\n",
        route.length, route.unknown.size(), route.unknown_length, added - begin, searched - added,
        static_cast<double>(planner.memory()) * 1e-6);
  else
    std::printf("no route: %s\n", route.status == nav::RouteStatus::start_blocked
                                      ? "nothing is passable near the start"
                                      : "the goal cannot be reached");
  if (!options.picture.empty())
    if (const auto drawn = draw(*world, options, *platform, route); !drawn)
      return report_error("navtool", drawn.error());
  return route.found() ? 0 : 1;
}

}  // namespace adit::sim::navtool
