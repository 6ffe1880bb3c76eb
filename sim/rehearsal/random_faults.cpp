// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_faults.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

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

bool perceives(const RobotSpec& robot) { return robot.settings.perception != PerceptionLevel::off; }
bool perceives(const Scenario& scenario) {
  return std::any_of(scenario.robots.begin(), scenario.robots.end(),
                     [](const RobotSpec& robot) { return perceives(robot); });
}

const std::set<std::string>& driver_kinds() {
  static const std::set<std::string> kinds{"slip",     "turn_slip",      "driver_clock",
                                           "no_stamp", "driver_restart", "lose_columns"};
  return kinds;
}

/// The time in which a robot's lidar or odometry is of no use.
struct Impairment {
  std::string robot;
  Sensor sensor;
  Duration from, to;
};

std::optional<Impairment> impairment(const Fault& fault) {
  constexpr Duration kRecovery{2s};  // After which a sensor that was wrong is trusted again.
  const auto of = [&](const std::string& robot, Sensor sensor, Duration duration) {
    const bool needed = sensor == Sensor::lidar || sensor == Sensor::odometry;
    return needed ? std::optional(Impairment{robot, sensor, fault.at, fault.at + duration + kRecovery})
                  : std::nullopt;
  };
  if (const auto* f = std::get_if<SensorSilent>(&fault.what)) return of(f->robot, f->sensor, f->duration);
  if (const auto* f = std::get_if<DriverClock>(&fault.what)) return of(f->robot, f->sensor, f->duration);
  if (const auto* f = std::get_if<NoStamp>(&fault.what)) return of(f->robot, f->sensor, f->duration);
  if (const auto* f = std::get_if<Slip>(&fault.what)) return of(f->robot, Sensor::odometry, f->duration);
  if (const auto* f = std::get_if<TurnSlip>(&fault.what)) return of(f->robot, Sensor::odometry, f->duration);
  if (const auto* f = std::get_if<DriverRestart>(&fault.what)) return of(f->robot, Sensor::odometry, 0s);
  return std::nullopt;
}

/// Draws one fault after the other.
class Draw {
 public:
  Draw(const RandomFaults& spec, const Scenario& scenario, Random& random)
      : spec_(spec),
        scenario_(scenario),
        random_(random),
        kinds_(spec.kinds.empty() ? random_fault_kinds(scenario) : spec.kinds),
        perceives_(perceives(scenario)) {}

  /// Nothing when every robot is short of a sensor at all times already.
  std::optional<Fault> next() {
    if (!perceives_) return draw();
    Fault out = draw();
    for (int more = 0; blinds(out) && more < kMostDraws; ++more) out = draw();
    if (blinds(out)) return std::nullopt;
    drawn_.push_back(out);
    return out;
  }

  Fault draw() {
    Fault out;
    out.at = from_seconds(between(seconds(spec_.from), seconds(spec_.to)));
    what(pick(kinds_, random_), out);
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
    } else if (kind == "close") {
      out.what = close();
    } else if (driver_kinds().contains(kind)) {
      of_driver(kind, out);
    } else {
      out.what = StuckStick{station(), robot(), length(0.5, 5.0)};
    }
  }

  // A door, a gate or a crate where the robots drive.
  Close close() {
    const Pose2& start = pick(scenario_.robots, random_).pose;
    const Eigen::Vector2d reach = scenario_.random ? scenario_.random->reach : RandomScript{}.reach;
    const double x = start.x + between(-reach.x(), reach.x()), y = start.y + between(-reach.y(), reach.y());
    const double along = between(0.1, 0.8), across = between(0.1, 0.8);
    Close out{{x - along, x + along, y - across, y + across, 0.0, 2.0}, {}};
    for (double& value : out.box) value = round_ms(value);
    out.duration = length(1.0, 15.0);
    return out;
  }

  // One of the robots whose faults of drivers are drawn; `drives`: that flies not.
  const std::string& perceiving(bool drives = false) {
    std::vector<const RobotSpec*> those;
    for (const RobotSpec& robot : scenario_.robots)
      if (perceives(robot) && !(drives && robot.settings.platform.flies())) those.push_back(&robot);
    return those.empty() ? robot() : pick(those, random_)->id;
  }
  Sensor sensor() {
    const std::size_t all = scenario_.lidar == LidarKind::full ? 3 : 2;  // A planar robot has no imu.
    return static_cast<Sensor>(random_.below(all));
  }
  double either_sign(double low, double high) {
    const double amount = between(low, high);
    return random_.chance(0.5) ? amount : -amount;
  }

  // A little, as a clock that is set; some seconds; a time zone; a computer without a clock that learns the
  // time.
  double clock_jump() {
    switch (random_.below(4)) {
      case 0:
        return either_sign(0.05, 1.0);
      case 1:
        return either_sign(1.0, 60.0);
      case 2:
        return random_.chance(0.5) ? 3600.0 : -3600.0;
      default:
        return 1.6e9;
    }
  }

  void of_driver(const std::string& kind, Fault& out) {
    if (kind == "slip") {
      const std::string& robot = perceiving(true);
      const double vx = either_sign(0.0, 2.0), wz = random_.chance(0.5) ? 0.0 : either_sign(0.0, 1.0);
      out.what = Slip{robot, vx, wz, length(0.5, 10.0)};
    } else if (kind == "turn_slip") {
      const std::string& robot = perceiving(true);
      const double share = between(0.1, 0.6);
      out.what = TurnSlip{robot, share, length(2.0, 15.0)};
    } else if (kind == "driver_clock") {
      const std::string& robot = perceiving();
      const Duration jump = from_seconds(clock_jump());
      const Sensor of = sensor();
      out.what = DriverClock{robot, jump, of, length(1.0, 10.0)};
    } else if (kind == "no_stamp") {
      const std::string& robot = perceiving();
      const Sensor of = sensor();
      out.what = NoStamp{robot, of, length(1.0, 10.0)};
    } else if (kind == "driver_restart") {
      const std::string& robot = perceiving();
      Pose2 origin;
      if (random_.chance(0.6)) {
        origin.x = between(-20.0, 20.0);
        origin.y = between(-20.0, 20.0);
        origin.yaw = between(-3.1, 3.1);
      }
      out.what = DriverRestart{robot, origin};
    } else {
      const std::string& robot = perceiving();
      const double share = between(0.005, 0.2);
      const auto time = static_cast<LostTime>(random_.below(lost_time_words().size()));
      out.what = LoseColumns{robot, {share, time}, length(1.0, 10.0)};
    }
  }

  // Whether a robot would have neither its lidar nor its odometry without a fault.
  bool blinds(const Fault& fault) const {
    const auto own = impairment(fault);
    if (!own) return false;
    return std::any_of(drawn_.begin(), drawn_.end(), [&](const Fault& other) {
      const auto its = impairment(other);
      return its && its->robot == own->robot && its->sensor != own->sensor && its->from < own->to &&
             own->from < its->to;
    });
  }

  static constexpr int kMostDraws = 20;
  const RandomFaults& spec_;
  const Scenario& scenario_;
  Random& random_;
  std::vector<std::string> kinds_;
  bool perceives_;
  std::vector<Fault> drawn_{};
};

}  // namespace

std::vector<std::string> random_fault_kinds(const Scenario& scenario) {
  static const std::vector<std::string> kinds{"crash",      "crash_component", "hang",        "cut",
                                              "degrade",    "partition",       "reorder",     "duplicate",
                                              "clock_jump", "sensor_silent",   "stuck_drive", "disk_full",
                                              "forge",      "stuck_stick",     "close"};
  std::vector<std::string> all = kinds;
  if (!perceives(scenario)) return all;
  const bool drives = std::any_of(scenario.robots.begin(), scenario.robots.end(), [](const RobotSpec& robot) {
    return perceives(robot) && !robot.settings.platform.flies();
  });
  for (const std::string& kind : driver_kinds()) {
    const bool of_wheels = kind == "slip" || kind == "turn_slip";
    const bool possible = of_wheels ? drives : kind != "lose_columns" || scenario.lidar == LidarKind::full;
    if (possible) all.push_back(kind);
  }
  return all;
}

const std::vector<std::string>& component_names() {
  static const std::vector<std::string> names{"command", "planner", "router", "sensors", "map", "stairs"};
  return names;
}

std::vector<Fault> draw_faults(const RandomFaults& spec, const Scenario& scenario, Random random) {
  std::vector<Fault> out;
  Random copy = random, of_finds = copy.fork(9);  // how many there are changes no fault
  Draw draw(spec, scenario, random), finds(spec, scenario, of_finds);
  for (int i = 0; i < spec.faults; ++i)
    if (auto fault = draw.next()) out.push_back(std::move(*fault));
  for (int i = 0; i < spec.finds; ++i) out.push_back(finds.find());
  std::stable_sort(out.begin(), out.end(), [](const Fault& a, const Fault& b) { return a.at < b.at; });
  return out;
}

}  // namespace adit::sim
