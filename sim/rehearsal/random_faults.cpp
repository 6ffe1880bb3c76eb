// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_faults.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

/// Components that can be drawn: robots without a router there are, too.
const std::vector<std::string>& of_every_robot(const Scenario& scenario) {
  static const std::vector<std::string> names{"command", "planner", "router", "sensors"},
      with_map{"command", "planner", "router", "sensors", "map"};
  const bool maps = std::all_of(scenario.robots.begin(), scenario.robots.end(), [](const RobotSpec& robot) {
    return robot.settings.perception == PerceptionLevel::slam;
  });
  return maps ? with_map : names;
}

// Written with three decimals, and read as the same again.
double round_ms(double value) { return std::round(value * 1000.0) / 1000.0; }

template <class T>
const T& pick(const std::vector<T>& from, Random& random) {
  return from[random.below(from.size())];
}

/// Draws one fault after the other.
class Draw {
 public:
  Draw(const RandomFaults& spec, const Scenario& scenario, Random& random)
      : spec_(spec), scenario_(scenario), random_(random) {}

  Fault next() {
    Fault out;
    out.at = from_seconds(between(seconds(spec_.from), seconds(spec_.to)));
    what(pick(spec_.kinds, random_), out);
    return out;
  }

  Fault find() {
    Fault out;
    out.at = from_seconds(between(seconds(spec_.from), seconds(spec_.to)));
    out.what = Find{robot(), "artifact", static_cast<int>(random_.below(256))};
    return out;
  }

 private:
  double between(double low, double high) { return round_ms(random_.uniform(low, high)); }
  Duration length(double low, double high) { return from_seconds(between(low, high)); }
  const std::string& robot() { return pick(scenario_.robots, random_).id; }
  const std::string& station() { return pick(scenario_.stations, random_).id; }

  // Mostly an operator and a robot: between them the rules are at stake.
  std::pair<std::string, std::string> two() {
    const std::string a = robot();
    if (scenario_.robots.size() < 2 || random_.chance(0.85)) return {station(), a};
    std::string b = robot();
    while (b == a) b = robot();
    return {a, b};
  }

  std::vector<std::vector<std::string>> groups() {
    std::vector<std::string> all;
    for (const RobotSpec& r : scenario_.robots) all.push_back(r.id);
    for (const StationSpec& s : scenario_.stations) all.push_back(s.id);
    std::vector<std::vector<std::string>> out(2);
    for (const std::string& name : all) out[random_.below(2)].push_back(name);
    for (std::size_t i = 0; i < 2; ++i)
      if (out[i].empty()) {
        out[i].push_back(out[1 - i].back());
        out[1 - i].pop_back();
      }
    return out;
  }

  void what(const std::string& kind, Fault& out) {
    if (kind == "crash") {
      out.what = Crash{random_.chance(0.7) ? robot() : station(), {}};
    } else if (kind == "crash_component") {
      out.what = Crash{robot(), pick(of_every_robot(scenario_), random_)};
    } else if (kind == "hang") {
      out.what = Hang{robot(), pick(of_every_robot(scenario_), random_)};
    } else if (kind == "cut") {
      const auto [a, b] = two();
      const bool turned = random_.chance(0.5);
      out.what = CutLink{turned ? b : a, turned ? a : b, random_.chance(0.4), length(0.2, 8.0)};
    } else if (kind == "degrade") {
      const auto [a, b] = two();
      out.what = DegradeLink{a, b, between(0.2, 0.9), random_.chance(0.5) ? between(0.0, 0.4) : 0.0,
                             length(1.0, 10.0)};
    } else if (kind == "partition") {
      out.what = Partition{groups(), length(0.5, 8.0)};
    } else if (kind == "reorder") {
      const auto [a, b] = two();
      out.what = Reorder{a, b, between(0.1, 0.7), between(0.05, 0.8), length(2.0, 12.0)};
    } else if (kind == "duplicate") {
      const auto [a, b] = two();
      out.what = Duplicate{a, b, between(0.1, 0.8), length(2.0, 12.0)};
    } else if (kind == "clock_jump") {
      const double by = random_.chance(0.5) ? between(0.05, 1.0) : between(1.0, 8.0);
      out.what = ClockJump{{{random_.chance(0.7) ? robot() : station(), from_seconds(by)}}};
    } else if (kind == "sensor_silent") {
      const Sensor sensor = random_.chance(0.5) ? Sensor::lidar : Sensor::odometry;
      out.what = SensorSilent{robot(), sensor, length(0.2, 5.0)};
    } else if (kind == "stuck_drive") {
      out.what = StuckDrive{robot(), length(0.5, 6.0)};
    } else if (kind == "disk_full") {
      out.what = DiskFull{robot(), length(1.0, 10.0)};
    } else if (kind == "forge") {
      out.what = Forge{station(), robot(), length(1.0, 5.0)};
    } else {
      out.what = StuckStick{station(), robot(), length(0.5, 5.0)};
    }
  }

  const RandomFaults& spec_;
  const Scenario& scenario_;
  Random& random_;
};

}  // namespace

const std::vector<std::string>& random_fault_kinds() {
  static const std::vector<std::string> kinds{"crash",      "crash_component", "hang",        "cut",
                                              "degrade",    "partition",       "reorder",     "duplicate",
                                              "clock_jump", "sensor_silent",   "stuck_drive", "disk_full",
                                              "forge",      "stuck_stick"};
  return kinds;
}

const std::vector<std::string>& component_names() {
  static const std::vector<std::string> names{"command", "planner", "router", "sensors", "map"};
  return names;
}

std::vector<Fault> draw_faults(const RandomFaults& spec, const Scenario& scenario, Random random) {
  std::vector<Fault> out;
  Random copy = random, of_finds = copy.fork(9);  // how many there are changes no fault
  Draw draw(spec, scenario, random), finds(spec, scenario, of_finds);
  for (int i = 0; i < spec.faults; ++i) out.push_back(draw.next());
  for (int i = 0; i < spec.finds; ++i) out.push_back(finds.find());
  std::stable_sort(out.begin(), out.end(), [](const Fault& a, const Fault& b) { return a.at < b.at; });
  return out;
}

}  // namespace adit::sim
