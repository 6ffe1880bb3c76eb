// SPDX-License-Identifier: Apache-2.0
// What a station could send to a front end, as libFuzzer makes it up: hello, worlds, deltas, notices,
// pieces of the map, answers, and reports. Built by tools/fuzz.sh. The first byte chooses the reader.
#include <sys/socket.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "basestation/client/connection.hpp"
#include "basestation/client/options.hpp"
#include "basestation/model/action.hpp"
#include "basestation/model/delta.hpp"
#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/stairs.hpp"
#include "tests/gui/fixture.hpp"

namespace {

using namespace adit;
using namespace adit::station;

constexpr std::size_t kMaxInput = 60000;  // It fits into the socket's buffer at once.

void check(bool holds) {
  if (!holds) std::abort();
}

void check_world(const World& world) {
  for (const Robot& robot : world.robots) (void)actions({&robot});
  (void)line_of(json_of(world));  // A front end shows it, and exports it.
}

void read_as_connection(const char* data, std::size_t size) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends) != 0) return;
  client::File station(ends[1]);
  client::Connection connection(client::LineSocket(client::File(ends[0])), "fuzz");
  TileMap map;
  connection.on_world = check_world;
  connection.on_notice = [](const Notice& notice) { (void)line_of(json_of(notice)); };
  connection.on_command = [](const CommandEvent& event) { (void)line_of(json_of(event)); };
  connection.on_map = [&](MapUpdate update, bool) {
    for (const MapTile& tile : update.tiles) {
      check(tile.cells.size() == std::size_t{MapTile::kSide} * MapTile::kSide);
      check(tile.runs.size() <= MapTile::kMaxRuns);
      for (const VoxelRun& run : tile.runs) check(run.cell < tile.cells.size() && run.length > 0);
    }
    map = updated(map, std::move(update));
  };
  connection.on_hello = [](const client::StationOptions& options) { (void)options.name.size(); };
  connection.on_outcome = [](std::int64_t, const CommandOutcome& outcome) { (void)outcome.answers.size(); };
  connection.follow();
  connection.notices();
  const auto sent = ::send(station.get(), data, size, MSG_NOSIGNAL);
  station.reset();
  if (sent < 0) return;
  for (int i = 0; i < 100 && connection.wait(0); ++i) {
  }
  (void)connection.gone();
}

void read_as_report(const std::string& text) {
  const CommandOutcome outcome{.json = text};
  if (const auto health = health_of(outcome)) (void)line_of(json_of(*health));
  if (const auto network = network_of(outcome)) (void)line_of(json_of(*network));
  if (const auto found = findings_of(outcome)) (void)line_of(json_of(*found));
  if (const auto stairs = stairs_of(outcome)) (void)line_of(json_of(*stairs));
}

/// Messages of a real station, from which libFuzzer goes on.
void write_seeds(const std::string& folder) {
  int number = 0;
  const auto write = [&](char reader, const std::string& text) {
    std::ofstream(folder + "/seed_" + std::to_string(number++)) << reader << text;
  };
  const World world = gui::ten_robots();
  const std::string complete = line_of({{"world", json_of(world)}}) + "\n";
  World later = world;
  later.at += 1.0;
  later.robots[0].x = 3.0F;
  later.robots.pop_back();
  later.notices.push_back({{.code = "idle", .robot = "r2"}, 4});
  write('c', line_of({{"world", json_of(world)}}) + "\n");
  write('c', complete);
  write('c', complete + line_of({{"delta", difference(encoded(world), encoded(later)).json}}) + "\n");
  write('c', R"({"hello":{"station":"op1","domain":77,"link":"mesh_500k","interfaces":["lo"],"peers":[]}})"
             "\n");
  write('c', line_of({{"notice", json_of(Notice{{.code = "blocked", .text = "every", .robot = "r1"}, 3})}}) +
                 "\n");
  write('c', R"({"id":1,"begun":true})"
             "\n"
             R"({"id":1,"exit":0,"text":"r1: done\n","error":"","answers":[{"robot":"r1","accepted":true}]})"
             "\n");
  MapUpdate update;
  const TileMap corridors = gui::corridors();
  update.revision = corridors.revision;
  update.resolution = corridors.resolution;
  update.tiles.push_back(*corridors.tiles.begin()->second);
  for (std::size_t i = 4096; i < update.tiles[0].cells.size(); ++i)  // Small enough for one input.
    update.tiles[0].cells[i] = MapTile::kUnknown;
  update.tiles[0].runs.resize(64);
  const std::string tiles = line_of({{"id", 1}, {"map", json_of(update)}, {"more", false}}) + "\n";
  if (tiles.size() < kMaxInput) write('c', tiles);
  write('r', line_of(json_of(HealthReport{})));
  write('r', line_of(json_of(NetworkReport{})));
  write('r', line_of(json_of(FoundReport{.findings = {{.number = 1, .robot = "r1", .kind = "person"}}})));
  const Staircase flight{.rise = 0.2, .run = 0.3, .width = 1.2, .steps = 6};
  write('r', line_of(json_of(StairsReport{.stairs = {{.number = 1, .stairs = flight, .findings = {1}}}})));
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (const char* folder = std::getenv("ADIT_FUZZ_SEEDS")) write_seeds(folder);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 1 || size > kMaxInput) return 0;
  const char* data = reinterpret_cast<const char*>(bytes);
  if (data[0] == 'r')
    read_as_report(std::string(data + 1, size - 1));
  else
    read_as_connection(data + 1, size - 1);
  return 0;
}
