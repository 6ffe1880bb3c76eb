// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/telemetry_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>

#include "bench/perception/stated_poses.hpp"
#include "core/time/random.hpp"
#include "sim/checker/radio_decoder.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace adit::bench {
namespace {

using namespace sim;

constexpr int kLasts = 70;                     ///< A drive, s.
constexpr Duration kPatience = 2s;             ///< So long may an error be beyond its limit (issue 38).
constexpr double kLeast = 0.85, kMost = 0.99;  ///< Share of the poses within three sigma.

/// Where a robot drives: `goto` places or joystick `drive`s, each at its time. A goal that is given again
/// brings a robot that went to hold back on its way.
struct Course {
  const char* name;
  const char* world;
  const char* start;
  std::vector<std::pair<int, const char*>> script;
  bool by_hand{};
};

// A ring of smooth corridors, 16 m and 12 m long.
constexpr const char* kRing =
    "boxes: [[-1.6, 17.6, -1.6, -1.3, 0, 3], [-1.6, 17.6, 13.3, 13.6, 0, 3], [-1.6, -1.3, -1.6, 13.6, 0, 3], "
    "[17.3, 17.6, -1.6, 13.6, 0, 3], [1.3, 14.7, 1.3, 10.7, 0, 3]], floor: 0, ceiling: 3";

const std::vector<Course>& courses() {
  static const std::vector<Course> all{
      {"blocks",
       "generate: blocks, seed: {seed}",
       "1.6, 1.6, 0",
       {{3, "goto r1 12.8 1.6"},
        {17, "goto r1 12.8 12.8"},
        {32, "goto r1 1.6 12.8"},
        {46, "goto r1 1.6 1.6"},
        {61, "goto r1 12.8 1.6"}}},
      {"ring",
       kRing,
       "0, 0, 0",
       {{3, "goto r1 16 0"}, {19, "goto r1 16 12"}, {33, "goto r1 0 12"}, {50, "goto r1 0 0"}}},
      {"rooms",
       "generate: rooms, seed: {seed}",
       "2, 7.5, 0",
       {{3, "goto r1 15 7.5"}, {20, "goto r1 3 7.5"}, {36, "goto r1 18 7.5"}, {54, "goto r1 4 7.5"}}},
      // By hand, which goes on whatever the robot knows of its place.
      {"hand",
       kRing,
       "2, 0, 0",
       {{4, "drive r1 0.8 0 0 --for 12"},
        {17, "drive r1 0 0 1 --for 3.1"},
        {21, "drive r1 0.8 0 0 --for 11"},
        {33, "drive r1 0 0 -1 --for 3.1"},
        {37, "drive r1 0.8 0 0 --for 11"},
        {49, "drive r1 0 0 1 --for 3.1"},
        {53, "drive r1 0.8 0 0 --for 11"}},
       true},
  };
  return all;
}

struct RobotKind {
  const char* name;
  const char* sensors;
};
constexpr RobotKind kRobots[] = {
    {"standard", ""},
    {"imu", ", sensors: {lidar: {x: 0, y: 0, z: 0.5}, imu: {x: 0, y: 0, z: 0.2}}"},
};

/// `text`: the fault of a scenario, with {at}, {jump}, {share} and others drawn from the seed.
struct FaultKind {
  const char* name;
  const char* text;
  bool imu{};      ///< Of a robot with an IMU alone.
  bool by_hand{};  ///< Autonomous modes stand in it.
};
constexpr FaultKind kFaults[] = {
    {"none", ""},
    {"slip", "slip: r1, wheels: [{vx}, {wz}], for: {for}"},
    {"turn_slip", "turn_slip: r1, share: {share}, for: 30"},
    {"clock lidar", "driver_clock: r1, sensor: lidar, jump: {jump}"},
    {"clock odometry", "driver_clock: r1, sensor: odometry, jump: {jump}"},
    {"clock imu", "driver_clock: r1, sensor: imu, jump: {jump}", true},
    {"no_stamp lidar", "no_stamp: r1, sensor: lidar, for: {for}"},
    {"no_stamp odometry", "no_stamp: r1, sensor: odometry, for: {for}"},
    {"no_stamp imu", "no_stamp: r1, sensor: imu, for: {for}", true},
    {"restart", "driver_restart: r1, origin: [{x}, {y}, {yaw}]"},
    {"lose_columns", "lose_columns: r1, share: {columns}, time: {time}, for: 30"},
    {"cover", "cover: r1, for: {for}"},
    {"silent imu", "sensor_silent: r1, sensor: imu, for: {for}", true},
    {"silent lidar", "sensor_silent: r1, sensor: lidar, for: {for}"},
    {"dust", "", false, true},
};

struct Row {
  const Course& course;
  const RobotKind& robot;
  const FaultKind& fault;
  std::uint64_t seed{};
  std::string about() const {
    return fmt::format("{:<7} {:<8} {:<18} {:>4}", course.name, robot.name, fault.name, seed);
  }
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what))
    text.replace(at, what.size(), by);
  return text;
}

/// The fault of a row: when it begins and how large it is follow from the seed.
std::string fault_text(const Row& row) {
  Random random(row.seed);
  const auto number = [&](double low, double high) {
    return fmt::format("{:.3f}", random.uniform(low, high));
  };
  static constexpr const char* kJumps[] = {"0.2", "-0.2", "5", "-5", "3600"};
  static constexpr const char* kTimes[] = {"zero", "nan", "wrapped", "kept"};
  // Between two goals the robot moves: for the larger part of these times.
  std::string text = fmt::format("  - {{at: {}, {}}}\n", number(12, 30), row.fault.text);
  text = replaced(std::move(text), "{for}", number(5, 15));
  text = replaced(std::move(text), "{vx}", number(0.3, 1.0));
  text = replaced(std::move(text), "{wz}", random.chance(0.5) ? "0" : number(-0.5, 0.5));
  text = replaced(std::move(text), "{share}", number(0.5, 0.9));
  text = replaced(std::move(text), "{jump}", kJumps[(row.seed - 1) % std::size(kJumps)]);
  text = replaced(std::move(text), "{columns}", number(0.01, 0.3));
  text = replaced(std::move(text), "{time}", kTimes[(row.seed - 1) % std::size(kTimes)]);
  text = replaced(std::move(text), "{x}", number(-30, 30));
  text = replaced(std::move(text), "{y}", number(-30, 30));
  return replaced(std::move(text), "{yaw}", number(-3, 3));
}

std::string scenario_text(const Row& row) {
  const std::string world = replaced(row.course.world, "{seed}", std::to_string(row.seed));
  std::string out =
      fmt::format("# {}\nworld: {{{}{}}}\nduration: {}\nseed: {}\nlidar: full\n", row.about(), world,
                  row.fault.name == std::string_view("dust") ? ", dust: 0.2" : "", kLasts, row.seed);
  out += fmt::format("perception: odometry\nrobots:\n  - {{id: r1, platform: wheeled, pose: [{}]{}}}\n",
                     row.course.start, row.robot.sensors);
  out += "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 2, by: op1, do: take r1}\n";
  for (const auto& [at, command] : row.course.script)
    out += fmt::format("  - {{at: {}, by: op1, do: {}}}\n", at, command);
  if (*row.fault.text != '\0') out += "faults:\n" + fault_text(row);
  return out;
}

Result<StatedPoses> run(const Row& row, const AgentFactory& agents) {
  const auto scenario = parse_scenario(scenario_text(row), row.about());
  if (!scenario) return scenario.error();
  const auto world = make_world(scenario->world);
  if (!world) return world.error();
  StatedPoses out;
  RunParams params;
  params.seed = row.seed;
  params.workers = 1;
  params.make_agent = agents;
  params.on_truth = [&](Duration now, const Simulation& simulation) {
    out.truth(now, simulation.truth(0).pose.planar());
  };
  params.on_frame = [&](const wire::SampleEvent& frame) {
    if (frame.kind != wire::SampleEvent::Kind::delivered || frame.to_name != "op1") return;
    const auto sample = decode_sent(frame.topic, frame.type, frame.bytes);
    if (!sample) return;
    if (const auto* state = std::get_if<StateSent>(&sample->event)) out.stated(frame.at, *state);
  };
  if (const auto outcome = rehearse(*scenario, *world, params); !outcome) return outcome.error();
  return out;
}

/// The table, and what is summed up below it. Its callers hold the lock.
class Table {
 public:
  Table() {
    fmt::print(
        "world   robot    fault              seed    way   ATE m  largest  end m  3 sigma  unclaimed  "
        "beyond (until)  ok while lost (until)  unclaimed and beyond\n");
  }
  bool add(const Row& row, const StatedPoses& poses) {
    const bool holds = poses.beyond().longest <= kPatience && poses.lost().longest == 0ns;
    fmt::print(
        "{} {:6.1f} {:7.3f} {:8.3f} {:6.2f} {:6.1f} % {:8.1f} % {:5.1f} s ({:4.1f}) {:5.1f} s ({:4.1f}) "
        "{:8.1f} s  {}\n",
        row.about(), poses.way(), poses.ate(), poses.largest(), poses.end(), 100.0 * poses.within(),
        100.0 * poses.unclaimed(), seconds(poses.beyond().longest), seconds(poses.beyond().ended),
        seconds(poses.lost().longest), seconds(poses.lost().ended), seconds(poses.silent().longest),
        holds ? "holds" : "FAILS");
    std::fflush(stdout);
    ++rows_;
    failed_ += !holds;
    claimed_ += poses.claimed();
    within_ += poses.within_count();
    at_once_ += poses.at_once();
    ratios_.insert(ratios_.end(), poses.ratios().begin(), poses.ratios().end());
    return holds;
  }
  bool sum_up() {
    const double share = claimed_ == 0 ? 0.0 : static_cast<double>(within_) / static_cast<double>(claimed_);
    fmt::print(
        "telemetry: {} of {} rows hold; {:.1f} % of the claimed poses within three sigma (must {:.0f} to "
        "{:.0f}), {:.1f} % at the very instant of the state; median error {:.2f} sigma\n",
        rows_ - failed_, rows_, 100.0 * share, 100.0 * kLeast, 100.0 * kMost,
        claimed_ == 0 ? 0.0 : 100.0 * static_cast<double>(at_once_) / static_cast<double>(claimed_),
        median());
    return failed_ == 0 && share >= kLeast && share <= kMost;
  }

 private:
  double median() {
    if (ratios_.empty()) return 0.0;
    const auto middle = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 2);
    std::nth_element(ratios_.begin(), middle, ratios_.end());
    return *middle;
  }
  std::size_t rows_{}, failed_{}, claimed_{}, within_{}, at_once_{};
  std::vector<double> ratios_{};
};

std::vector<Row> rows_of(const TelemetryOptions& options) {
  const auto wanted = [&](std::initializer_list<const char*> names) {
    // Each word must be one of the three; words of one kind are alternatives.
    const auto named = [&](auto& all, const char* name) {
      bool any = false, found = false;
      for (const auto& each : all)
        if (std::find(options.only.begin(), options.only.end(), each.name) != options.only.end()) {
          any = true;
          found = found || std::string_view(each.name) == name;
        }
      return !any || found;
    };
    return named(courses(), *names.begin()) && named(kRobots, *(names.begin() + 1)) &&
           named(kFaults, *(names.begin() + 2));
  };
  std::vector<Row> out;
  for (int n = 1; n <= options.seeds; ++n)
    for (const Course& course : courses())
      for (const RobotKind& robot : kRobots)
        for (const FaultKind& fault : kFaults)
          if ((*robot.sensors != '\0' || !fault.imu) && (course.by_hand || !fault.by_hand) &&
              wanted({course.name, robot.name, fault.name}))
            out.push_back({course, robot, fault, static_cast<std::uint64_t>(n)});
  return out;
}

}  // namespace

Result<bool> print_telemetry(const TelemetryOptions& options) {
  const auto agents = make_agent_factory();
  if (!agents) return agents.error();
  const std::vector<Row> rows = rows_of(options);
  Table table;
  std::optional<Error> broken;
  {
    std::atomic<std::size_t> next{0};
    std::mutex printing;
    const auto work = [&] {
      for (std::size_t n = next++; n < rows.size(); n = next++) {
        const auto poses = run(rows[n], *agents);
        const std::lock_guard lock(printing);
        if (!poses) {
          broken = poses.error();
          next = rows.size();
        } else if (!table.add(rows[n], *poses) && !options.scenarios.empty()) {
          const std::string name = replaced(fmt::format("{}_{}_{}_{}", rows[n].course.name,
                                                        rows[n].robot.name, rows[n].fault.name, rows[n].seed),
                                            " ", "_");
          std::ofstream(options.scenarios + "/" + name + ".yaml") << scenario_text(rows[n]);
        }
      }
    };
    constexpr int kThreads = 2;
    std::vector<std::jthread> threads;
    for (int n = 0; n < kThreads; ++n) threads.emplace_back(work);
  }
  if (broken) return *broken;
  return table.sum_up();
}

}  // namespace adit::bench
