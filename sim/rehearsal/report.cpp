// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/report.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace adit::sim {
namespace {

using nlohmann::ordered_json;

constexpr double kFarAway = 1000.0;  // m

std::string at_text(Duration at) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", seconds(at));
  return text;
}

ordered_json rules_json(const RunReport& report) {
  ordered_json out = ordered_json::array();
  for (const RuleResult& rule : report.rules) {
    ordered_json violations = ordered_json::array();
    for (const Violation& v : rule.first)
      violations.push_back({{"at", seconds(v.at)}, {"robot", v.robot}, {"text", v.text}});
    out.push_back({{"rule", rule.number},
                   {"title", rule.title},
                   {"ok", rule.violations == 0},
                   {"count", rule.violations},
                   {"violations", violations}});
  }
  return out;
}

ordered_json robots_json(const RunReport& report) {
  ordered_json out = ordered_json::object();
  for (const auto& [id, robot] : report.robots) {
    // Far from everything: how far is not known, and of no interest.
    const ordered_json clearance =
        robot.min_clearance < kFarAway ? ordered_json(robot.min_clearance) : ordered_json();
    out[id] = {{"distance", robot.distance}, {"collisions", robot.collisions}, {"caused", robot.caused},
               {"min_clearance", clearance}, {"moving", robot.moving},         {"modes", robot.mode_seconds}};
  }
  return out;
}

ordered_json exploration_json(const ExplorationResult& result) {
  ordered_json out{{"share", result.share},
                   {"volume", result.volume},
                   {"metres", result.metres},
                   {"repeat", result.repeat},
                   {"overlap", result.overlap}};
  for (std::size_t n = 0; n < result.reached.size(); ++n)
    out[ExplorationResult::name(n)] =
        result.reached[n] ? ordered_json(result.reached[n]->time_s) : ordered_json();
  ordered_json curve = ordered_json::array();
  for (const ExplorationResult::Point& p : result.curve) curve.push_back({p.time_s, p.metres, p.share});
  out["curve"] = std::move(curve);
  return out;
}

}  // namespace

std::string RobotResult::clearance() const {
  if (min_clearance >= kFarAway) return "nothing near";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "clearance %.2f m", min_clearance);
  return text.data();
}

std::uint64_t RunReport::fault_count() const {
  std::uint64_t sum = 0;
  for (const auto& [kind, count] : faults) sum += count;
  return sum;
}

bool RunReport::ok() const { return complaints().empty(); }

std::vector<std::string> RunReport::complaints() const {
  std::vector<std::string> out;
  for (const ExpectationResult& e : expectations)
    if (!e.ok) out.push_back("expectation in line " + std::to_string(e.line) + " " + e.text + ": " + e.found);
  for (const RuleResult& rule : rules) {
    if (rule.violations == 0) continue;
    std::string line = "rule " + std::to_string(rule.number) + " (" + rule.title + ") broken " +
                       std::to_string(rule.violations) + " times";
    if (!rule.first.empty()) {
      const Violation& v = rule.first.front();
      line += ", first at " + at_text(v.at) + " by " + v.robot + ": " + v.text;
    }
    out.push_back(line);
  }
  if (failures > 0) out.push_back(std::to_string(failures) + " exceptions left a task");
  return out;
}

std::string to_json(const RunReport& report) {
  ordered_json expectations = ordered_json::array();
  for (const ExpectationResult& e : report.expectations)
    expectations.push_back({{"line", e.line}, {"expect", e.text}, {"ok", e.ok}, {"found", e.found}});
  ordered_json topics = ordered_json::object();
  for (const auto& [name, t] : report.topics)
    topics[name] = {{"samples", t.samples}, {"bytes", t.bytes}, {"delivered", t.delivered}};
  ordered_json events = ordered_json::array();
  for (const TimedEvent& e : report.events)
    events.push_back({{"at", seconds(e.at)}, {"robot", e.robot}, {"text", e.text}});
  ordered_json trajectories = ordered_json::object();
  for (const auto& [id, files] : report.trajectories)
    trajectories[id] = {{"truth", files.truth}, {"odometry", files.odometry}, {"map", files.map}};
  ordered_json out{
      {"scenario", report.scenario},
      {"digest", report.digest},
      {"seed", report.seed},
      {"ok", report.ok()},
      {"virtual_s", report.virtual_s},
      {"wall_s", report.wall_s},
      {"speedup", report.wall_s > 0.0 ? report.virtual_s / report.wall_s : 0.0},
      {"expectations", expectations},
      {"rules", rules_json(report)},
      {"robots", robots_json(report)},
      {"trajectories", trajectories},
      {"topics", topics},
      {"commands",
       {{"sent", report.commands.sent},
        {"accepted", report.commands.accepted},
        {"refused", report.commands.refused},
        {"reasons", report.commands.reasons}}},
      {"faults", report.faults},
      {"failures", report.failures},
      {"events", events},
  };
  if (report.exploration) out["exploration"] = exploration_json(*report.exploration);
  if (report.map) {
    const MapResult& map = *report.map;
    out["map"] = {{"bytes", map.bytes}, {"m2", map.m2}, {"bytes_per_m2", map.bytes_per_m2()}};
    if (map.judged)
      out["map"].update({{"by", map.by},
                         {"share", map.judged->share},
                         {"wrong", map.judged->wrong()},
                         {"wrong_occupied", map.judged->wrong_occupied},
                         {"wrong_free", map.judged->wrong_free},
                         {"seen_m2", map.judged->area}});
  }
  return out.dump(2);
}

Result<void> write_json(const RunReport& report, const std::string& file) {
  std::ofstream stream(file);
  stream << to_json(report) << '\n';
  stream.flush();
  if (!stream)
    return {Reason::cannot_write, file + ": cannot be written; check the folder and the space left"};
  return {};
}

}  // namespace adit::sim
