// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/json.hpp"

#include <algorithm>

#include "basestation/model/json_fields.hpp"

namespace adit::station {

using nlohmann::json;

void fields(JsonReader& in, MapTile& tile);
void fields(JsonReader& in, MapUpdate& update);

namespace {

/// Cells as runs: value, count, value, count, ...
constexpr int kLowestVoxel = 32768;  // Added, as the numbers of a list have no sign.

template <class Value>
json runs_json(const std::vector<Value>& cells) {
  json runs = json::array();
  for (std::size_t i = 0; i < cells.size();) {
    const auto end = std::find_if(cells.begin() + static_cast<std::ptrdiff_t>(i), cells.end(),
                                  [&](Value cell) { return cell != cells[i]; });
    const auto next = static_cast<std::size_t>(end - cells.begin());
    runs.push_back(cells[i]);
    runs.push_back(next - i);
    i = next;
  }
  return runs;
}

/// For each run the cells since the run before, its lowest voxel and its length.
json columns_json(const std::vector<VoxelRun>& runs) {
  json columns = json::array();
  int cell = 0;
  for (const VoxelRun& run : runs) {
    columns.push_back(run.cell - cell);
    columns.push_back(run.z + kLowestVoxel);
    columns.push_back(run.length);
    cell = run.cell;
  }
  return columns;
}

}  // namespace

std::string line_of(const json& value) { return value.dump(-1, ' ', true, json::error_handler_t::replace); }

json json_of(const MapUpdate& update) {
  json tiles = json::array();
  for (const MapTile& tile : update.tiles)
    tiles.push_back({{"x", tile.x},
                     {"y", tile.y},
                     {"revision", tile.revision},
                     {"cells", runs_json(tile.cells)},
                     {"columns", columns_json(tile.runs)},
                     {"received", runs_json(tile.received)}});
  return {{"resolution", update.resolution},
          {"revision", update.revision},
          {"run", update.run},
          {"clock", update.clock},
          {"tiles", tiles}};
}

json outcome_json(int exit_code, const std::string& text, const std::string& error, const json& script) {
  return {{"exit", exit_code}, {"text", text}, {"error", error}, {"json", script}};
}

/// The times of a tile; those of a station of an earlier release are missing.
void read_received(JsonReader& in, MapTile& tile) {
  constexpr std::size_t regions = std::size_t{MapTile::kRegions} * MapTile::kRegions;
  std::vector<std::uint32_t> runs;
  in.read("received", runs);
  if (runs.size() % 2 != 0) return in.refuse("received");
  for (std::size_t i = 0; i < runs.size(); i += 2) {
    if (runs[i + 1] > regions - tile.received.size()) return in.refuse("received");
    tile.received.insert(tile.received.end(), runs[i + 1], runs[i]);
  }
  if (!tile.received.empty() && tile.received.size() != regions) in.refuse("received");
}

void fields(JsonReader& in, MapTile& tile) {
  constexpr std::size_t cells = std::size_t{MapTile::kSide} * MapTile::kSide;
  in.read("x", tile.x);
  in.read("y", tile.y);
  in.read("revision", tile.revision);
  std::vector<std::uint32_t> runs;
  in.read("cells", runs);
  if (runs.size() % 2 != 0) return in.refuse("cells");
  tile.cells.reserve(cells);
  for (std::size_t i = 0; i < runs.size(); i += 2) {
    if (runs[i] > 255 || runs[i + 1] > cells - tile.cells.size()) return in.refuse("cells");
    tile.cells.insert(tile.cells.end(), runs[i + 1], static_cast<std::uint8_t>(runs[i]));
  }
  if (tile.cells.size() != cells) in.refuse("cells");
  read_received(in, tile);
  std::vector<std::uint32_t> columns;
  in.read("columns", columns);
  if (columns.size() % 3 != 0 || columns.size() > 3 * MapTile::kMaxRuns) return in.refuse("columns");
  std::size_t cell = 0;
  for (std::size_t i = 0; i < columns.size(); i += 3) {
    const std::uint32_t skip = columns[i], z = columns[i + 1], length = columns[i + 2];
    if (skip >= cells - cell || z > 65535 || length < 1 || length > 65535) return in.refuse("columns");
    cell += skip;
    tile.runs.push_back({static_cast<std::uint16_t>(cell),
                         static_cast<std::int16_t>(static_cast<int>(z) - kLowestVoxel),
                         static_cast<std::uint16_t>(length)});
  }
}

void fields(JsonReader& in, MapUpdate& update) {
  in.read("resolution", update.resolution);
  in.read("revision", update.revision);
  in.read("run", update.run);
  in.read("clock", update.clock);
  in.read("tiles", update.tiles);
  if (!(update.resolution >= 0.01 && update.resolution <= 10.0)) in.refuse("resolution");
}

Result<Notice> notice_from(const json& object) { return value_from<Notice>(object, "a notice's"); }

Result<World> world_from(const json& object) { return value_from<World>(object, "a snapshot's"); }
Result<Robot> robot_from(const json& object) { return value_from<Robot>(object, "a robot's"); }
Result<CommandEvent> event_from(const json& object) {
  return value_from<CommandEvent>(object, "a command event's");
}

Result<CommandOutcome> outcome_from(const json& object) {
  CommandOutcome outcome;
  std::string wrong;
  JsonReader in(object, wrong);
  if (!in.has("exit")) in.refuse("exit");
  in.read("exit", outcome.exit_code);
  in.read("text", outcome.text);
  in.read("error", outcome.error);
  if (in.has("json") && object.at("json").is_object()) {
    const json& script = object.at("json");
    outcome.json = line_of(script);
    // Queries have rows of other kinds under this key: they are no answers of robots.
    if (const auto rows = script.find("results"); rows != script.end() && rows->is_array())
      for (const json& row : *rows) {
        RobotAnswer answer;
        if (row.is_object() && row.contains("accepted") && JsonReader::take(row, answer))
          outcome.answers.push_back(std::move(answer));
      }
  }
  if (!wrong.empty()) return {Reason::malformed, "an outcome's '" + wrong + "' does not fit"};
  return outcome;
}

Result<MapUpdate> map_update_from(const json& object) {
  return value_from<MapUpdate>(object, "a map update's");
}

}  // namespace adit::station
