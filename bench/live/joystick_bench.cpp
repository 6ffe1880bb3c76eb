// SPDX-License-Identifier: Apache-2.0
// How long a stick's movement takes from the operator's station to the robot's wheels: three processes
// (station, agent, driver) over Fast DDS on loopback, beside one and two hops of bare Fast DDS with a payload
// of the same size between the same processes in the same run. Each twice, in turns: with cores that fall
// asleep between two samples, as on a machine at rest (a wake-up from there is the hypervisor's or the
// processor's, 100 us and more on a virtual machine), and awake, as on a robot that has work.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "adit/command.h"
#include "basestation/station/station.hpp"
#include "bench/live/stamps.hpp"
#include "bench/live/tapped_wire.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/wire/bench/bare_dds.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/agent.hpp"

extern char** environ;

namespace adit::bench {
namespace {

constexpr double kStep = 0.001;       // sample k is k mm/s: it is known again wherever it passes
constexpr std::size_t kPayload = 76;  // of a Joystick sample
const unsigned kRadio = 10 + static_cast<unsigned>(getpid()) % 20 * 4;  // children take it from argv

std::size_t number(double speed) { return static_cast<std::size_t>(std::lround(speed / kStep)); }

std::unique_ptr<wire::Participant> join(unsigned domain, bool inner) {
  wire::FastDdsParams params;
  params.domain = domain;
  params.large_samples = inner;
  auto opened = wire::open_fastdds(params);
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().text.c_str());
    std::exit(1);
  }
  return std::move(*opened);
}

void wait_until(const std::function<bool()>& ready, const char* what) {
  for (int i = 0; i < 15000; ++i) {
    if (ready()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::fprintf(stderr, "gave up waiting for %s\n", what);
  std::exit(1);
}

std::size_t number(std::span<const std::uint8_t> payload) {
  std::uint32_t k{};
  std::memcpy(&k, payload.data(), sizeof k);
  return k;
}

std::vector<std::uint8_t> payload(std::size_t k) {
  std::vector<std::uint8_t> bytes(kPayload);
  const auto n = static_cast<std::uint32_t>(k);
  std::memcpy(bytes.data(), &n, sizeof n);
  return bytes;
}

int robot_process(Stamps& stamps, unsigned radio) {
  auto air = join(radio, false), inner = join(radio + 1, true);
  TappedWire tapped(*inner, wire::topics::kCmdVel.name, {}, [&](std::span<const std::uint8_t> cdr) {
    geometry_msgs::msg::Twist twist;
    if (wire::decode(cdr, twist)) Stamps::note(stamps.cmd_written, number(twist.linear().x()));
  });
  BareDds* bare_pointer = nullptr;
  BareDds bare(radio + 2, "second", "first", [&](std::span<const std::uint8_t> bytes) {
    const std::size_t k = number(bytes);
    Stamps::note(stamps.bare_called, k);
    Stamps::note(stamps.second_written, k);
    if (bare_pointer) bare_pointer->write(bytes);
    Stamps::note(stamps.relayed, k);
  });
  bare_pointer = &bare;
  LiveRuntime runtime;
  agent::AgentParams params;
  params.platform.max_speed = 2.0;
  agent::Agent agent(params, runtime, *air, tapped);
  if (const auto started = agent.start(); !started) {
    std::fprintf(stderr, "%s\n", started.error().text.c_str());
    return 1;
  }
  stamps.agent_ready = true;
  while (!stamps.stop) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return 0;
}

int driver_process(Stamps& stamps, unsigned radio) {
  auto inner = join(radio + 1, true);
  LiveRuntime runtime;
  auto strand = runtime.strand("driver");
  auto odom = wire::Writer<nav_msgs::msg::Odometry>::make(*inner, wire::topics::kOdom);
  auto reader = wire::make_reader(*inner, wire::topics::kCmdVel, *strand,
                                  [&](const geometry_msgs::msg::Twist& twist, const wire::SampleInfo&) {
                                    Stamps::note(stamps.driver_called, number(twist.linear().x()));
                                  });
  BareDds bare(radio + 2, "third", "second", [&](std::span<const std::uint8_t> bytes) {
    Stamps::note(stamps.second_called, number(bytes));
  });
  if (!odom || !reader) return 1;
  nav_msgs::msg::Odometry still;
  still.pose().pose().orientation().w(1.0);
  strand->post([&] { stamps.driver_ready = true; });
  Timer beat;
  strand->post([&] {
    beat = strand->every(20ms, [&] {
      if (!odom->write(still)) std::fprintf(stderr, "odometry was not written\n");
    });
  });
  while (!stamps.stop) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  strand.reset();
  return 0;
}

pid_t start(const char* role, int fd, unsigned radio) {
  std::string self = "/proc/self/exe", name = role, memory = std::to_string(fd),
              domain = std::to_string(radio);
  char* argv[] = {self.data(), name.data(), memory.data(), domain.data(), nullptr};
  pid_t child{};
  if (posix_spawn(&child, self.c_str(), nullptr, nullptr, argv, environ) != 0) std::exit(1);
  return child;
}

/// Sample k is one of those that are taken while the cores are kept awake.
bool awake(std::size_t k) {
  constexpr std::size_t kTurn = 75;
  return k / kTurn % 2 == 1;
}

/// Threads of idle priority, one a core: no core sleeps, and each still runs other threads at once.
class Spinners {
 public:
  Spinners() {
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
      threads_.emplace_back([this] {
        const sched_param none{};
        if (sched_setscheduler(0, SCHED_IDLE, &none) != 0) std::perror("SCHED_IDLE");
        for (;;) {
          on_.wait(kOff);
          if (on_ == kEnd) return;
        }
      });
  }
  ~Spinners() {
    set(kEnd);
    for (std::thread& thread : threads_) thread.join();
  }
  void turn(bool on) { set(on ? kOn : kOff); }

 private:
  static constexpr int kOff = 0, kOn = 1, kEnd = 2;
  void set(int state) {
    on_ = state;
    on_.notify_all();
  }
  std::atomic<int> on_{kOff};
  std::vector<std::thread> threads_{};
};

void station_process(Stamps& stamps, unsigned radio) {
  auto air = join(radio, false);
  TappedWire tapped(*air, wire::topics::kJoystick.name,
                    [&](std::span<const std::uint8_t> cdr) {
                      adit::radio::Joystick sample;
                      if (wire::decode(cdr, sample)) Stamps::note(stamps.stick_written, number(sample.vx()));
                    },
                    {});
  BareDds bare(radio + 2, "first", "third", [](std::span<const std::uint8_t>) {});
  LiveRuntime runtime;
  auto strand = runtime.strand("station");
  station::StationParams params;
  params.id[0] = 1;
  std::unique_ptr<station::Station> station;
  std::atomic<bool> taken{false}, ended{false};
  std::atomic<std::uint64_t> handle{0};
  strand->post([&] {
    station = std::make_unique<station::Station>(params, *strand, tapped);
    if (const auto started = station->start(); !started) std::exit(1);
    station->execute("take r1", [&](const station::Outcome& outcome) {
      if (outcome.exit_code != 0) std::fprintf(stderr, "take: %s\n", outcome.error.c_str());
      taken = outcome.exit_code == 0;
    });
  });
  wait_until([&] { return taken.load(); }, "the robot");
  wait_until([&] { return bare.matched() && stamps.driver_ready; }, "the bare peers");
  strand->post([&] {
    handle = station->teleop("r1", [&](const station::Outcome& outcome) {
      if (!ended) std::fprintf(stderr, "teleop ended: %s%s\n", outcome.text.c_str(), outcome.error.c_str());
    });
  });
  // Until the mode is entered the stick stays centred.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  Spinners spinners;
  for (std::size_t k = 1; k < Stamps::kSamples; ++k) {
    spinners.turn(awake(k));
    strand->post([&, k] { station->stick(handle, {static_cast<double>(k) * kStep, 0.0, 0.0}); });
    std::this_thread::sleep_for(std::chrono::milliseconds(37));
    Stamps::note(stamps.bare_written, k);
    bare.write(payload(k));
    std::this_thread::sleep_for(std::chrono::milliseconds(17));
  }
  ended = true;
  std::atomic<bool> gone{false};
  strand->post([&] {
    station.reset();
    gone = true;
  });
  wait_until([&] { return gone.load(); }, "the station's end");
}

std::vector<double> hops(const Stamps::Column& from, const Stamps::Column& to, bool while_awake) {
  std::vector<double> seconds;
  for (std::size_t k = 1; k < Stamps::kSamples; ++k)
    if (awake(k) == while_awake && from[k] != 0 && to[k] > from[k])
      seconds.push_back(static_cast<double>(to[k] - from[k]) * 1e-9);
  std::sort(seconds.begin(), seconds.end());
  return seconds;
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted.empty() ? std::nan("")
                        : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

/// The measured times as a benchmark of their own, with the ratio to `peer`.
void report(const std::string& name, const std::vector<double>& times, const std::vector<double>& peer) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [times, peer](benchmark::State& state) {
                                 std::size_t i = 0;
                                 for (auto _ : state) state.SetIterationTime(times[i++ % times.size()]);
                                 state.counters["median_us"] = quantile(times, 0.5) * 1e6;
                                 state.counters["p99_us"] = quantile(times, 0.99) * 1e6;
                                 state.counters["median_ratio"] = quantile(times, 0.5) / quantile(peer, 0.5);
                                 state.counters["p99_ratio"] = quantile(times, 0.99) / quantile(peer, 0.99);
                                 state.counters["samples"] = static_cast<double>(times.size());
                               })
      ->UseManualTime()
      ->Iterations(static_cast<benchmark::IterationCount>(std::max<std::size_t>(1, times.size())));
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit::bench;
  const bool child = argc == 4 && (std::string(argv[1]) == "robot" || std::string(argv[1]) == "driver");
  const int fd = child ? std::atoi(argv[2]) : memfd_create("stamps", 0);
  if (!child && ftruncate(fd, sizeof(Stamps)) != 0) return 1;
  auto* stamps =
      static_cast<Stamps*>(mmap(nullptr, sizeof(Stamps), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
  if (stamps == MAP_FAILED) return 1;
  if (child) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const auto radio = static_cast<unsigned>(std::atoi(argv[3]));
    return std::string(argv[1]) == "robot" ? robot_process(*stamps, radio) : driver_process(*stamps, radio);
  }
  benchmark::Initialize(&argc, argv);
  const pid_t children[] = {start("robot", fd, kRadio), start("driver", fd, kRadio)};
  station_process(*stamps, kRadio);
  stamps->stop = true;
  for (const pid_t pid : children) waitpid(pid, nullptr, 0);

  for (const bool on : {true, false}) {
    const auto one = hops(stamps->bare_written, stamps->bare_called, on);
    const auto two = hops(stamps->bare_written, stamps->second_called, on);
    const std::string cores = on ? "/cores_awake" : "/cores_asleep";
    report("bare_fastdds/one_hop" + cores, one, one);
    // As to_cmd_vel_written: received, and written again.
    const auto relayed = hops(stamps->bare_written, stamps->relayed, on);
    report("bare_fastdds/hop_and_write" + cores, relayed, relayed);
    report("joystick/to_cmd_vel_written" + cores, hops(stamps->stick_written, stamps->cmd_written, on),
           relayed);
    report("bare_fastdds/two_hops" + cores, two, two);
    report("joystick/to_driver_callback" + cores, hops(stamps->stick_written, stamps->driver_called, on),
           two);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
