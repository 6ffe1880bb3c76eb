// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <set>
#include <sstream>

#include "sim/rehearsal/scenario_file.hpp"
#include "sim/rehearsal/shrink.hpp"

namespace adit::sim {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

// The blocks of a mapping's keys that begin at the beginning of a line, without those of `dropped`; what
// comes before the first key, too.
std::string without_keys(const std::string& text, const std::set<std::string>& dropped) {
  std::istringstream lines(text);
  std::string out, line;
  bool keep = true;
  while (std::getline(lines, line)) {
    const bool key = !line.empty() && std::isalpha(static_cast<unsigned char>(line[0])) != 0;
    if (key) keep = !dropped.contains(line.substr(0, line.find(':')));
    if (keep) out += line + "\n";
  }
  return out;
}

// The same things happen in both.
bool same_events(const Scenario& a, const Scenario& b) {
  const auto script = [](const Scenario& s) {
    std::string out;
    for (const ScriptLine& l : s.script) out += fmt::format("{} {} {}\n", l.at.count(), l.by, l.command);
    for (const Fault& f : s.faults) out += to_yaml(f) + "\n";
    for (const RobotSpec& r : s.robots) out += r.id + r.platform;
    return out;
  };
  return script(a) == script(b) && a.seed == b.seed && a.duration == b.duration && !b.random &&
         !b.random_faults && a.stations.size() == b.stations.size() && a.lidar == b.lidar;
}

}  // namespace

Result<std::string> to_text(const Scenario& scenario, const Failure& failure, const std::string& file) {
  static const std::set<std::string> replaced{"duration", "seed",          "script", "random_script",
                                              "faults",   "random_faults", "expect"};
  std::string out = failure.rule > 0 ? fmt::format("# Breaks rule {} at {:.2f} s: {}\n", failure.rule,
                                                   seconds(failure.at), failure.text)
                                     : fmt::format("# Fails: {}\n", failure.text);
  out += without_keys(scenario.text, replaced);
  out += fmt::format("duration: {:.3f}\nseed: {}\n", seconds(scenario.duration), scenario.seed);
  out += scenario.script.empty() ? "" : "script:\n";
  for (const ScriptLine& line : scenario.script)
    out +=
        fmt::format("  - {{at: {:.3f}, by: {}, do: {}}}\n", seconds(line.at), line.by, quoted(line.command));
  out += scenario.faults.empty() ? "" : "faults:\n";
  for (const Fault& fault : scenario.faults) out += "  - " + to_yaml(fault) + "\n";
  for (const Expectation& e : scenario.expectations)
    if (failure.rule == 0 && e.line == failure.line && failure.line > 0)
      out += "expect:\n  - " + e.text + "\n";
  const auto again = parse_scenario(out, file);
  if (!again)
    return Error{Reason::not_supported, "cannot be written as a scenario of its own: " + again.error().text};
  if (!same_events(scenario, *again))
    return Error{Reason::not_supported,
                 "cannot be written as a scenario of its own: " + scenario.file.string() +
                     " has keys that do not begin a line, or times finer than a millisecond"};
  return out;
}

}  // namespace adit::sim
