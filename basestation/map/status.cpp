// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/status.hpp"

#include "basestation/report/table.hpp"

namespace adit::station {
namespace {

std::size_t waiting_for_pose(const ChunkStore::Robot& robot) {
  std::size_t out = 0;
  for (const auto& [key, submap] : robot.submaps) out += submap.T_map_submap ? 0 : 1;
  return out;
}

/// Share of the robot's map that is here in its newest state, at least, [0, 1]: `waiting` is that of the
/// station which lacks most.
double share(const ChunkStore::Robot& robot) {
  const auto here = static_cast<double>(robot.blocks);
  return here > 0.0 ? here / (here + static_cast<double>(robot.waiting)) : 0.0;
}

}  // namespace

std::string map_status_text(const MapReceiver& map, Time now) {
  const ChunkStore& chunks = map.chunks();
  if (chunks.robots().empty()) return "no map has been received; robots send one with perception: slam\n";
  std::vector<std::vector<std::string>> rows{
      {"ROBOT", "SHARE", "M2", "SUBMAPS", "BLOCKS", "KB", "B/M2", "AGE", "WAITING"}};
  for (const auto& [name, robot] : chunks.robots()) {
    const double area = chunks.area(name);
    rows.push_back({name, robot.heard ? fixed(100.0 * share(robot), 0) + " %" : "-", fixed(area, 0),
                    std::to_string(robot.submaps.size()), std::to_string(robot.blocks),
                    fixed(static_cast<double>(robot.bytes) / 1000.0, 1),
                    area > 0.0 ? fixed(static_cast<double>(robot.bytes) / area, 1) : "-",
                    robot.heard ? short_age(seconds(now - *robot.heard)) : "-",
                    std::to_string(robot.waiting)});
  }
  std::string out = table(rows);
  for (const auto& [name, robot] : chunks.robots())
    if (const std::size_t missing = waiting_for_pose(robot); missing > 0)
      out += name + ": the place of " + std::to_string(missing) + " submaps has not arrived yet\n";
  out += "all: " + fixed(chunks.area(), 0) + " m2";
  if (map.refused() > 0) out += ", " + std::to_string(map.refused()) + " pieces refused";
  if (chunks.refused() > 0) out += ", " + std::to_string(chunks.refused()) + " parts without room";
  return out + "\n";
}

nlohmann::json map_status_json(const MapReceiver& map, Time now) {
  const ChunkStore& chunks = map.chunks();
  nlohmann::json robots = nlohmann::json::array();
  for (const auto& [name, robot] : chunks.robots())
    robots.push_back({{"robot", name},
                      {"share", share(robot)},
                      {"m2", chunks.area(name)},
                      {"submaps", robot.submaps.size()},
                      {"submaps_without_pose", waiting_for_pose(robot)},
                      {"blocks", robot.blocks},
                      {"bytes", robot.bytes},
                      {"pieces", robot.pieces},
                      {"age", robot.heard ? nlohmann::json(seconds(now - *robot.heard)) : nlohmann::json()},
                      {"waiting", robot.waiting}});
  return {{"robots", robots},
          {"m2", chunks.area()},
          {"refused_pieces", map.refused()},
          {"refused_parts", chunks.refused()}};
}

}  // namespace adit::station
