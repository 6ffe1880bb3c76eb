// SPDX-License-Identifier: Apache-2.0
// What happens on the radio when somebody misbehaves: two robots and a station over Fast DDS, an operator who
// drives one and stops the other, and an attacker on the same network. Each row is one kind of attack
// (docs/wire.md). Runs in a network namespace of its own.
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <thread>

#include "basestation/station/station.hpp"
#include "bench/attack/attacker.hpp"
#include "core/contract/refusals.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/agent.hpp"

namespace adit::bench {
namespace {

using namespace std::chrono_literals;
using namespace wire::test;
using Clock = std::chrono::steady_clock;

constexpr unsigned kRadio = 20;

[[noreturn]] void give_up(const std::string& what) {
  std::fprintf(stderr, "bench_attack: %s\n", what.c_str());
  std::_Exit(2);
}

/// Puts this process into a network of its own with loopback alone.
void leave_the_network() {
  const uid_t user = getuid();
  if (unshare(user == 0 ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    std::fprintf(stderr, "bench_attack: skipped: no network namespace can be made here\n");
    std::_Exit(77);
  }
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::snprintf(request.ifr_name, sizeof request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK | IFF_MULTICAST;
  if (ioctl(fd, SIOCSIFFLAGS, &request) != 0) give_up("loopback does not come up");
  close(fd);
}

std::unique_ptr<wire::Participant> join(unsigned domain, bool inner) {
  wire::FastDdsParams params;
  params.domain = domain;
  params.large_samples = inner;
  auto opened = wire::open_fastdds(params);
  if (!opened) give_up(opened.error().text);
  return std::move(*opened);
}

/// Runs the work on the strand and waits for its end.
template <class Work>
void on(Executor& strand, Work work) {
  std::atomic<bool> done{false};
  strand.post([&] {
    work();
    done = true;
    done.notify_all();
  });
  done.wait(false);
}

double megabytes() {
  std::ifstream file("/proc/self/statm");
  long all{}, resident{};
  file >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double processor() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

/// A robot with a driver that obeys exactly.
class TestRobot {
 public:
  TestRobot(LiveRuntime& runtime, const std::string& name, unsigned inner_domain)
      : strand_(runtime.strand(name + " driver")),
        radio_(join(kRadio, false)),
        inner_(join(inner_domain, true)),
        driver_(join(inner_domain, true)) {
    agent::AgentParams params;
    params.name = name;
    params.platform.max_speed = 2.0;
    agent_ = std::make_unique<agent::Agent>(params, runtime, *radio_, *inner_);
    if (const auto started = agent_->start(); !started) give_up(started.error().text);
    odom_ = wire::Writer<nav_msgs::msg::Odometry>::make(*driver_, wire::topics::kOdom).value();
    reader_ = wire::make_reader(*driver_, wire::topics::kCmdVel, *strand_,
                                [this](const geometry_msgs::msg::Twist& twist, const wire::SampleInfo&) {
                                  received_ = twist.linear().x();
                                  if (heard) heard(twist.linear().x());
                                })
                  .value();
    on(*strand_, [this] {
      timer_ = strand_->every(20ms, [this] {
        x_ += received_ * 0.02;
        nav_msgs::msg::Odometry o;
        o.pose().pose().position().x(x_);
        o.pose().pose().orientation().w(1.0);
        o.twist().twist().linear().x(received_);
        (void)odom_.write(o);
      });
    });
  }
  ~TestRobot() {
    reader_.reset();
    on(*strand_, [this] { timer_ = {}; });
  }
  wire::Participant& radio() { return *radio_; }

  std::function<void(double velocity)> heard{};  ///< On the driver's strand; set it before it is driven.

 private:
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> radio_, inner_, driver_;
  std::unique_ptr<agent::Agent> agent_{};
  wire::Writer<nav_msgs::msg::Odometry> odom_{};
  std::unique_ptr<wire::RawReader> reader_{};
  Timer timer_{};
  double received_{}, x_{};
};

struct Measured {
  std::vector<double> stops{}, sticks{};  ///< Of those that were answered, ms.
  int asked{};
  double silence{};  ///< Longest time without a state of one of the robots, s.
  double growth{};   ///< Resident memory, MB.
  double cpu{};      ///< Processor time per second, s.
  double hangs{};    ///< For how long a receiving thread has processed one datagram at the end, s.
  std::optional<double> newcomer{};  ///< Time until a station that joins afterwards stops a robot, s.
  wire::RefusalCounts refused{};
  double quantile(const std::vector<double>& all, double q) const {
    if (all.empty()) return std::nan("");
    std::vector<double> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
};

/// Two robots and a station: r1 is driven by the stick, r2 is stopped again and again.
class Service {
 public:
  Service()
      : r1_(runtime_, "r1", kRadio + 1),
        r2_(runtime_, "r2", kRadio + 2),
        strand_(runtime_.strand("station")),
        radio_(join(kRadio, false)) {
    r1_.heard = [this](double velocity) {
      const auto k = static_cast<std::size_t>(std::lround(velocity / kStep));
      if (k == 0 || k >= written_.size()) return;
      const double t = written_[k].exchange(0.0);
      if (t > 0.0) {
        const std::lock_guard lock(mutex_);
        measured_.sticks.push_back(now() - t);
      }
    };
    station::StationParams params;
    params.name = "operator";
    params.id[0] = 1;
    on(*strand_, [&] {
      station_ = std::make_unique<station::Station>(params, *strand_, *radio_);
      if (const auto started = station_->start(); !started) give_up(started.error().text);
    });
    for (const char* line : {"take r1", "take r2"}) {
      bool taken = false;
      for (int i = 0; i < 100 && !taken; ++i) taken = ask(line, 1s).has_value();
      if (!taken) give_up(std::string(line) + " was not answered");
    }
    on(*strand_, [this] {
      stick_ = station_->teleop(
          "r1", [this](const station::Outcome& outcome) { ended_ = outcome.text + outcome.error; });
    });
    // Until the mode is entered the stick stays centred.
    bool manual = false;
    for (int i = 0; i < 100 && !manual; ++i) {
      std::this_thread::sleep_for(100ms);
      on(*strand_, [&] {
        const auto robot = station_->fleet().robots().find("r1");
        manual = robot != station_->fleet().robots().end() && robot->second.mode == "manual";
      });
    }
    if (!manual) give_up("r1 is not in manual: " + ended_);
  }
  ~Service() {
    on(*strand_, [this] { station_.reset(); });
  }

  const wire::ParticipantId station_id() const { return radio_->id(); }
  wire::ParticipantId robot_id(int n) { return n == 1 ? r1_.radio().id() : r2_.radio().id(); }

  /// Time to the answer, ms; nothing when there is none in time.
  std::optional<double> ask(const std::string& line, Duration limit) {
    return ask_of(*strand_, *station_, line, limit);
  }
  static std::optional<double> ask_of(Executor& strand, station::Station& station, const std::string& line,
                                      Duration limit) {
    struct Answer {
      std::atomic<int> code{-1};
    };
    const auto answer = std::make_shared<Answer>();
    const double begin = now();
    strand.post([&station, line, answer] {
      station.execute(line, [answer](const station::Outcome& outcome) {
        answer->code = outcome.exit_code;
        answer->code.notify_all();
      });
    });
    while (answer->code < 0 && now() - begin < seconds(limit) * 1e3) std::this_thread::sleep_for(100us);
    return answer->code == 0 ? std::optional(now() - begin) : std::nullopt;
  }

  /// Measures for that time; `each_second` is called at its start and once a second.
  Measured measure(double time, const std::function<void()>& each_second) {
    const double memory = megabytes(), processor_before = processor();
    const wire::RefusalCounts before = refused();
    {
      const std::lock_guard lock(mutex_);
      measured_ = {};
    }
    std::atomic<bool> ends{false};
    std::thread stick([&] {
      while (!ends) {
        const std::size_t k = 1 + count_++ % (kSpeeds - 1);
        written_[k] = now();
        strand_->post([this, k] { station_->stick(stick_, {static_cast<double>(k) * kStep, 0.0, 0.0}); });
        std::this_thread::sleep_for(7ms);
      }
    });
    std::thread attack([&] {
      while (!ends) {
        if (each_second) each_second();
        for (int i = 0; i < 100 && !ends; ++i) std::this_thread::sleep_for(10ms);
      }
    });
    Measured result;
    for (const double begin = now(); now() - begin < time * 1e3;) {
      ++result.asked;
      if (const auto answered = ask("stop r2", 1s)) result.stops.push_back(*answered);
      on(*strand_, [&] {
        for (const char* name : {"r1", "r2"}) {
          const auto& robots = station_->fleet().robots();
          const auto robot = robots.find(name);
          const double silent =
              robot == robots.end() ? 99.0 : seconds(strand_->now() - robot->second.last_heard);
          result.silence = std::max(result.silence, silent);
        }
      });
      std::this_thread::sleep_for(50ms);
    }
    result.cpu = (processor() - processor_before) / time;
    ends = true;
    stick.join();
    attack.join();
    const wire::RefusalCounts after = refused();
    for (std::size_t i = 0; i < after.size(); ++i) result.refused[i] = after[i] - before[i];
    result.growth = megabytes() - memory;
    for (wire::Participant* one : {&r1_.radio(), &r2_.radio(), radio_.get()})
      result.hangs = std::max(result.hangs, seconds(one->counters().receiving));
    result.newcomer = newcomer();
    const std::lock_guard lock(mutex_);
    result.sticks = measured_.sticks;
    return result;
  }

  /// A second station starts, and stops r2; the time of it, s.
  std::optional<double> newcomer() {
    const double begin = now();
    const auto strand = runtime_.strand("newcomer");
    const auto radio = join(kRadio, false);
    station::StationParams params;
    params.name = "newcomer" + std::to_string(++newcomers_);
    params.id[0] = static_cast<std::uint8_t>(1 + newcomers_);
    std::unique_ptr<station::Station> station;
    on(*strand, [&] {
      station = std::make_unique<station::Station>(params, *strand, *radio);
      if (const auto started = station->start(); !started) give_up(started.error().text);
    });
    std::optional<double> result;
    while (!result && now() - begin < 5e3)
      if (ask_of(*strand, *station, "stop r2", 500ms)) result = (now() - begin) / 1e3;
    (void)ask_of(*strand, *station, "reset r2", 500ms);
    on(*strand, [&] { station.reset(); });
    return result;
  }

  wire::RefusalCounts refused() {
    wire::RefusalCounts sum{};
    for (wire::Participant* one : {&r1_.radio(), &r2_.radio(), radio_.get()}) {
      const auto counts = one->counters().refused;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += counts[i];
    }
    return sum;
  }

 private:
  static constexpr double kStep = 0.001;  // In m/s: the speed identifies the sample.
  static constexpr std::size_t kSpeeds = 400;
  static double now() {
    return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count();
  }

  LiveRuntime runtime_{};
  std::array<std::atomic<double>, kSpeeds> written_{};
  std::size_t count_{};
  std::mutex mutex_{};
  Measured measured_{};
  TestRobot r1_, r2_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> radio_;
  std::unique_ptr<station::Station> station_{};
  std::uint64_t stick_{};
  int newcomers_{};
  std::string ended_{};  ///< Why the driving ended.
};

constexpr std::uint64_t kHuge = 1ULL << 61, kFar = 1ULL << 40;

struct Row {
  const char* name;
  const char* what;
  std::function<void(Attacker&, Service&)> attack;
};

wire::ParticipantId invented(std::size_t i) {
  wire::ParticipantId id = participant(0x77);
  id[2] = static_cast<std::uint8_t>(i), id[3] = static_cast<std::uint8_t>(i >> 8);
  return id;
}

Bytes gone(std::uint32_t by, const wire::ParticipantId& of, std::uint32_t entity, std::uint64_t number) {
  return data(reader_of(by), by, number, {},
              list({parameter(0x70, guid(of, entity)), parameter(0x71, {0, 0, 0, 3})}));
}

std::vector<Row> rows() {
  // Each writer of the attacker numbers its samples without a gap, or readers wait for the missing ones.
  static std::map<std::uint32_t, std::uint64_t> numbers{{kAnnouncer, 1}};
  const auto next = [](std::uint32_t writer) { return ++numbers[writer]; };
  static std::uint64_t forged = 1'000'000;  // Beyond those of the participants whose names are used.
  const auto own = [](Attacker& a, const std::vector<Bytes>& parts) {
    a.to_all(rtps_message(a.id(), parts));
  };
  const auto in_name = [](Attacker& a, const wire::ParticipantId& of, const std::vector<Bytes>& parts) {
    a.to_all(rtps_message(of, parts));
  };
  const auto command_writer = [](Attacker& a, Service& s) {
    const auto entity = a.writer(s.station_id(), wire::topics::kCommand.name);
    return entity.value_or(0x00000103);
  };
  return {
      {"1", "vendor submessage of kind 0x80, not the last",
       [=](Attacker& a, Service&) {
         own(a, {submessage(0x80, Bytes(56)), heartbeat(kPublications, 1, 0)});
         in_name(a, participant(0x55), {submessage(0x80, Bytes(56)), heartbeat(kPublications, 1, 0)});
       }},
      {"2", "HEARTBEAT from 2^61 by an announced participant",
       [=](Attacker& a, Service&) {
         for (const std::uint32_t writer : {kPublications, kSubscriptions})
           own(a, {heartbeat(writer, kHuge, kHuge)});
       }},
      {"3", "GAP 1 to 2^40", [=](Attacker& a, Service&) { own(a, {gap(kPublications, 1, kFar)}); }},
      {"4", "GAP and HEARTBEAT in the name of the station's command writer",
       [=](Attacker& a, Service& s) {
         const std::uint32_t writer = command_writer(a, s);
         in_name(a, s.station_id(), {gap(writer, 1, 1000)});
         in_name(a, s.station_id(), {heartbeat(writer, kFar, kFar, 1'000'000)});
         in_name(a, s.station_id(), {gap(writer, 1, kFar)});
       }},
      {"5", "that the station's command writer is gone",
       [=](Attacker& a, Service& s) {
         const std::uint32_t writer = command_writer(a, s);
         own(a, {gone(kPublications, s.station_id(), writer, next(kPublications))});
         in_name(a, s.station_id(), {gone(kPublications, s.station_id(), writer, ++forged)});
       }},
      {"6", "that both robots and the station are gone",
       [=](Attacker& a, Service& s) {
         for (const auto& id : {s.robot_id(1), s.robot_id(2), s.station_id()}) {
           own(a, {gone(kAnnouncer, id, 0x1c1, next(kAnnouncer))});
           in_name(a, id, {gone(kAnnouncer, id, 0x1c1, ++forged)});
         }
       }},
      {"7", "fragments of samples of 2 GB, 1 GB and 50 MB",
       [=](Attacker& a, Service&) {
         constexpr std::uint32_t writer = 0x00000303;
         own(a, {endpoint(kPublications, a.id(), writer, wire::topics::kHealth.name, next(kPublications))});
         own(a, {fragment(writer, next(writer), 1, 1, 1000, 2'000'000'000, 1000)});
         own(a, {fragment(kPublications, next(kPublications), 1, 1, 1000, 2'000'000'000, 1000)});
         for (int i = 0; i < 20; ++i)
           own(a, {fragment(kPublications, next(kPublications), 1, 1, 1000, 1'000'000'000, 1000)});
         for (int i = 0; i < 100; ++i)
           own(a, {fragment(kPublications, next(kPublications), 1, 1, 1000, 50'000'000, 1000)});
       }},
      {"8", "500 invented participants with leases of years",
       [=](Attacker& a, Service&) {
         for (std::size_t i = 0; i < 500; ++i)
           in_name(a, invented(i),
                   {announcement(invented(i), {locator("127.0.0.9", a.victim_port())}, 100'000'000)});
         for (std::size_t i = 0; i < 500; ++i)
           in_name(a, invented(500 + i), {announcement(invented(500 + i), {a.own_locator()}, 100'000'000)});
       }},
      {"8b", "1 000 invented readers that receive elsewhere",
       [=](Attacker& a, Service&) {
         for (std::uint32_t i = 0; i < 1000; ++i)
           own(a, {endpoint(kSubscriptions, a.id(), 0x00100004 + (i << 8), wire::topics::kRobotState.name,
                            next(kSubscriptions), {locator("127.0.0.9", a.victim_port())})});
       }},
      {"11", "a robot's state with number 2^40, and the station's reader elsewhere",
       [=](Attacker& a, Service& s) {
         const auto writer = a.writer(s.robot_id(1), wire::topics::kRobotState.name).value_or(0x203);
         in_name(a, s.robot_id(1), {data(0, writer, kFar, Bytes(64))});
         in_name(a, s.station_id(),
                 {endpoint(kSubscriptions, s.station_id(), 0x207, wire::topics::kRobotState.name, ++forged,
                           {a.own_locator()})});
       }},
      {"14", "announcements of the robots with a lease of 0 s, elsewhere",
       [=](Attacker& a, Service& s) {
         for (const int n : {1, 2})
           in_name(a, s.robot_id(n), {announcement(s.robot_id(n), {a.own_locator()}, 0, ++forged)});
       }},
  };
}

}  // namespace

int run(const std::vector<std::string>& chosen, double time) {
  leave_the_network();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  Service service;
  Attacker attacker(kRadio);
  // It is a participant that the others know: they have sent it their endpoints.
  for (int i = 0; i < 30; ++i) {
    attacker.announce();
    std::this_thread::sleep_for(100ms);
  }
  std::printf("the station's command writer: %08x\n",
              attacker.writer(service.station_id(), wire::topics::kCommand.name).value_or(0));
  const auto header = [] {
    std::printf("%-4s %-62s %9s %9s %9s %9s %8s %7s %5s %6s %8s %9s %9s  %s\n", "row", "what arrives",
                "answered", "stop p50", "stop p99", "stick p99", "silent s", "MB", "cpu", "hangs", "newcomer",
                "to it kB", "other kB", "refused");
  };
  const auto show = [&](const char* name, const char* what, const Measured& m) {
    const auto [own, other] = attacker.received();
    std::printf("%-4s %-62s %4zu/%-4d %9.1f %9.1f %9.2f %8.1f %7.1f %5.2f %6.1f %8.2f %9.1f %9.1f  %s\n",
                name, what, m.stops.size(), m.asked, m.quantile(m.stops, 0.5), m.quantile(m.stops, 0.99),
                m.quantile(m.sticks, 0.99), m.silence, m.growth, m.cpu, m.hangs,
                m.newcomer.value_or(std::nan("")), static_cast<double>(own) / 1e3,
                static_cast<double>(other) / 1e3, contract::describe(m.refused).c_str());
  };
  header();
  (void)service.measure(2.0, {});
  (void)attacker.received();
  const Measured base = service.measure(time, {});
  show("-", "nothing", base);
  constexpr double kJoystick = 1.5, kFloor = 2.0, kSilent = 3.0, kMemory = 50.0;
  const double stick_limit = std::max(kJoystick * base.quantile(base.sticks, 0.99), kFloor);
  int failed = 0;
  for (const Row& row : rows()) {
    if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), row.name) == chosen.end()) continue;
    const Measured m = service.measure(time, [&] {
      attacker.announce();
      row.attack(attacker, service);
    });
    show(row.name, row.what, m);
    std::string why;
    if (m.stops.size() != static_cast<std::size_t>(m.asked)) why += " a stop was not answered;";
    if (m.silence > kSilent) why += " a robot was silent;";
    if (m.growth > kMemory) why += " memory grew;";
    if (!(m.quantile(m.sticks, 0.99) <= stick_limit)) why += " the stick was late;";
    if (m.hangs > 1.0) why += " a receiving thread hangs;";
    if (!m.newcomer) why += " a station that joins later cannot stop a robot;";
    if (why.empty()) continue;
    ++failed;
    std::printf("     row %s does not hold:%s\n", row.name, why.c_str());
  }
  std::printf("%s\n", failed == 0 ? "all rows hold" : (std::to_string(failed) + " rows do not hold").c_str());
  return failed == 0 ? 0 : 1;
}

}  // namespace adit::bench

int main(int argc, char** argv) {
  CLI::App app{
      "Attacks two robots and a station over Fast DDS in a network of its own, and measures what is left "
      "of their service.\n\nExamples:\n  bench_attack\n  bench_attack --row 2 --row 8b --seconds 30"};
  std::vector<std::string> chosen;
  double seconds = 8.0;
  app.add_option("--row", chosen, "Only these rows");
  app.add_option("--seconds", seconds, "Time of each row")->check(CLI::Range(2.0, 3600.0));
  CLI11_PARSE(app, argc, argv);
  return adit::bench::run(chosen, seconds);
}
