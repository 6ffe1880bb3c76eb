// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/json.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/model/json_fields.hpp"

namespace adit::station {

using nlohmann::json;

namespace {

Error malformed(const char* what, const std::string& key) {
  return {Reason::malformed, std::string(what) + " '" + key + "' does not fit"};
}

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

json json_of(const Counts& counts) {
  return {{"sent", counts.sent},
          {"repeats", counts.repeats},
          {"accepted", counts.accepted},
          {"refused", counts.refused},
          {"unanswered", counts.unanswered}};
}

json json_of(const Notice& notice) {
  return {{"id", notice.id},
          {"age", notice.age},
          {"robot", notice.robot},
          {"operator", notice.operator_name},
          {"level", to_string(notice.level)},
          {"code", notice.code},
          {"reason", name(notice.reason)},
          {"text", notice.text},
          {"mine", notice.mine}};
}

json json_of(const StationSummary& station) {
  json out{{"station", station.name}, {"self", station.self}, {"age", station.age}, {"lost", station.lost}};
  if (station.place) out["place"] = *station.place;
  return out;
}

json json_of(const AgentRate& rate) { return {{"out", rate.out}, {"in", rate.in}, {"age", rate.age}}; }

json json_of(const World& world) {
  json out{{"at", world.at},
           {"station", world.station},
           {"link", world.link},
           {"commands", json_of(world.commands)}};
  out["robots"] = out["stations"] = out["notices"] = json::array();
  for (const Robot& robot : world.robots) out["robots"].push_back(json_of(robot));
  for (const StationSummary& station : world.stations) out["stations"].push_back(json_of(station));
  for (const Notice& notice : world.notices) out["notices"].push_back(json_of(notice));
  out["traffic"] = json::object();
  for (const auto& [agent, rate] : world.traffic) out["traffic"][agent] = json_of(rate);
  return out;
}

json json_of(const CommandEvent& event) {
  json out{{"event", "command"},
           {"id", event.id},
           {"line", event.line},
           {"phase", event.ended ? "ended" : "begun"},
           {"query", event.query},
           {"mine", event.mine},
           {"by", {{"front_end", event.front_end}, {"pid", event.pid}}}};
  if (!event.ended) return out;
  out["exit"] = event.exit_code;
  out["text"] = event.text;
  out["error"] = event.error;
  return out;
}

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

void read_fields(JsonReader& in, Counts& counts) {
  in.read("sent", counts.sent);
  in.read("repeats", counts.repeats);
  in.read("accepted", counts.accepted);
  in.read("refused", counts.refused);
  in.read("unanswered", counts.unanswered);
}

void read_fields(JsonReader& in, Notice& notice) {
  in.read("id", notice.id);
  in.read("age", notice.age);
  in.read("robot", notice.robot);
  in.read("operator", notice.operator_name);
  in.read_word("level", notice.level, Level::error, [](Level l) { return to_string(l); });
  in.read("code", notice.code);
  in.read("reason", notice.reason);
  in.read("text", notice.text);
  in.read("mine", notice.mine);
}

void read_fields(JsonReader& in, StationSummary& station) {
  in.read("station", station.name);
  in.read("self", station.self);
  in.read("age", station.age);
  in.read("lost", station.lost);
  in.read("place", station.place);
}

void read_fields(JsonReader& in, AgentRate& rate) {
  in.read("out", rate.out);
  in.read("in", rate.in);
  in.read("age", rate.age);
}

void read_fields(JsonReader& in, RobotAnswer& answer) {
  in.read("robot", answer.robot);
  in.read("accepted", answer.accepted);
  in.read("answered", answer.answered);
  in.read("reason", answer.reason);
  in.read("text", answer.text);
  in.read("holder", answer.holder);
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

void read_fields(JsonReader& in, MapTile& tile) {
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

Result<Notice> notice_from(const json& object) { return value_from<Notice>(object, "a notice's"); }

Result<World> world_from(const json& object) {
  World world;
  std::string wrong;
  JsonReader in(object, wrong);
  in.read("at", world.at);
  in.read("station", world.station);
  in.read("link", world.link);
  in.read("commands", world.commands);
  std::optional<Error> inner;
  in.each("robots", [&](const json& row) {
    auto robot = robot_from(row);
    if (!robot) return inner = robot.error(), false;
    world.robots.push_back(std::move(*robot));
    return true;
  });
  in.read("stations", world.stations);
  in.each("notices", [&](const json& row) {
    auto notice = notice_from(row);
    if (!notice) return inner = notice.error(), false;
    world.notices.push_back(std::move(*notice));
    return true;
  });
  in.read("traffic", world.traffic);
  if (inner) return *inner;
  if (!wrong.empty()) return malformed("a snapshot's", wrong);
  return world;
}

Result<CommandEvent> event_from(const json& object) {
  CommandEvent event;
  std::string wrong, phase;
  JsonReader in(object, wrong);
  in.read("id", event.id);
  in.read("phase", phase);
  event.ended = phase == "ended";
  in.read("line", event.line);
  in.read("query", event.query);
  in.read("mine", event.mine);
  if (in.has("by")) {
    JsonReader by(object.at("by"), wrong);
    by.read("front_end", event.front_end);
    by.read("pid", event.pid);
  }
  in.read("exit", event.exit_code);
  in.read("text", event.text);
  in.read("error", event.error);
  if (!wrong.empty()) return malformed("a command event's", wrong);
  return event;
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
  if (!wrong.empty()) return malformed("an outcome's", wrong);
  return outcome;
}

Result<MapUpdate> map_update_from(const json& object) {
  MapUpdate update;
  std::string wrong;
  JsonReader in(object, wrong);
  in.read("resolution", update.resolution);
  in.read("revision", update.revision);
  in.read("run", update.run);
  in.read("clock", update.clock);
  in.read("tiles", update.tiles);
  if (!(update.resolution >= 0.01 && update.resolution <= 10.0)) in.refuse("resolution");
  if (!wrong.empty()) return malformed("a map update's", wrong);
  return update;
}

}  // namespace adit::station
