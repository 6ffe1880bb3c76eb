// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/scenario_file.hpp"

#include <algorithm>

#include "core/command/words.hpp"
#include "core/config/node.hpp"
#include "core/config/search.hpp"
#include "sim/rehearsal/scenario_parts.hpp"
#include "sim/world/generate.hpp"
#include "sim/world/read_file.hpp"

namespace adit::sim {
namespace {

using config::Node;

constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53;

std::filesystem::path find_map(const Node& world, const std::string& key, const std::string& file) {
  const std::string name = world.text(key);
  if (name.empty()) return {};
  auto found = config::find_file(name, file);
  if (!found) {
    // Place of liboctomap-dev's package, for machines without ./run setup.
    const std::filesystem::path package =
        std::filesystem::path("/usr/share/doc/liboctomap-dev/examples/data") / name;
    std::error_code ignored;  // missing: the error below names it
    if (std::filesystem::exists(package, ignored)) return package;
    world.child(key).fail(found.error().reason,
                          found.error().text + "; put it there (./run setup fetches geb079.bt)");
    return {};
  }
  return *found;
}

WorldSpec read_world(const Node& world, const std::string& file) {
  WorldSpec out;
  const int kinds = static_cast<int>(world.has("map")) + world.has("boxes") + world.has("floorplan") +
                    world.has("generate");
  if (world.is_mapping() && kinds != 1)
    world.fail(Reason::missing_key, "expected one of map, boxes, floorplan and generate");
  out.dust = world.number("dust", config::within(0.0, 0.5), 0.0);
  if (world.has("map")) out.map = find_map(world, "map", file);
  if (world.has("floorplan")) {
    out.floor_plan = find_map(world, "floorplan", file);
    out.ceiling = world.number("ceiling", config::positive_up_to(100.0), 3.0);
  }
  if (world.has("generate")) {
    const std::vector<std::string> words(world_kinds().begin(), world_kinds().end());
    const std::string& kind = words[world.choice("generate", words)];
    const bool sized = world.has("size");
    const bool tunnel = kind == "tunnel";
    if (sized && kind != "blocks" && !tunnel)
      world.child("size").fail(Reason::bad_argument, "expected no size: only blocks and tunnel have one");
    const int least = tunnel ? kShortestTunnel : kLeastBlocks, most = tunnel ? kLongestTunnel : kMostBlocks;
    const auto size = static_cast<int>(world.integer("size", least, most, least));
    const auto seed =
        static_cast<std::uint64_t>(world.integer("seed", 0, kMaxSeed, sized && !tunnel ? 0 : 1));
    GeneratedWorld made = !sized   ? generate_world(kind, seed).value()
                          : tunnel ? generate_tunnel(size)
                                   : generate_blocks(size, seed);
    out.boxes = std::move(made.boxes);
    out.ceiling = made.ceiling;
  }
  if (world.has("boxes")) {
    for (const Node& box : world.list("boxes")) {
      const std::vector<double> v = box.as_numbers(6, 6, config::within(-1e4, 1e4));
      if (v.size() != 6) continue;
      if (v[0] >= v[1] || v[2] >= v[3] || v[4] >= v[5])
        box.fail(Reason::bad_argument,
                 "expected [x0, x1, y0, y1, z0, z1], each first smaller than its second");
      out.boxes.push_back({v[0], v[1], v[2], v[3], v[4], v[5]});
    }
    out.floor = world.number("floor", config::within(-1e3, 1e3), 0.0);
    out.ceiling = world.number("ceiling", config::within(-1e3, 1e3), 3.0);
    if (out.ceiling <= out.floor) world.fail(Reason::out_of_range, "expected a ceiling above the floor");
  }
  return out;
}

void read_people(const Node& root, Scenario& out) {
  for (const Node& person : root.list_if("people")) {
    PersonSpec spec;
    for (const Node& place : person.list("path")) {
      const std::vector<double> at = place.as_numbers(2, 2, config::within(-1e5, 1e5));
      if (at.size() == 2) spec.path.emplace_back(at[0], at[1]);
    }
    if (spec.path.size() < 2 || spec.path.size() > 100)
      person.fail(Reason::bad_argument, "expected a path of 2 to 100 places [x, y]");
    spec.speed = person.number("speed", config::positive_up_to(3.0), spec.speed);
    spec.yields = person.flag("yields", spec.yields);
    out.people.push_back(std::move(spec));
  }
  if (out.people.size() > 100) root.child("people").fail(Reason::out_of_range, "expected at most 100 people");
}

}  // namespace

std::string read_name(const config::Node& node, const char* key) {
  const std::string name = node.text(key);
  if (node.has(key) && !command::valid_name(name))
    node.child(key).fail(Reason::bad_argument,
                         "expected 1 to 32 letters, digits, _ or - for " + std::string(key));
  return name;
}

std::string read_robot(const config::Node& node, const char* key, const Scenario& scenario) {
  const std::string id = node.text(key);
  if (node.has(key) && !scenario.robot(id))
    node.child(key).fail(Reason::unknown_robot, "expected one of the scenario's robots, not " + id);
  return id;
}

std::string read_station(const config::Node& node, const char* key, const Scenario& scenario) {
  const std::string id = node.text(key);
  if (node.has(key) && !scenario.station(id))
    node.child(key).fail(Reason::unknown_operator, "expected one of the scenario's basestations, not " + id);
  return id;
}

Duration read_time(const config::Node& node, const char* key, const Scenario& scenario) {
  return from_seconds(node.number(key, config::within(0.0, seconds(scenario.duration))));
}

namespace {

// A line as it was written, without its dash and its comment.
std::string source_line(const std::string& text, int number) {
  std::size_t begin = 0;
  for (int i = 1; i < number && begin != std::string::npos; ++i) begin = text.find('\n', begin) + 1;
  std::string line = text.substr(begin, text.find('\n', begin) - begin);
  line = line.substr(0, line.find(" #"));
  const std::size_t first = line.find_first_not_of(" -");
  const std::size_t last = line.find_last_not_of(" \r");
  return first == std::string::npos ? std::string() : line.substr(first, last + 1 - first);
}

Result<Scenario> read(const Node& root, const std::string& text, const std::string& file) {
  Scenario out;
  out.file = file;
  out.text = text;
  out.name = std::filesystem::path(file).stem().string();
  // A missing key is reported itself, not its effect on every time in the file.
  out.duration = from_seconds(
      root.has("duration") ? root.number("duration", config::positive_up_to(kLongestTime)) : kLongestTime);
  if (!root.has("duration")) root.number("duration", config::positive_up_to(kLongestTime));
  out.seed = static_cast<std::uint64_t>(root.integer("seed", 0, kMaxSeed, 1));
  out.world = read_world(root.child("world"), file);
  out.link = read_link(root.child_if("link"), file);
  out.lidar = root.choice("lidar", {"full", "planar"}, 0) == 0 ? LidarKind::full : LidarKind::planar;
  out.perception = static_cast<PerceptionLevel>(root.choice("perception", kPerceptionWords, 0));
  if (root.has("odometry")) {
    const Node odometry = root.child("odometry");
    out.noise = odometry.number("noise", config::within(0.0, 10.0), 1.0);
  }
  const bool twice = root.has("dust") && root.child("world").has("dust");
  if (twice) root.child("dust").fail(Reason::bad_argument, "expected dust in one place: world has it, too");
  if (root.has("dust")) out.world.dust = root.number("dust", config::within(0.0, 0.5));
  if (root.has("dropouts")) out.dropouts = root.number("dropouts", config::within(0.0, 1.0));
  const auto need_beams = [&](const Node& node, const char* key) {
    if (node.has(key) && out.lidar != LidarKind::full)
      node.child(key).fail(Reason::bad_argument,
                           "expected lidar: full, whose beams are simulated one by one");
  };
  need_beams(root, "dust");
  need_beams(root, "dropouts");
  need_beams(root.child("world"), "dust");
  read_machines(root, out);
  read_people(root, out);
  out.script = read_script(root, out);
  if (root.has("random_script")) out.random = read_random(root.child("random_script"), out);
  out.faults = read_faults(root, out);
  if (root.has("random_faults")) out.random_faults = read_random_faults(root.child("random_faults"), out);
  out.expectations = read_expectations(root, out);
  for (Expectation& e : out.expectations) e.text = source_line(text, e.line);
  if (auto done = root.finish(); !done) return done.error();
  return out;
}

}  // namespace

Result<Scenario> load_scenario(const std::string& file) {
  std::error_code unknown;  // then reading it reports the error
  if (!std::filesystem::is_regular_file(file, unknown))
    return Error{Reason::cannot_read,
                 file + ": no such scenario; those that come along are in config/scenarios/"};
  auto text = read_file(file);
  if (!text) return text.error();
  return parse_scenario(*text, file);
}

Result<WorldSpec> load_world_spec(const std::string& file) {
  auto text = read_file(file);
  if (!text) return text.error();
  auto root = config::parse(*text, file);
  if (!root) return root.error();
  if (root->has("world")) {
    auto scenario = parse_scenario(*text, file);
    if (!scenario) return scenario.error();
    return scenario->world;
  }
  WorldSpec out = read_world(*root, file);
  if (auto done = root->finish(); !done) return done.error();
  return out;
}

Result<Scenario> parse_scenario(const std::string& text, const std::string& file) {
  auto root = config::parse(text, file);
  if (!root) return root.error();
  return read(*root, text, file);
}

}  // namespace adit::sim
