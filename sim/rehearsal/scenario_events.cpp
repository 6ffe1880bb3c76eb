// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

const std::vector<std::string> kModeNames{"hold",     "manual",  "smart_joystick", "waypoint",
                                          "external", "explore", "convoy_follow",  "get_out"};

const std::vector<std::string> kExplorationNames{"none",      "starting", "exploring", "travelling",
                                                 "reporting", "done",     "ended"};

void read_robot_expectation(const Node& node, const Scenario& scenario, Expectation& out) {
  const std::string robot = read_robot(node, "robot", scenario);
  StateExpectation state{.robot = robot};
  if (node.has("near")) {
    const std::vector<double> near = node.numbers("near", 3, 3, config::within(-1e5, 1e5));
    if (near.size() == 3) state.near = NearExpectation{robot, near[0], near[1], near[2]};
    if (near.size() == 3 && near[2] <= 0.0)
      node.child("near").fail(Reason::out_of_range, "expected a tolerance above 0");
  }
  if (node.has("mode")) state.mode = kModeNames[node.choice("mode", kModeNames)];
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
  if (node.has("explore")) state.explore = kExplorationNames[node.choice("explore", kExplorationNames)];
  const bool says = state.mode || state.holder || state.locked || state.stopped || state.explore;
  if (!says && !node.has("near"))
    node.fail(Reason::missing_key, "expected near, mode, holder, locked, stopped or explore");
  if (!says && state.near)
    out.what = *state.near;
  else
    out.what = state;
}

ExplorationArea read_area(const Node& node) {
  if (!node.has("area")) {
    node.fail(Reason::missing_key, "expected area: [x0, y0, x1, y1]");
    return {};
  }
  const std::vector<double> v = node.numbers("area", 4, 4, config::within(-1e5, 1e5));
  if (v.size() != 4) return {};
  if (v[0] >= v[2] || v[1] >= v[3])
    node.child("area").fail(Reason::bad_argument, "expected [x0, y0, x1, y1] with x0 < x1 and y0 < y1");
  return {v[0], v[1], v[2], v[3]};
}

std::vector<std::string> read_named_robots(const Node& node, const Scenario& scenario) {
  std::vector<std::string> names;
  for (const Node& robot : node.list_if("robots")) {
    names.push_back(robot.as_text());
    if (!scenario.robot(names.back()))
      robot.fail(Reason::unknown_robot, "expected one of the scenario's robots, not " + names.back());
  }
  return names;
}

ExploredExpectation read_explored(const Node& node, const Scenario& scenario) {
  ExploredExpectation out;
  out.share = node.number("explored_at_least", config::within(0.0, 1.0));
  if (node.has("area")) out.area = read_area(node);
  out.robots = read_named_robots(node, scenario);
  return out;
}

/// An expectation of what holds all the time.
void read_always(const Node& node, const Scenario& scenario, Expectation& out) {
  const auto which = node.choice(
      "always", {"no_collision", "no_collision_caused", "inside", "outside", "pose_within", "progress"});
  if (which < 2) {
    out.what = NoCollision{which == 1};
    return;
  }
  std::vector<std::string> robots = read_named_robots(node, scenario);
  if (robots.empty())
    for (const RobotSpec& robot : scenario.robots) robots.push_back(robot.id);
  if (which == 4)
    out.what = PoseWithinExpectation{node.number("m", config::positive_up_to(1e4)), robots};
  else if (which == 5)
    out.what = ProgressExpectation{from_seconds(node.number("within", config::positive_up_to(kLongestTime))),
                                   robots};
  else
    out.what = PlaceExpectation{which == 2, read_area(node), robots};
}

// `examples`: of what may be written.
Reason read_reason(const Node& node, const char* key, const std::string& examples) {
  Reason out{Reason::none};
  const std::string text = node.text(key);
  if (node.has(key) && !reason_from_name(text, out))
    node.child(key).fail(Reason::bad_argument,
                         "expected the name of a reason (" + examples + "), not " + text);
  return out;
}

std::vector<std::string> read_robots(const Node& node, const char* key, const Scenario& scenario) {
  std::vector<std::string> names = node.texts(key);
  for (const std::string& name : names)
    if (!scenario.robot(name)) node.child(key).fail(Reason::unknown_robot, "no robot is named " + name);
  if (names.size() < 2) node.child(key).fail(Reason::bad_argument, "expected at least two robots");
  return names;
}

/// An expectation of what holds from one time to another.
void read_period(const Node& node, const Scenario& scenario, Expectation& out) {
  out.when = Expectation::When::during;
  out.from = read_time(node, "from", scenario);
  out.time = read_time(node, "to", scenario);
  if (out.time < out.from) node.child("to").fail(Reason::out_of_range, "expected a time after from");
  if (node.has("gap")) {
    const auto robots = read_robots(node, "gap", scenario);
    const auto between = node.numbers("between", 2, 2, config::within(0.0, 1e4));
    if (robots.size() == 2 && between.size() == 2)
      out.what = GapExpectation{robots[0], robots[1], between[0], between[1]};
    else
      node.child("gap").fail(Reason::bad_argument, "expected two robots");
  } else if (node.has("still")) {
    const std::string robot = read_robot(node, "robot", scenario);
    out.what = StillExpectation{robot, node.number("still", config::within(0.0, 1e4))};
  } else {
    node.fail(Reason::missing_key, "expected gap or still");
  }
}

Expectation read_expectation(const Node& node, const Scenario& scenario) {
  static const std::vector<std::string> counted{"commands", "refusals", "faults", "distance", "moving"};
  Expectation out;
  out.line = node.line();
  for (const std::string& what : counted) {
    const std::string key = what + "_at_least";
    if (!node.has(key)) continue;
    out.what = AtLeast{what, node.number(key, config::within(0.0, 1e9))};
    return out;
  }
  if (node.has("always")) {
    read_always(node, scenario, out);
    return out;
  }
  if (node.has("from")) {
    read_period(node, scenario, out);
    return out;
  }
  const bool at = node.has("at");
  if (at == node.has("by"))
    node.fail(Reason::missing_key,
              "expected one of at, by, always, commands_at_least, refusals_at_least, faults_at_least, "
              "distance_at_least and "
              "moving_at_least");
  out.when = at ? Expectation::When::at : Expectation::When::by;
  out.time = read_time(node, at ? "at" : "by", scenario);
  if (node.has("explored_at_least")) {
    out.what = read_explored(node, scenario);
  } else if (node.has("repeat_at_most")) {
    out.what = RepeatExpectation{node.number("repeat_at_most", config::within(0.0, 1.0))};
  } else if (node.has("by_operator") && node.has("findings")) {
    FindingsExpectation desk{read_station(node, "by_operator", scenario),
                             static_cast<std::size_t>(node.integer("findings", 0, 65536)),
                             {}};
    if (node.has("photos")) desk.photos = static_cast<std::size_t>(node.integer("photos", 0, 65536));
    out.what = desk;
  } else if (node.has("pictures_at_least")) {
    out.what =
        PicturesExpectation{read_station(node, "by_operator", scenario),
                            static_cast<std::uint64_t>(node.integer("pictures_at_least", 0, 1'000'000))};
  } else if (node.has("map_at_least") || node.has("map_wrong_at_most")) {
    MapExpectation map{.by = read_station(node, "by_operator", scenario)};
    if (node.has("map_at_least")) map.share = node.number("map_at_least", config::within(0.0, 1.0));
    if (node.has("map_wrong_at_most")) map.wrong = node.number("map_wrong_at_most", config::within(0.0, 1.0));
    out.what = map;
  } else if (node.has("by_operator") && node.has("notified")) {
    out.what = NoticeExpectation{read_station(node, "by_operator", scenario), node.text("notified"),
                                 read_robot(node, "robot", scenario)};
  } else if (node.has("told")) {
    out.what = ReasonExpectation{read_robot(node, "robot", scenario),
                                 read_reason(node, "told", "blocked, stuck, ...")};
  } else if (node.has("convoy")) {
    const std::string leader = read_robot(node, "convoy", scenario);
    ConvoyExpectation convoy{read_robots(node, "order", scenario)};
    if (!convoy.order.empty() && convoy.order.front() != leader)
      node.child("order").fail(Reason::bad_argument, "expected " + leader + " first");
    out.what = convoy;
  } else if (node.has("in_line")) {
    InLineExpectation line{read_robots(node, "in_line", scenario)};
    const auto along = node.numbers("along", 4, 4, config::within(-1e5, 1e5));
    if (along.size() == 4) {
      line.from = {along[0], along[1]};
      line.to = {along[2], along[3]};
    }
    out.what = line;
  } else if (node.has("by_operator")) {
    out.what = AnswerExpectation{read_station(node, "by_operator", scenario),
                                 read_reason(node, "refused", "locked, not_holder, ...; none: accepted")};
  } else {
    read_robot_expectation(node, scenario, out);
  }
  return out;
}

}  // namespace

std::vector<Expectation> read_expectations(const Node& root, const Scenario& scenario) {
  std::vector<Expectation> out;
  for (const Node& node : root.list_if("expect")) {
    out.push_back(read_expectation(node, scenario));
  }
  return out;
}

}  // namespace adit::sim
