// SPDX-License-Identifier: Apache-2.0
// navtool: routes over maps, local plans over recorded clouds, controllers along a path.
#include <CLI/CLI.hpp>

#include "core/config/usage.hpp"
#include "sim/navtool/commands.hpp"

int main(int argc, char** argv) {
  using namespace adit::sim::navtool;
  CLI::App app{"Navigation without a robot.", "navtool"};
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  navtool route --map geb079.bt --from 0 0 0 --to 20 -0.4 0 --picture route.png\n"
      "  navtool plan --clouds clouds/ --goal 10 0.5 --platform tracked --json\n"
      "  navtool terrain --cloud street/ --platform wheeled --json\n"
      "  navtool track --platform wheeled --picture track.png\n"
      "Exit status: 0 done, 1 there is no way or a controller did not arrive, 2 wrong usage or unreadable "
      "input.");

  const CLI::Validator place = adit::config::between(-1e4, 1e4);
  RouteOptions route_options;
  std::vector<double> from, to, goal;
  CLI::App* routes = app.add_subcommand("route", "the way over a map from one place to another");
  routes->footer("Example: navtool route --map geb079.bt --from 0 0 0 --to 20 -0.4 0 --json");
  routes->add_option("--map", route_options.map, "OctoMap file (.bt), or its name on the search path")
      ->required();
  routes->add_option("--from", from, "X Y Z, m")->required()->expected(3)->check(place);
  routes->add_option("--to", to, "X Y Z, m")->required()->expected(3)->check(place);
  routes->add_option("--platform", route_options.platform, "its name, or a YAML file")->capture_default_str();
  routes->add_flag("--json", route_options.json, "one JSON object");
  routes->add_option("--picture", route_options.picture, "PNG to write");

  PlanOptions plan_options;
  CLI::App* plans =
      app.add_subcommand("plan", "terrain and local plan for each cloud of a folder, in name order");
  plans->footer(
      "Each cloud is one cycle, 0.1 s after the one before; VIEWPOINT (of a .pcd) is where its sensor was. "
      "With "
      "--json one\n"
      "line a cycle: {\"cycle\":0,\"terrain_ms\":..,\"plan_ms\":..,\"blocked\":false,\"path\":[[x,y],..]}, "
      "thread CPU\n"
      "milliseconds, path in the frame of VIEWPOINT.\n"
      "Example: navtool plan --clouds clouds/ --goal 10 0.5 --json");
  plans->add_option("--clouds", plan_options.clouds, "folder of clouds")->required();
  plans->add_option("--goal", goal, "X Y, m, in the frame of VIEWPOINT")
      ->required()
      ->expected(2)
      ->check(place);
  plans->add_option("--platform", plan_options.platform, "its name, or a YAML file")->capture_default_str();
  plans
      ->add_option("--frame", plan_options.frame,
                   "of the points: sensor, map, or auto (by where the ground is)")
      ->capture_default_str()
      ->check(CLI::IsMember({"sensor", "map", "auto"}));
  plans->add_flag("--json", plan_options.json, "one JSON line a cycle");
  plans->add_option("--picture", plan_options.picture, "PNG of the last cycle to write");

  TerrainOptions terrain_options;
  CLI::App* terrains = app.add_subcommand("terrain", "what the ground is to a platform, from clouds");
  terrains->footer(
      "Clouds are .pcd, .ply or KITTI's .bin, in the lidar's frame; those of a folder are accumulated in "
      "name "
      "order, 0.1 s\n"
      "apart. A cell within the range of a pose of which nothing is known counts as unknown. With --json one "
      "object:\n"
      "{\"m2\":{\"ground\":..,\"step\":..,\"slope\":..,\"obstacle\":..,\"drop\":..,\"unknown\":..},\"cells\":"
      "{..},..}\n"
      "Example: navtool terrain --cloud street/ --poses street.tum --sensor hdl64.yaml --platform wheeled "
      "--json");
  terrains->add_option("--cloud", terrain_options.cloud, "file, or folder of files")->required();
  terrains->add_option("--poses", terrain_options.poses,
                       "of base_link, one for each cloud, TUM; without them the robot is stationary");
  terrains->add_option("--sensor", terrain_options.sensor,
                       "YAML file with the sensors: part of a platform's; without it the platform's own");
  terrains->add_option("--platform", terrain_options.platform, "its name, or a YAML file")
      ->capture_default_str();
  terrains->add_option("--range", terrain_options.range, "of each cloud, m")
      ->capture_default_str()
      ->check(adit::config::between(0.5, 100.0));
  terrains->add_flag("--json", terrain_options.json, "one JSON object");
  terrains->add_option("--picture", terrain_options.picture, "PNG to write");

  TrackOptions track_options;
  CLI::App* tracks = app.add_subcommand("track", "every controller along a path: how far it strays");
  tracks->footer("Example: navtool track --path path.txt --platform legged --json");
  tracks->add_option("--path", track_options.path, "file of lines x y, m; without it a wave with a corner");
  tracks->add_option("--platform", track_options.platform, "its name, or a YAML file")->capture_default_str();
  tracks->add_flag("--json", track_options.json, "one JSON line a controller");
  tracks->add_option("--picture", track_options.picture, "PNG to write");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return adit::config::end_usage(app, error);
  }
  if (*routes) {
    route_options.from = {from[0], from[1], from[2]};
    route_options.to = {to[0], to[1], to[2]};
    return route(route_options);
  }
  if (*plans) {
    plan_options.goal = {goal[0], goal[1]};
    return plan(plan_options);
  }
  if (*terrains) return terrain(terrain_options);
  return track(track_options);
}
