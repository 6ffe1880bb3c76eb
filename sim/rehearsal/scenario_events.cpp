#include <algorithm>
#include <cstdio>

#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

const std::vector<std::string> mode_names{"hold", "manual", "smart_joystick", "waypoint"};

// One of the scenario's agents: a robot or a basestation.
std::string check_agent(const Node& node, const std::string& id, const Scenario& scenario) {
  if (!scenario.robot(id) && !scenario.station(id))
    node.fail(Reason::bad_argument, "expected one of the scenario's robots and basestations, not " + id);
  return id;
}

std::pair<std::string, std::string> read_pair(const Node& fault, const char* key, const Scenario& scenario) {
  const Node node = fault.child(key);
  const std::vector<std::string> names = fault.texts(key);
  if (names.size() != 2) {
    node.fail(Reason::wrong_type, "expected [A, B] for " + std::string(key));
    return {};
  }
  return {check_agent(node, names[0], scenario), check_agent(node, names[1], scenario)};
}

std::string read_victim(const Node& fault, const char* key, const Scenario& scenario) {
  const std::string victim = fault.text(key);
  const Node node = fault.child(key);
  if (const auto slash = victim.find('/'); slash != std::string::npos) {
    const std::string robot = victim.substr(0, slash);
    if (!scenario.robot(robot))
      node.fail(Reason::unknown_robot,
                "expected ROBOT/COMPONENT with a robot of the scenario, not " + victim);
    node.fail(Reason::not_supported, std::string(key) +
                                         " of a component: this version restarts whole agents; write " + key +
                                         ": " + robot);
    return robot;
  }
  return check_agent(node, victim, scenario);
}

Fault read_fault(const Node& node, const Scenario& scenario) {
  Fault fault;
  fault.at = read_time(node, "at", scenario);
  const auto length = [&] { return from_seconds(node.number("for", config::above(0.0, 86400.0))); };
  const int kinds = static_cast<int>(node.has("crash")) + node.has("hang") + node.has("cut") +
                    node.has("degrade") + node.has("forge") + node.has("stuck");
  if (kinds != 1) {
    node.fail(Reason::missing_key, "expected one of crash, hang, cut, degrade, forge and stuck");
  } else if (node.has("crash")) {
    fault.what = Crash{read_victim(node, "crash", scenario)};
  } else if (node.has("hang")) {
    const std::string victim = read_victim(node, "hang", scenario);
    if (victim.find('/') == std::string::npos)
      node.child("hang").fail(Reason::not_supported,
                              "hang: this version lets no agent hang; write crash: " + victim);
  } else if (node.has("cut")) {
    const auto [a, b] = read_pair(node, "cut", scenario);
    fault.what = CutLink{a, b, length()};
  } else if (node.has("degrade")) {
    const auto [a, b] = read_pair(node, "degrade", scenario);
    fault.what = DegradeLink{a, b, node.number("loss", config::within(0.0, 1.0)), length()};
  } else {
    const char* key = node.has("forge") ? "forge" : "stuck";
    const std::vector<std::string> names = node.texts(key);
    if (names.size() != 2 || !scenario.station(names[0]) || !scenario.robot(names[1]))
      node.child(key).fail(Reason::bad_argument, "expected [BASESTATION, ROBOT] for " + std::string(key));
    else if (node.has("forge"))
      fault.what = Forge{names[0], names[1], length()};
    else
      fault.what = StuckStick{names[0], names[1], length()};
  }
  return fault;
}

void read_robot_expectation(const Node& node, const Scenario& scenario, Expectation& out) {
  const std::string robot = read_robot(node, "robot", scenario);
  StateExpectation state{robot, {}, {}, {}, {}, {}};
  if (node.has("near")) {
    const std::vector<double> near = node.numbers("near", 3, 3, config::within(-1e5, 1e5));
    if (near.size() == 3) state.near = NearExpectation{robot, near[0], near[1], near[2]};
    if (near.size() == 3 && near[2] <= 0.0)
      node.child("near").fail(Reason::out_of_range, "expected a tolerance above 0");
  }
  if (node.has("mode")) state.mode = mode_names[node.choice("mode", mode_names)];
  if (node.has("holder")) {
    state.holder = node.text("holder");
    if (*state.holder == "nobody" || *state.holder == "none")
      state.holder->clear();
    else if (!state.holder->empty())
      read_station(node, "holder", scenario);
  } else if (node.has_null("holder")) {
    state.holder.emplace();
  }
  if (node.has("locked")) state.locked = node.flag("locked");
  if (node.has("stopped")) state.stopped = node.flag("stopped");
  const bool says = state.mode || state.holder || state.locked || state.stopped;
  if (!says && !node.has("near"))
    node.fail(Reason::missing_key, "expected near, mode, holder, locked or stopped");
  if (!says && state.near)
    out.what = *state.near;
  else
    out.what = state;
}

Expectation read_expectation(const Node& node, const Scenario& scenario) {
  static const std::vector<std::string> counted{"commands", "refusals", "distance", "moving"};
  Expectation out;
  out.line = node.line();
  for (const std::string& what : counted) {
    const std::string key = what + "_at_least";
    if (!node.has(key)) continue;
    out.what = AtLeast{what, node.number(key, config::within(0.0, 1e9))};
    return out;
  }
  if (node.has("always")) {
    node.choice("always", {"no_collision"});
    out.what = NoCollision{};
    return out;
  }
  const bool at = node.has("at");
  if (at == node.has("by"))
    node.fail(Reason::missing_key,
              "expected one of at, by, always, commands_at_least, refusals_at_least, distance_at_least and "
              "moving_at_least");
  out.when = at ? Expectation::When::at : Expectation::When::by;
  out.time = read_time(node, at ? "at" : "by", scenario);
  if (node.has("by_operator")) {
    AnswerExpectation answer{read_station(node, "by_operator", scenario), Reason::none};
    const std::string reason = node.text("refused");
    if (node.has("refused") && !reason_from_name(reason, answer.refused))
      node.child("refused").fail(
          Reason::bad_argument,
          "expected the name of a reason (locked, not_holder, ...; none: accepted), not " + reason);
    out.what = answer;
  } else {
    read_robot_expectation(node, scenario, out);
  }
  return out;
}

}  // namespace

std::vector<Fault> read_faults(const Node& root, const Scenario& scenario) {
  std::vector<Fault> out;
  for (const Node& node : root.list_if("faults")) out.push_back(read_fault(node, scenario));
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return out;
}

std::vector<Expectation> read_expectations(const Node& root, const Scenario& scenario) {
  std::vector<Expectation> out;
  for (const Node& node : root.list_if("expect")) {
    out.push_back(read_expectation(node, scenario));
  }
  return out;
}

}  // namespace adit::sim
