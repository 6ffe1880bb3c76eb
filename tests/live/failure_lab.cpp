// SPDX-License-Identifier: Apache-2.0
#include "tests/live/failure_lab.hpp"

#include <signal.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "core/wire/topics.hpp"
#include "robot_agent/program/console.hpp"

namespace adit::live {
namespace {

double ms(Duration d) { return seconds(d) * 1000.0; }

/// Resident memory of a process, MB; 0 when it is gone.
double resident_memory(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  return 0.0;
}

}  // namespace

FailureLab::FailureLab()
    : driver_(*net_,
              [this](double velocity, const wire::SampleInfo& info) {
                heard_.use([&](Heard& h) {
                  h.velocities.push_back({info.received, velocity != 0.0, info.sender});
                });
              }),
      ear_strand_(net_->machine("ear").strand("ear")),
      ear_(net_->join_radio("ear")) {
  readers_.push_back(wire::make_reader(*ear_, wire::topics::kNotification, *ear_strand_,
                                       [this](const radio::Notification& n, const wire::SampleInfo& info) {
                                         heard_.use([&](Heard& h) {
                                           h.notices.emplace_back(info.received, n.code() + " " + n.text());
                                         });
                                       })
                         .value());
  readers_.push_back(wire::make_reader(*ear_, wire::topics::kAuthority, *ear_strand_,
                                       [this](const radio::AuthorityStatus& a, const wire::SampleInfo& info) {
                                         heard_.use(
                                             [&](Heard& h) { h.authorities.emplace_back(info.received, a); });
                                       })
                         .value());
  op_ = std::make_unique<Operator>(*net_, "op1");
  ::setenv("XDG_RUNTIME_DIR", folder_.environment().at("XDG_RUNTIME_DIR").c_str(), 1);  // of the console
  parent_ = std::make_unique<Process>(
      std::vector<std::string>{"robot_agent", "--supervised", "--allow-faults", "--good-run", "0", "--config",
                               "robots/r1.yaml", "--log", "error", "--domain", std::to_string(domain()),
                               "--robot-domain", std::to_string(domain(1))},
      folder_.environment());
}

FailureLab::~FailureLab() { readers_.clear(); }

Time FailureLab::now() const { return ear_strand_->now(); }

pid_t FailureLab::agent() const {
  const std::string id = std::to_string(parent_->pid());
  std::ifstream file("/proc/" + id + "/task/" + id + "/children");
  pid_t pid = 0;
  file >> pid;
  return pid;
}

bool FailureLab::ready() {
  return eventually([&] { return op_->ask("take r1").exit_code == 0; }, Seconds(20)) && eventually([&] {
           const std::string health = console("health");
           return health.find("planner") != std::string::npos && health.find("starting") == std::string::npos;
         });
}

bool FailureLab::calm() {
  return eventually([&] { return op_->ask("mode r1 hold").exit_code == 0; }) &&
         eventually([&] { return driver_.told().last == 0.0; });
}

bool FailureLab::enter(const std::string& mode) {
  goes_on_ = mode == "waypoint";
  if (!calm()) return false;
  if (mode == "hold") return true;
  if (mode == "waypoint" && !eventually([&] { return op_->ask("goto r1 60 0").exit_code == 0; }))
    return false;
  // Refused while the agent that was just started has not heard its driver yet.
  if (mode != "waypoint" && !eventually([&] { return op_->ask("mode r1 " + mode).exit_code == 0; }))
    return false;
  if (mode != "waypoint") op_->type("drive r1 0.4 0 0 --for 60");
  return eventually([&] { return driver_.told().last > 0.1; });
}

radio::Epoch FailureLab::epoch() {
  return heard_.use(
      [](Heard& h) { return h.authorities.empty() ? radio::Epoch{} : h.authorities.back().second.epoch(); });
}

std::optional<Time> FailureLab::notice(const std::string& code, Time since) {
  return heard_.use([&](Heard& h) -> std::optional<Time> {
    for (const auto& [at, text] : h.notices)
      if (at >= since && text.starts_with(code)) return at;
    return std::nullopt;
  });
}

std::optional<Time> FailureLab::new_authority(const radio::Epoch& before, Time since) {
  return heard_.use([&](Heard& h) -> std::optional<Time> {
    for (const auto& [at, status] : h.authorities)
      if (at >= since && status.epoch().start() != before.start() && status.holder() == "op1") return at;
    return std::nullopt;
  });
}

FailureLab::Killed FailureLab::kill_agent() {
  const radio::Epoch before = epoch();
  const pid_t pid = agent();
  Killed result{};
  if (pid <= 0) return result;
  const Time dead = now();
  ::kill(pid, SIGKILL);
  std::optional<Time> back;
  // Two networks: the agent's return may be heard before the parent's zero is.
  eventually([&] {
    if (!back) back = new_authority(before, dead);
    heard_.use([&](Heard& h) {
      for (const Velocity& v : h.velocities)
        if (v.at >= dead && !v.moves && !result.zero) result.zero = ms(v.at - dead);
    });
    return back && result.zero;
  });
  if (back) result.back = ms(*back - dead);
  heard_.use([&](Heard& h) {
    std::set<wire::ParticipantId> before_death;
    bool silenced = false;
    for (const Velocity& v : h.velocities) {
      if (v.at < dead) {
        before_death.insert(v.sender);
      } else if (!v.moves) {
        silenced = true;
      } else if (silenced && (!back || v.at <= *back)) {
        // What goes on by itself may do so before its station hears that it is back.
        const bool anew = goes_on_ && !before_death.contains(v.sender);
        if (!anew) ++result.moved;
      }
    }
  });
  return result;
}

std::string FailureLab::console(const std::string& line) {
  const auto answer = agent::ask_console("r1", line);
  return answer ? *answer : answer.error().text;
}

FailureLab::Failed FailureLab::fault(const std::string& kind, const std::string& component,
                                     const char* told) {
  const radio::Epoch before = epoch();
  Failed result{};
  const Time since = now();
  if (console("fault " + kind + " " + component) != "done\n") return result;
  std::optional<Time> at, back;
  eventually([&] { return (at = notice(std::string(told) + " " + component, since)).has_value(); });
  if (!at) return result;
  result.told = ms(*at - since);
  eventually([&] {
    back = notice("component_back " + component, *at);
    if (!back) back = new_authority(before, *at);
    return back.has_value();
  });
  if (back) result.back = ms(*back - since);
  return result;
}

FailureLab::Failed FailureLab::crash(const std::string& component) {
  return fault("crash", component, "component_failed");
}
FailureLab::Failed FailureLab::hang(const std::string& component) {
  return fault("hang", component, "component_hung");
}

std::optional<FailureLab::Hung> FailureLab::stay_hung(const std::string& component, std::size_t cloud_bytes,
                                                      Duration time) {
  if (op_->ask("policy r1 " + component + " manual").exit_code != 0) return std::nullopt;
  const Time since = now();
  if (console("fault hang " + component) != "done\n") return std::nullopt;
  if (!eventually([&] { return notice("component_hung " + component, since).has_value(); }))
    return std::nullopt;
  const auto strand = net_->machine("witness").strand("witness");
  const auto wire = net_->join_robot("witness");
  std::atomic<int> clouds{0};
  const auto reader = wire->make_reader(wire::topics::kPoints, "", *strand, [&](auto bytes, const auto&) {
    if (bytes.size() >= cloud_bytes) ++clouds;
    return true;
  });
  driver_.enlarge_clouds(cloud_bytes);
  Hung hung{};
  double first = 0.0;
  const pid_t pid = agent();
  constexpr int kClouds = 50;  // received, so that stored ones would show
  const Time begin = now();
  const auto goes_on = [&] {
    return now() - begin < time ||
           (clouds.load() < kClouds && now() - begin < time + from_seconds(30.0 * patience()));
  };
  for (; goes_on(); net_->pass(100ms)) {
    hung.megabytes = std::max(hung.megabytes, resident_memory(pid));
    if (now() - begin < time / 10) first = hung.megabytes;
  }
  hung.growth = hung.megabytes - first;
  hung.clouds = clouds.load();
  driver_.enlarge_clouds(0);
  return agent() == pid ? std::optional(hung) : std::nullopt;
}

bool FailureLab::fresh_agent() {
  const radio::Epoch before = epoch();
  const Time since = now();
  if (op_->ask("restart r1 agent").exit_code != 0) return false;
  return eventually([&] { return new_authority(before, since).has_value(); });
}

int FailureLab::end() {
  parent_->signal(SIGTERM);
  return parent_->wait(Seconds(10)).exit_code;
}

}  // namespace adit::live
