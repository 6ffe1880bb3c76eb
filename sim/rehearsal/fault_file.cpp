// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "core/findings/finding.hpp"
#include "sim/rehearsal/random_faults.hpp"
#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

// One of the scenario's agents: a robot or a basestation.
std::string check_agent(const Node& node, const std::string& id, const Scenario& scenario) {
  if (!scenario.robot(id) && !scenario.station(id))
    node.fail(Reason::bad_argument, "expected one of the scenario's robots and basestations, not " + id);
  return id;
}

std::pair<std::string, std::string> read_pair(const Node& fault, const char* key, const Scenario& scenario) {
  const Node node = fault.child(key);
  const std::vector<std::string> names = fault.texts(key);
  if (names.size() != 2 || names[0] == names[1]) {
    node.fail(Reason::wrong_type, "expected [A, B] for " + std::string(key));
    return {};
  }
  return {check_agent(node, names[0], scenario), check_agent(node, names[1], scenario)};
}

// ROBOT/COMPONENT, or the name alone.
std::pair<std::string, std::string> read_part(const Node& fault, const char* key, const Scenario& scenario) {
  const std::string victim = fault.text(key);
  const Node node = fault.child(key);
  const auto slash = victim.find('/');
  if (slash == std::string::npos) return {check_agent(node, victim, scenario), {}};
  const std::string robot = victim.substr(0, slash), component = victim.substr(slash + 1);
  if (!scenario.robot(robot))
    node.fail(Reason::unknown_robot, "expected ROBOT/COMPONENT with a robot of the scenario, not " + victim);
  const auto& known = component_names();
  if (std::find(known.begin(), known.end(), component) == known.end()) {
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    node.fail(Reason::bad_argument, "expected one of a robot's components (" + all + "), not " + component);
  }
  return {robot, component};
}

Hang read_hang(const Node& fault, const Scenario& scenario) {
  const auto [robot, component] = read_part(fault, "hang", scenario);
  if (component.empty())
    fault.child("hang").fail(
        Reason::bad_argument,
        "expected ROBOT/COMPONENT: a component's callback hangs, not the whole of " + robot);
  return {robot, component};
}

Partition read_partition(const Node& fault, const Scenario& scenario) {
  Partition out;
  std::set<std::string> seen;
  const Node node = fault.child("partition");
  for (const Node& group : node.as_list()) {
    auto& names = out.groups.emplace_back();
    for (const Node& name : group.as_list()) {
      names.push_back(check_agent(name, name.as_text(), scenario));
      if (!seen.insert(names.back()).second)
        name.fail(Reason::bad_argument, "expected each name in one group: " + names.back() + " is in two");
    }
    if (names.empty()) group.fail(Reason::bad_argument, "expected at least one name in a group");
  }
  if (out.groups.size() < 2)
    node.fail(Reason::bad_argument, "expected [[A, ...], [B, ...]], two groups or more");
  out.duration = read_length(fault);
  return out;
}

ClockJump read_jump(const Node& fault, const Scenario& scenario) {
  ClockJump out;
  const Node node = fault.child("clock_jump");
  for (const auto& [who, by] : node.entries()) {
    check_agent(by, who, scenario);
    // Computers judge time by a clock that never goes back, but that a suspend lets jump.
    out.by[who] = from_seconds(by.as_number(config::positive_up_to(kLongestTime)));
  }
  if (out.by.empty()) node.fail(Reason::wrong_type, "expected {NAME: SECONDS} for clock_jump");
  return out;
}

// A stick that hangs, [BASESTATION, ROBOT], or a drive, ROBOT.
void read_stuck(const Node& fault, const Scenario& scenario, Fault& out) {
  if (fault.child("stuck").is_scalar()) {
    out.what = StuckDrive{read_robot(fault, "stuck", scenario), read_length(fault)};
    return;
  }
  const std::vector<std::string> names = fault.texts("stuck");
  if (names.size() != 2 || !scenario.station(names[0]) || !scenario.robot(names[1]))
    return fault.child("stuck").fail(
        Reason::bad_argument, "expected [BASESTATION, ROBOT] (his joystick) or ROBOT (its drive) for stuck");
  out.what = StuckStick{names[0], names[1], read_length(fault)};
}

Forge read_forge(const Node& fault, const Scenario& scenario) {
  const std::vector<std::string> names = fault.texts("forge");
  if (names.size() == 2 && scenario.station(names[0]) && scenario.robot(names[1]))
    return {names[0], names[1], read_length(fault)};
  fault.child("forge").fail(Reason::bad_argument, "expected [BASESTATION, ROBOT] for forge");
  return {};
}

Find read_find(const Node& node, const Scenario& scenario) {
  Find out;
  out.kind = node.text("finds");
  const auto plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (out.kind.empty() || out.kind.size() > findings::Finding::kKind ||
      !std::all_of(out.kind.begin(), out.kind.end(), plain))
    node.child("finds").fail(Reason::bad_argument,
                             "expected 1 to 32 printable characters for finds, without quotes");
  out.robot = read_robot(node, "robot", scenario);
  out.importance = static_cast<int>(node.integer("importance", 0, 255, 1));
  out.photo = static_cast<int>(node.integer("photo", 0, 256, 0));
  return out;
}

Close read_close(const Node& node) {
  Close out;
  const std::vector<double> v = node.numbers("close", 6, 6, config::within(-1e4, 1e4));
  if (v.size() == 6) std::copy(v.begin(), v.end(), out.box.begin());
  if (v.size() == 6 && !(v[0] < v[1] && v[2] < v[3] && v[4] < v[5]))
    node.child("close").fail(Reason::bad_argument,
                             "expected [x0, x1, y0, y1, z0, z1] in metres with x0 < x1, y0 < y1, z0 < z1");
  out.duration = read_length(node);
  return out;
}

Steer read_steer(const Node& node, const Scenario& scenario) {
  Steer out;
  out.robot = read_robot(node, "steers", scenario);
  const std::vector<double> v = node.numbers("velocity", 3, 3, config::within(-10.0, 10.0));
  if (v.size() == 3) out.velocity = {v[0], v[1], v[2]};
  out.duration = read_length(node);
  return out;
}

void read_link_fault(const Node& fault, const std::string& kind, const Scenario& scenario, Fault& out) {
  const auto [a, b] = read_pair(fault, kind.c_str(), scenario);
  const auto chance = [&](const char* key) { return fault.number(key, config::within(0.0, 1.0)); };
  if (kind == "cut") out.what = CutLink{a, b, fault.flag("one_way", false), read_length(fault)};
  if (kind == "degrade")
    out.what = DegradeLink{a, b, chance("loss"), fault.number("delay", config::within(0.0, 10.0), 0.0),
                           read_length(fault)};
  if (kind == "reorder")
    out.what = Reorder{a, b, chance("chance"), fault.number("by", config::positive_up_to(10.0), 0.2),
                       read_length(fault)};
  if (kind == "duplicate") out.what = Duplicate{a, b, chance("chance"), read_length(fault)};
}

Fault read_fault(const Node& node, const Scenario& scenario) {
  static const std::vector<std::string> others{
      "crash", "hang",      "cut",   "degrade", "partition", "reorder",        "duplicate", "clock_jump",
      "stuck", "disk_full", "forge", "finds",   "steers",    "odometry_reset", "twin",      "close"};
  std::vector<std::string> kinds = others;
  const auto& of_drivers = driver_fault_kinds();
  kinds.insert(kinds.end(), of_drivers.begin(), of_drivers.end());
  Fault fault;
  fault.at = read_time(node, "at", scenario);
  std::string kind, all;
  int count = 0;
  for (const std::string& known : kinds) {
    all += (all.empty() ? "" : ", ") + known;
    if (!node.has(known)) continue;
    kind = known;
    ++count;
  }
  if (count != 1) {
    node.fail(Reason::missing_key, "expected one of " + all);
  } else if (kind == "crash") {
    const auto [victim, component] = read_part(node, "crash", scenario);
    fault.what = Crash{victim, component};
  } else if (kind == "hang") {
    fault.what = read_hang(node, scenario);
  } else if (kind == "partition") {
    fault.what = read_partition(node, scenario);
  } else if (kind == "clock_jump") {
    fault.what = read_jump(node, scenario);
  } else if (std::find(of_drivers.begin(), of_drivers.end(), kind) != of_drivers.end()) {
    read_driver_fault(node, kind, scenario, fault);
  } else if (kind == "stuck") {
    read_stuck(node, scenario, fault);
  } else if (kind == "disk_full") {
    fault.what = DiskFull{read_robot(node, "disk_full", scenario), read_length(node)};
  } else if (kind == "forge") {
    fault.what = read_forge(node, scenario);
  } else if (kind == "finds") {
    fault.what = read_find(node, scenario);
  } else if (kind == "steers") {
    fault.what = read_steer(node, scenario);
  } else if (kind == "odometry_reset") {
    fault.what = OdometryReset{read_robot(node, "odometry_reset", scenario)};
  } else if (kind == "close") {
    fault.what = read_close(node);
  } else if (kind == "twin") {
    fault.what = Twin{read_robot(node, "twin", scenario), read_length(node)};
  } else {
    read_link_fault(node, kind, scenario, fault);
  }
  return fault;
}

}  // namespace

std::vector<Fault> read_faults(const Node& root, const Scenario& scenario) {
  std::vector<Fault> out;
  for (const Node& node : root.list_if("faults")) out.push_back(read_fault(node, scenario));
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return out;
}

RandomFaults read_random_faults(const Node& node, const Scenario& scenario) {
  RandomFaults out;
  out.faults = static_cast<int>(node.integer("faults", 0, 10000));
  out.from = read_time(node, "from", scenario);
  out.to = read_time(node, "to", scenario);
  if (out.to < out.from) node.fail(Reason::out_of_range, "expected from before to");
  out.finds = static_cast<int>(node.integer("finds", 0, 1000, 0));
  if (node.has("kinds")) out.kinds = node.texts("kinds");
  const auto known = random_fault_kinds(scenario);
  std::string all;
  for (const std::string& kind : known) all += (all.empty() ? "" : ", ") + kind;
  for (const std::string& kind : out.kinds)
    if (std::find(known.begin(), known.end(), kind) == known.end())
      node.child("kinds").fail(Reason::bad_argument, "expected kinds of faults (" + all + "), not " + kind);
  if (node.has("kinds") && out.kinds.empty()) node.fail(Reason::bad_argument, "expected at least one kind");
  return out;
}

}  // namespace adit::sim
