// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "basestation/model/map_tiles.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// A robot in hold without a holder that would accept every mode.
inline station::Robot robot(const std::string& name, float x, float y) {
  station::Robot out;
  out.name = name;
  out.age = 0.1;
  out.described = true;
  out.platform = "wheeled";
  out.max_speed = 1.0F;
  out.size = {.length = 0.9F, .width = 0.6F, .height = 0.5F};
  out.located = true;
  out.x = x;
  out.y = y;
  out.battery = 0.82F;
  out.mode = "hold";
  for (const char* mode : {"hold", "manual", "smart_joystick", "waypoint", "explore"})
    out.options.push_back({.mode = mode, .available = true});
  return out;
}

/// A notice that concerns the operator.
inline station::Notice my_notice(std::uint64_t id, const std::string& robot, const std::string& code,
                                 const std::string& text) {
  return {{.code = code, .text = text, .robot = robot}, id, 0.0, true};
}

inline station::Notice blocked_notice() {
  return {{.severity = contract::Severity::warning,
           .code = "blocked",
           .text = "every path is blocked",
           .robot = "r4"},
          0,
          0.0,
          true};
}

inline station::Robot mine(station::Robot out) {
  out.holder = "op1";
  out.mine = true;
  return out;
}

/// Ten robots, each in another state.
inline station::World ten_robots() {
  station::World world{.station = "op1", .link = "mesh_500k"};
  world.stations = {{.name = "op1", .self = true, .place = {{-4.0F, 1.0F, 0.0F}}},
                    {.name = "op2", .age = 0.4, .place = {{27.0F, 3.0F, 0.0F}}}};
  station::Robot r1 = mine(robot("r1", 2, 0));
  r1.mode = "waypoint";
  r1.moving_allowed = true;
  r1.vx = 0.8F;
  r1.goal_state = contract::GoalState::active;
  r1.goal = {9.0, 4.0, 0.0};
  station::Robot r2 = mine(robot("r2", 5, 3));
  r2.platform = "legged";
  r2.stopped = true;
  r2.stops = {"op2"};
  r2.reason = Reason::stopped;
  for (station::ModeOption& option : r2.options)
    if (option.mode != "hold") option = {.mode = option.mode, .reason = Reason::stopped};
  station::Robot r3 = robot("r3", 12, 4);
  r3.platform = "tracked";
  r3.holder = "op2";
  r3.yaw = 2.0F;
  r3.mode = "waypoint";
  r3.moving_allowed = true;
  r3.vx = 0.4F;
  r3.goal_state = contract::GoalState::active;
  r3.goal = {8.0, 8.0, 0.0};
  station::Robot r4 = mine(robot("r4", 16, -2));
  r4.mode = "waypoint";
  r4.goal_state = contract::GoalState::blocked;
  r4.goal = {20.0, -2.0, 0.0};
  r4.reason = Reason::blocked;
  r4.locked = true;
  station::Robot r5 = robot("r5", 20, 6);
  r5.lost = true;
  r5.age = 47;
  r5.platform = "aerial";
  station::Robot r6 = mine(robot("r6", -1, 5));
  r6.mode = "explore";
  r6.reason = Reason::terrain_stale;
  station::Robot r7 = robot("r7", 7, -3);
  r7.sigma = 0.8;
  r7.localisation = Localisation::weak;
  r7.age = 3.2;
  station::Robot r8 = robot("r8", 24, 1);
  r8.holder = "op2";
  r8.locked = true;
  r8.areas = {
      {.name = "shaft", .kind = AreaKind::keep_out, .corners = {{21, -1}, {26, -1}, {26, -4}, {21, -4}}}};
  station::Robot r9 = mine(robot("r9", 10, 0));
  r9.troubles = {"planner hung"};
  station::Robot unknown;
  unknown.name = "rx";
  world.robots = {r1, r2, r3, r4, r5, r6, r7, r8, r9, unknown};
  return world;
}

/// Corridors of a building, cells and voxels of 0.2 m.
inline station::TileMap corridors() {
  station::TileMap map;
  map.revision = 1;
  const auto cell = [](double x, double y) -> std::uint8_t {
    const bool corridor = x > -7 && x < 30 && y > -1.6 && y < 1.6;
    const bool room = x > 3 && x < 22 && y >= 1.6 && y < 9;
    const bool south = x > 5 && x < 26 && y <= -1.6 && y > -5;
    const bool west = x > -3 && x < 1 && y >= 1.6 && y < 7;
    if (!corridor && !room && !south && !west) return station::MapTile::kUnknown;
    const bool door = x > 8 && x < 10;
    if (y > 1.4 && y < 1.7 && !door && !(x > -1.5 && x < 0)) return 12;
    if (y < -1.4 && y > -1.7 && !(x > 15 && x < 17)) return 12;
    if (x < -6.7 || x > 29.7 || y > 8.7 || y < -4.7) return 14;
    if (room && (x < 3.3 || x > 21.7)) return 12;
    if (south && (x < 5.3 || x > 25.7)) return 12;
    if (west && (x < -2.7 || x > 0.7 || y > 6.7)) return 12;
    if (x > 13 && x < 14.5 && y > 5 && y < 6.5) return 4;
    return station::MapTile::kGround;
  };
  for (int tx = -1; tx <= 1; ++tx)
    for (int ty = -1; ty <= 0; ++ty) {
      auto tile = std::make_shared<station::MapTile>();
      constexpr int kSide = station::MapTile::kSide;
      tile->x = tx;
      tile->y = ty;
      tile->cells.resize(static_cast<std::size_t>(kSide) * kSide);
      for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column)
          tile->cells[static_cast<std::size_t>(row * kSide + column)] =
              cell((tx * kSide + column + 0.5) * map.resolution, (ty * kSide + row + 0.5) * map.resolution);
      // The floor below z = 0, what stands on it, and a ceiling at 2.8 m.
      for (std::size_t i = 0; i < tile->cells.size(); ++i) {
        const auto cell_number = static_cast<std::uint16_t>(i);
        if (tile->cells[i] == station::MapTile::kUnknown) continue;
        const int things = tile->cells[i] - station::MapTile::kGround;
        tile->runs.push_back({cell_number, -1, static_cast<std::uint16_t>(1 + things)});
        if (things < 14) tile->runs.push_back({cell_number, 14, 1});
      }
      map.tiles[{tx, ty}] = tile;
    }
  return map;
}

}  // namespace adit::gui
