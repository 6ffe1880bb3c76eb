// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/status.hpp"

#include <set>

#include "basestation/map/ground_area.hpp"
#include "basestation/report/table.hpp"

namespace adit::station {
namespace {

std::size_t waiting_for_pose(const ChunkStore::RobotMap& robot) {
  std::size_t out = 0;
  for (const auto& [key, submap] : robot.submaps) out += submap.T_map_submap ? 0 : 1;
  return out;
}

/// The robots of this name that made the map.
std::set<std::uint32_t> owners_of(const ChunkStore::RobotMap& robot) {
  std::set<std::uint32_t> out;
  for (const auto& [key, submap] : robot.submaps)
    if (const std::uint32_t owner = perception::owner_of(key.start); owner != 0) out.insert(owner);
  return out;
}

/// Share of the robot's map that is here in its newest state, at least, [0, 1]: `waiting` is that of the
/// station which lacks most.
double share(const ChunkStore::RobotMap& robot) {
  const auto here = static_cast<double>(robot.blocks);
  return here > 0.0 ? here / (here + static_cast<double>(robot.waiting)) : 0.0;
}

/// Who carried parts of this robot's map here; empty: no robot did.
std::string carried_text(const std::string& name, const ChunkStore::RobotMap& robot, Time now) {
  std::string by;
  for (const auto& [carrier, carried] : robot.carriers)
    by += (by.empty() ? "" : ", ") + carrier +
          (carried.heard ? " (" + short_age(seconds(now - *carried.heard)) + " ago)" : "");
  if (by.empty()) return {};
  return name + ": carried by " + by + "; " + std::to_string(robot.carried_blocks) + " of " +
         std::to_string(robot.blocks) + " blocks came so\n";
}

nlohmann::json carried_json(const ChunkStore::RobotMap& robot, Time now) {
  nlohmann::json out = nlohmann::json::array();
  for (const auto& [carrier, carried] : robot.carriers)
    out.push_back(
        {{"by", carrier},
         {"bytes", carried.bytes},
         {"pieces", carried.pieces},
         {"parts", carried.parts},
         {"age", carried.heard ? nlohmann::json(seconds(now - *carried.heard)) : nlohmann::json()}});
  return out;
}

}  // namespace

std::string map_status_text(const MapReceiver& map, Time now) {
  const ChunkStore& chunks = map.chunks();
  if (chunks.robots().empty()) return "no map has been received; robots send one with perception: slam\n";
  std::vector<std::vector<std::string>> rows{
      {"ROBOT", "SHARE", "M2", "SUBMAPS", "BLOCKS", "KB", "B/M2", "AGE", "WAITING"}};
  for (const auto& [name, robot] : chunks.robots()) {
    const double area = ground_area(chunks, now, name).m2;
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
  for (const auto& [name, robot] : chunks.robots()) out += carried_text(name, robot, now);
  for (const auto& [name, robot] : chunks.robots())
    if (const std::size_t owners = owners_of(robot).size(); owners > 1)
      out += name + ": maps of " + std::to_string(owners) +
             " robots of this name; the newest is that of the one heard last\n";
  const GroundArea all = ground_area(chunks, now);
  out += "all: " + fixed(all.m2, 0) + " m2, received within 10 s: " + fixed(100.0 * all.within_10s, 0) +
         " %, 1 min: " + fixed(100.0 * all.within_1min, 0) +
         " %, 10 min: " + fixed(100.0 * all.within_10min, 0) +
         " %, before the station's start: " + fixed(100.0 * all.unknown, 0) + " %";
  if (map.refused() > 0) out += ", " + std::to_string(map.refused()) + " pieces refused";
  if (chunks.refused() > 0) out += ", " + std::to_string(chunks.refused()) + " parts without room";
  if (chunks.refused_carried() > 0)
    out += ", " + std::to_string(chunks.refused_carried()) + " carried parts refused";
  return out + "\n";
}

nlohmann::json map_status_json(const MapReceiver& map, Time now) {
  const ChunkStore& chunks = map.chunks();
  nlohmann::json robots = nlohmann::json::array();
  for (const auto& [name, robot] : chunks.robots())
    robots.push_back({{"robot", name},
                      {"share", share(robot)},
                      {"m2", ground_area(chunks, now, name).m2},
                      {"submaps", robot.submaps.size()},
                      {"submaps_without_pose", waiting_for_pose(robot)},
                      {"owners", owners_of(robot).size()},
                      {"blocks", robot.blocks},
                      {"bytes", robot.bytes},
                      {"pieces", robot.pieces},
                      {"age", robot.heard ? nlohmann::json(seconds(now - *robot.heard)) : nlohmann::json()},
                      {"waiting", robot.waiting},
                      {"carried_blocks", robot.carried_blocks},
                      {"carried", carried_json(robot, now)}});
  const GroundArea all = ground_area(chunks, now);
  return {{"robots", robots},
          {"m2", all.m2},
          {"share_by_age",
           {{"within_10s", all.within_10s},
            {"within_1min", all.within_1min},
            {"within_10min", all.within_10min},
            {"unknown", all.unknown}}},
          {"refused_pieces", map.refused()},
          {"refused_parts", chunks.refused()},
          {"refused_carried_parts", chunks.refused_carried()}};
}

}  // namespace adit::station
