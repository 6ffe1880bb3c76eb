// SPDX-License-Identifier: Apache-2.0
// Radio bytes a second per robot, discovery apart, at rest and while driven, for a growing fleet; beside it
// participants with Fast DDS's own defaults and the same topics, at the same time: discovery_cost [SECONDS
// [AGENTS]].
#include <sys/resource.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "bench/wire/idle.hpp"
#include "core/wire/bench/default_dds.hpp"
#include "core/wire/qos.hpp"

namespace adit::bench {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

/// The endpoints of idle.hpp's robot or station, with the library's defaults.
std::unique_ptr<DefaultDds> bare(const std::string& name, bool is_station, int robots) {
  auto one = std::make_unique<DefaultDds>(live::domain(1), name);
  const auto write = [&](const wire::TopicInfo& topic, const std::string& partition) {
    one->write(topic, partition, {});
  };
  write(wire::topics::kCapabilities, "");
  write(wire::topics::kLinkReport, "");
  write(wire::topics::kPresence, "");
  one->read(wire::topics::kCapabilities, "");
  const std::vector<wire::TopicInfo> said{wire::topics::kRobotState,   wire::topics::kAuthority,
                                          wire::topics::kBehaviour,    wire::topics::kHealth,
                                          wire::topics::kNotification, wire::topics::kAcknowledgement};
  for (const wire::TopicInfo& topic : said) is_station ? one->read(topic, "") : write(topic, "");
  if (is_station) {
    one->read(wire::topics::kLinkReport, "");
    for (int i = 0; i < robots; ++i) {
      write(wire::topics::kCommand, "r" + std::to_string(i));
      write(wire::topics::kJoystick, "r" + std::to_string(i));
    }
  } else {
    one->read(wire::topics::kCommand, name);
    one->read(wire::topics::kJoystick, name);
    one->read(wire::topics::kPresence, "");
  }
  return one;
}

constexpr std::array kClasses{wire::QosClass::urgent, wire::QosClass::stream, wire::QosClass::state,
                              wire::QosClass::status, wire::QosClass::bulk,   wire::QosClass::video};

struct Rates {
  double discovery{}, other{};
  std::array<double, kClasses.size()> payload{};  // of samples, by class: each once, however many are sent it
};

/// What one has written of each class, bytes.
std::array<double, kClasses.size()> written(const wire::WireCounters& counters,
                                            const std::vector<wire::Example>& examples) {
  std::array<double, kClasses.size()> bytes{};
  for (const wire::TopicCount& count : counters.topics)
    for (const wire::Example& example : examples)
      for (std::size_t k = 0; k < kClasses.size(); ++k)
        if (count.topic == example.topic.name && example.topic.qos == kClasses[k])
          bytes[k] += static_cast<double>(count.bytes_out);
  return bytes;
}

template <class All>
std::vector<wire::WireCounters> counters(const All& all) {
  std::vector<wire::WireCounters> result;
  for (const auto& one : all) result.push_back(one->counters());
  return result;
}
/// Sent, per participant and second.
Rates between(const std::vector<wire::WireCounters>& a, const std::vector<wire::WireCounters>& b,
              Duration time) {
  Rates rates;
  const std::vector<wire::Example> examples = wire::examples();
  const double n = static_cast<double>(a.size()) * seconds(time);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double discovery = static_cast<double>(b[i].discovery_out - a[i].discovery_out);
    rates.discovery += discovery / n;
    rates.other += (static_cast<double>(b[i].total_out - a[i].total_out) - discovery) / n;
    const auto before = written(a[i], examples), after = written(b[i], examples);
    for (std::size_t k = 0; k < kClasses.size(); ++k) rates.payload[k] += (after[k] - before[k]) / n;
  }
  return rates;
}

void print_classes(int agents, const char* when, const Rates& rates) {
  std::printf("| %2d | %s |", agents, when);
  double samples = 0.0;
  for (const double bytes : rates.payload) {
    std::printf(" %.0f |", bytes);
    samples += bytes;
  }
  std::printf(" %.0f |\n", rates.other - samples);
}

struct Measured {
  int agents{};
  Rates rest{}, drive{};
};

/// Prints a row. `agents`: robots but one, a station; alone it is a robot.
Measured measure(int agents, Duration time) {
  wire::LiveNet net;
  const int robots = std::max(1, agents - 1);
  std::vector<std::unique_ptr<Idle>> ours;
  for (int i = 0; i < robots; ++i) ours.push_back(robot(net, "r" + std::to_string(i)));
  if (agents > 1) ours.push_back(station(net, "op1", robots));
  net.pass(wire::Discovery::kInitialAnnouncements * wire::Discovery::kInitialPeriod + 2s);
  const auto all = [&] {
    std::vector<wire::WireCounters> result;
    for (const auto& one : ours) result.push_back(one->wire->counters());
    return result;
  };
  const auto started = all();
  double cpu = cpu_seconds();
  net.pass(time);
  const auto rested = all();
  cpu = cpu_seconds() - cpu;
  // One robot is driven, 20 samples a second.
  Timer sticks;
  if (agents > 1) {
    const auto& writer = ours.back()->writers.back();  // the last robot's joystick
    const std::vector<std::uint8_t> sample = [] {
      for (const wire::Example& e : wire::examples())
        if (std::string(e.topic.name) == wire::topics::kJoystick.name) return e.bytes;
      return std::vector<std::uint8_t>{};
    }();
    sticks = ours.back()->strand->every(50ms, [writer, sample] { (void)writer->write(sample); });
  }
  net.pass(time);
  const auto driven = all();
  sticks.cancel();

  std::vector<std::unique_ptr<DefaultDds>> others;
  for (int i = 0; i < robots; ++i) others.push_back(bare("r" + std::to_string(i), false, 0));
  if (agents > 1) others.push_back(bare("op1", true, robots));
  net.pass(5s);
  const auto bare_start = counters(others);
  net.pass(time);
  const auto bare_end = counters(others);

  const Rates rest = between(started, rested, time), drive = between(rested, driven, time);
  const Rates defaults = between(bare_start, bare_end, time);
  double start_ours = 0, start_bare = 0;
  for (const auto& c : started) start_ours += static_cast<double>(c.discovery_out) / agents;
  for (const auto& c : bare_start) start_bare += static_cast<double>(c.discovery_out) / agents;
  std::printf("| %2d | %6.1f | %6.1f | %5.3f | %6.0f | %6.0f | %7.0f | %7.0f | %5.2f |\n", agents,
              rest.discovery, defaults.discovery, rest.discovery / std::max(1e-9, defaults.discovery),
              rest.other, drive.other, start_ours, start_bare, 100.0 * cpu / seconds(time) / agents);
  std::fflush(stdout);
  for (auto& one : ours) one->timers.clear();
  return {agents, rest, drive};
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit;
  const Duration time = std::chrono::seconds(argc > 1 ? std::atoi(argv[1]) : 60);
  std::printf(
      "Bytes a second sent by each agent; start-up in bytes; processor in %% of a core for each.\n\n");
  std::printf("| agents | discovery | default | ratio | at rest | driven | start-up | default | CPU |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  std::vector<bench::Measured> all;
  const std::vector<int> sizes = argc > 2 ? std::vector{std::atoi(argv[2])} : std::vector{1, 2, 4, 8, 16};
  for (const int agents : sizes) all.push_back(bench::measure(agents, time));
  std::printf("\nOf it the samples of each class, and what they bring with them.\n\n");
  std::printf(
      "| agents | | urgent | stream | state | status | bulk | video | headers, copies, acknowledgements |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& one : all) {
    bench::print_classes(one.agents, "at rest", one.rest);
    bench::print_classes(one.agents, "one driven", one.drive);
  }
}
