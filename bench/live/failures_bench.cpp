// SPDX-License-Identifier: Apache-2.0
// How a robot fails and comes back, live: the agent's process killed in each mode, its components crashing
// and hanging, so many times each; a table of median and worst in ms. Its radio and inner network are on
// loopback.
//   bench_failures [TIMES [kill|crash|hang]]     (50, all)
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "tests/live/failure_lab.hpp"

namespace {

using adit::live::FailureLab;

struct Series {
  std::vector<double> values{};
  int missing{};
  void add(const std::optional<double>& value) {
    if (value)
      values.push_back(*value);
    else
      ++missing;
  }
};

void print(const std::string& what, Series series, double limit) {
  std::sort(series.values.begin(), series.values.end());
  if (series.values.empty()) {
    std::printf("| %s | - | - | %.0f | %d |\n", what.c_str(), limit, series.missing);
    return;
  }
  std::printf("| %s | %.0f | %.0f | %.0f | %d |\n", what.c_str(), series.values[series.values.size() / 2],
              series.values.back(), limit, series.missing);
  std::fflush(stdout);
}

void kills(FailureLab& lab, const char* mode, int times) {
  Series zero, back;
  int moved = 0;
  for (int i = 0; i < times; ++i) {
    if (!lab.enter(mode)) {
      std::fprintf(stderr, "%s could not be entered\n", mode);
      zero.add({});
      continue;
    }
    const auto killed = lab.kill_agent();
    zero.add(killed.zero);
    back.add(killed.back);
    moved += killed.moved;
  }
  print(std::string("kill -9 in ") + mode + ": zero at the driver", zero, 300);
  print(std::string("kill -9 in ") + mode + ": agent back with its holder", back, 1000);
  if (moved > 0) std::printf("  %d velocities between zero and the new agent\n", moved);
}

void crashes(FailureLab& lab, const char* component, int times) {
  Series back;
  for (int i = 0; i < times; ++i) {
    back.add(lab.crash(component).back);
    lab.console(std::string("restart ") + component);  // resets the count of attempts
    lab.ready();
  }
  print(std::string("crash of ") + component + ": back", back, 100);
}

void hangs(FailureLab& lab, const char* component, int times) {
  Series told, back;
  for (int i = 0; i < times; ++i) {
    const auto hung = lab.hang(component);
    told.add(hung.told);
    back.add(hung.back);
    lab.calm();
    if (std::string(component) != "command") lab.fresh_agent();  // the next hang would be its second
    lab.ready();
  }
  print(std::string("hang of ") + component + ": found", told, 1000);
  print(std::string("hang of ") + component + ": back", back, 0);
}

}  // namespace

int main(int argc, char** argv) {
  const int times = argc > 1 ? std::atoi(argv[1]) : 50;
  const std::string only = argc > 2 ? argv[2] : "";
  const auto asked = [&only](const char* what) { return only.empty() || only == what; };
  FailureLab lab;
  if (!lab.ready()) {
    std::fprintf(stderr, "no agent: %s\n", lab.err().c_str());
    return 1;
  }
  std::printf("| %d times each, ms | median | worst | goal | missing |\n| --- | --- | --- | --- | --- |\n",
              times);
  if (asked("kill"))
    for (const char* mode : {"hold", "manual", "smart_joystick", "waypoint"}) kills(lab, mode, times);
  lab.calm();
  if (asked("crash"))
    for (const char* component : {"planner", "router", "sensors", "command"}) crashes(lab, component, times);
  if (asked("hang"))
    for (const char* component : {"planner", "router", "sensors", "command"}) hangs(lab, component, times);
  return lab.end();
}
