// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/crew/crew.hpp"

#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/folders/folders.hpp"

namespace adit::gui::crew {
namespace {

using live::eventually;
using live::Seconds;

std::string address(std::size_t number) { return "10.77.1." + std::to_string(number); }

/// The shipped wheeled platform with another speed.
std::string slow_platform(double max_speed) {
  std::ifstream in(source_folder() + "/config/platforms/wheeled.yaml");
  std::string out;
  for (std::string line; std::getline(in, line);)
    out += (line.starts_with("max_speed:") ? "max_speed: " + std::to_string(max_speed) : line) + "\n";
  return out;
}

}  // namespace

double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Crew::Crew(const Mission& mission, double max_speed)
    : mission_(mission), environment_(folder_.environment()) {
  folder_.write("slow.yaml", slow_platform(max_speed));
  for (std::size_t robot = 0; robot < kRobots; ++robot) {
    const std::string name = name_of(robot), y = std::to_string(Mission::start(robot).y);
    hosts_.add(name, address(robot + 1));
    simulations_.push_back(
        hosts_.start(name,
                     {"simulate", folder_.write(name + "_world.yaml", mission.scenario(robot)),
                      "--domain-base", "0", "--report", folder_.path() + "/" + name + ".json"},
                     environment_));
    agents_.push_back(
        hosts_.start(name,
                     {"robot_agent", "--config",
                      folder_.write(name + ".yaml", "name: " + name + "\nplatform: slow.yaml\npose: [0, " +
                                                        y + ", 0]\nrobot_domain: 1\nradio:\n  interfaces: [" +
                                                        address(robot + 1) + "]\n")},
                     environment_));
  }
  for (std::size_t number : {1, 2}) {
    const std::string name = "op" + std::to_string(number);
    hosts_.add(name, address(100 + number));
    stations_.push_back(
        hosts_.start(name, {"basestation", "--name", name, "--interface", address(100 + number), "--serve=1"},
                     environment_));
    if (!stations_.back().wait_for_output("ready", Seconds(10))) {
      failure_ = name + " does not start: " + stations_.back().err();
      return;
    }
  }
  for (const char* name : {"op1", "op2"})
    for (std::size_t robot = 0; robot < kRobots; ++robot)
      if (!eventually([&] { return shell(name, {"status", name_of(robot)}).exit_code == 0; }, Seconds(60))) {
        failure_ = std::string(name) + " does not know " + name_of(robot) + ": " + agents_[robot].err();
        return;
      }
  for (const Intervention& what : mission.interventions) due_.push_back({.what = what});
  begun_ = steady_now();
}

Crew::~Crew() = default;

live::Finished Crew::shell(const std::string& operator_name, std::vector<std::string> words) const {
  words.insert(words.begin(), {"basestation", "--name", operator_name});
  return live::run(words, environment_);
}

std::string Crew::holder_of(std::size_t robot) const {
  const auto status =
      nlohmann::json::parse(shell("op2", {"--json", "status", name_of(robot)}).out, nullptr, false);
  return status.is_object() ? status.value("holder", "") : "";
}

void Crew::tick(const std::array<Progress, kRobots>& progress) {
  const double now = steady_now();
  for (Due& due : due_) {
    if (due.over) continue;
    const Progress& at = progress[due.what.robot];
    if (due.sent_at < 0.0 && at.goals_sent == due.what.goal + 1) {
      due.sent_at = now;
      due.next = now + due.what.after;
    }
    if (due.sent_at >= 0.0 && now >= due.next) act(due, now);
  }
}

void Crew::act(Due& due, double now) {
  const std::string name = name_of(due.what.robot);
  if (due.stage == 0) {
    char line[96];
    std::snprintf(line, sizeof line, "%6.1f s  %s: %s", now - begun_, name.c_str(),
                  to_string(due.what.event));
    events_.emplace_back(line);
  }
  ++due.stage;
  switch (due.what.event) {
    case Event::blocked:
      due.over = true;  // The pillar is there from the beginning.
      return;
    case Event::stopped:
      due.over = shell("op2", {"stop", name}).exit_code == 0;
      return;
    case Event::cut:
      hosts_.link(name, due.stage == 2);
      due.next = now + 8.0;
      due.over = due.stage == 2;
      return;
    case Event::hung:
      simulations_[due.what.robot].signal(due.stage == 1 ? SIGSTOP : SIGCONT);
      due.next = now + 4.0;
      due.over = due.stage == 2;
      return;
    case Event::handover:
      // Refused while it is locked: its holder is asked, and grants it.
      if (!asked_[due.what.robot]) shell("op2", {"take", name});
      asked_[due.what.robot] = true;
      if (holder_of(due.what.robot) == "op2") {
        asked_[due.what.robot] = false;
        due.over = shell("op2", {"release", name}).exit_code == 0;
      }
      due.next = now + 1.0;
      return;
  }
}

std::size_t Crew::open() const {
  return static_cast<std::size_t>(
      std::count_if(due_.begin(), due_.end(), [](const Due& due) { return !due.over; }));
}

int Crew::contacts() {
  int touched = 0;
  for (live::Process& simulation : simulations_) {
    simulation.signal(SIGINT);
    touched += simulation.wait(Seconds(10)).exit_code == 0 ? 0 : 1;
  }
  return touched;
}

}  // namespace adit::gui::crew
