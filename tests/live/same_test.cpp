// SPDX-License-Identifier: Apache-2.0
// The same scenario live and in rehearsal: same deliveries, like latencies.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "geometry_msgs/msg/Twist.h"
#include "sim/driver/robot_driver.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "tests/live/crew.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

using namespace std::chrono_literals;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::uint64_t samples(const wire::Participant& wire, const std::string& topic, bool out) {
  std::uint64_t sum = 0;
  for (const auto& count : wire.counters().topics)
    if (count.topic == topic) sum += out ? count.samples_out : count.samples_in;
  return sum;
}

/// From a write to the handler on its strand: one way over the bare radio, and from that handler at once over
/// the bare inner network, as a command goes through an agent. Measured between what it is compared with,
/// because it is the machine's as much as the network's: a thread that slept answers later than one that ran.
class HopMeter {
 public:
  explicit HopMeter(Net& net)
      : net_(net),
        strand_(net.machine("hop").strand("hop")),
        inner_(net, *strand_, net.join_robot("hop1"), net.join_robot("hop2"), [] {}),
        radio_(net, *strand_, net.join_radio("hop1"), net.join_radio("hop2"), [this] { inner_.write(); }) {}
  void once() {
    const std::size_t before = inner_.count();
    net_.on(*strand_, [&] { radio_.write(); });
    net_.until([&] { return inner_.count() > before; }, 1s);
  }
  double radio() const { return radio_.hop(); }
  double inner() const { return inner_.hop(); }

 private:
  class Hop {
   public:
    Hop(Net& net, Executor& strand, std::unique_ptr<wire::Participant> from,
        std::unique_ptr<wire::Participant> to, std::function<void()> then)
        : strand_(strand),
          from_(std::move(from)),
          to_(std::move(to)),
          writer_(std::move(from_->make_writer(wire::topics::kCommand, "hop")).value()),
          reader_(std::move(to_->make_reader(wire::topics::kCommand, "hop", strand,
                                             [this, then = std::move(then)](auto, const auto&) {
                                               heard_.use([this](Heard& h) {
                                                 h.hops.push_back(seconds(strand_.now() - h.sent));
                                               });
                                               then();
                                               return true;
                                             }))
                      .value()) {
      net.until([&] { return writer_->matched() == 1; });
    }
    ~Hop() { reader_.reset(); }
    Hop(const Hop&) = delete;
    Hop& operator=(const Hop&) = delete;
    /// On the strand.
    void write() {
      heard_.use([&](Heard& h) { h.sent = strand_.now(); });
      (void)writer_->write(std::vector<std::uint8_t>(120, 1));
    }
    std::size_t count() const { return heard_.get().hops.size(); }
    double hop() const { return median(heard_.get().hops); }

   private:
    struct Heard {
      Time sent{};
      std::vector<double> hops{};
    };
    Shared<Heard> heard_{};
    Executor& strand_;
    std::unique_ptr<wire::Participant> from_, to_;
    std::unique_ptr<wire::RawWriter> writer_;
    std::unique_ptr<wire::RawReader> reader_;
  };
  Net& net_;
  std::shared_ptr<Executor> strand_;
  Hop inner_, radio_;
};

constexpr const char* kPlain =
    "world: {boxes: [[20, 21, -5, 5, 0, 2]], floor: 0, ceiling: 3}\nduration: 600\nlink: lan\nlidar: planar\n"
    "robots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\nbasestations:\n  - {id: op1, pose: [0, 0]}\n";

/// The simulator: live as its own process, in rehearsal inside.
class LiveWorld {
 public:
  explicit LiveWorld(Net&) {
    if (!simulate_.wait_for_output("simulate: ready", Seconds(20))) throw std::runtime_error(simulate_.err());
  }

 private:
  Folder folder_{};
  Process simulate_{
      {"simulate", folder_.write("plain.yaml", kPlain), "--domain-base", std::to_string(domain())}};
};

class RehearsedWorld {
 public:
  explicit RehearsedWorld(Net& net)
      : strand_(net.machine("driver").strand("driver")),
        wire_(net.join_robot("driver")),
        scenario_(sim::parse_scenario(kPlain, "plain.yaml").value()),
        simulation_(sim::Simulation::create(sim::make_world(scenario_.world).value(),
                                            sim::make_starts(scenario_),
                                            sim::make_simulation_params(scenario_, 1))
                        .value()),
        driver_(simulation_, 0, *strand_, *wire_, {}) {
    step_ = strand_->every(simulation_.params().step, [this] { simulation_.step(); });
    if (const auto started = driver_.start(); !started) throw std::runtime_error(started.error().text);
  }

 private:
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  sim::Scenario scenario_;
  sim::Simulation simulation_;
  sim::RobotDriver driver_;
  Timer step_{};
};

/// Hears the driver's velocities: how many are not zero, and when each came first.
class Observer {
 public:
  struct Heard {
    int moving{};
    std::map<long, Duration> first{};  ///< First time of each velocity, mm/s.
  };
  explicit Observer(Net& net)
      : strand_(net.machine("observer").strand("observer")), wire_(net.join_robot("observer")) {
    reader_ = wire::make_reader(*wire_, wire::topics::kCmdVel, *strand_,
                                [this, &net](const geometry_msgs::msg::Twist& t, const wire::SampleInfo&) {
                                  const Duration at = net.clock();
                                  heard_.use([&](Heard& h) {
                                    if (t.linear().x() != 0.0) ++h.moving;
                                    h.first.emplace(std::lround(t.linear().x() * 1000.0), at);
                                  });
                                })
                  .value();
  }
  ~Observer() { reader_.reset(); }
  Heard heard() const { return heard_.get(); }

 private:
  Shared<Heard> heard_{};
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  std::unique_ptr<wire::RawReader> reader_{};
};

struct Played {
  std::vector<std::string> answers{};  ///< Command and reason, in order.
  std::uint64_t sticks_sent{}, sticks_heard{}, states{};
  int moving{};              ///< Velocities other than zero at the driver.
  double way{};              ///< Distance driven with the stick, m.
  double command_latency{};  ///< Median from command to acknowledgement, s.
  double stick_latency{};    ///< Median from joystick written to velocity at the driver, s.
};

/// Steers with the operator's own participant; the station's own stick is older by number, and refused.
double stick_latency(Net& net, Operator& op, const Observer& observer, const std::function<void()>& between) {
  constexpr int samples = 80, slowest = 200;  // mm/s
  std::map<long, Duration> sent;
  auto writer = wire::Writer<radio::Joystick>::make(op.radio(), wire::topics::kJoystick, "r1").value();
  net.until([&] { return writer.matched() > 0; });
  for (int i = 0; i < samples; ++i) {
    const auto view = op.view("r1");
    net.on(op.strand(), [&] {
      radio::Joystick sample;
      sample.robot("r1");
      sample.station_id(op.id());
      sample.epoch().start(view.epoch.start);
      sample.epoch().counter(view.epoch.counter);
      sample.seq(1'000'000 + static_cast<std::uint64_t>(i));
      sample.echo(view.stamp);
      sample.vx(static_cast<float>(slowest + i) * 0.001F);
      sent[slowest + i] = net.clock();
      (void)writer.write(sample);
    });
    net.pass(18ms);
    between();
    net.pass(18ms);
  }
  const auto heard = observer.heard().first;
  std::vector<double> latencies;
  for (const auto& [velocity, at] : sent)
    if (const auto found = heard.find(velocity); found != heard.end())
      latencies.push_back(seconds(found->second - at));
  EXPECT_GE(latencies.size(), patience() > 1.0 ? 1 : sent.size() * 9 / 10)
      << "velocities did not reach the driver";
  return median(latencies);
}

/// `between`: what else is done after each command and sample whose latency counts.
template <class World>
Played play(Net& net, const std::function<void()>& between) {
  agent::AgentParams params{};
  params.platform.max_speed = 2.0;
  const World world(net);
  Robot robot(net, params);
  const Observer observer(net);
  Operator op(net, "op1");
  Played played;
  const auto ask = [&](const std::string& line) {
    const auto outcome = op.ask(line);
    // What the station itself refuses has no results.
    const auto result = outcome.json.contains("results") ? outcome.json.at("results").at(0) : outcome.json;
    played.answers.push_back(line + ": " + result.at("reason").get<std::string>());
    return result.value("latency", 0.0);
  };
  ask("take r1");
  net.pass(2s);
  std::vector<double> latencies;
  for (int i = 0; i < 40; ++i) {
    latencies.push_back(ask(i % 2 == 0 ? "lock r1" : "unlock r1"));
    net.pass(20ms);
    between();
  }
  played.command_latency = median(latencies);
  ask("drive r1 0.3 0 0 --for 5");
  net.pass(1500ms);
  played.way = op.view("r1").x;
  played.sticks_sent = samples(op.radio(), "adit/joystick", true);
  played.sticks_heard = samples(robot.radio(), "adit/joystick", false);
  played.moving = observer.heard().moving;
  ask("goto r1 100000 0");
  ask("stop r1");
  ask("goto r1 1 0");
  ask("reset r1");
  ask("mode r1 waypoint");
  ask("mode r1 explore");
  ask("mode r1 hold");
  ask("release r1");
  ask("mode r1 hold");
  const auto before = samples(op.radio(), "adit/robot_state", false);
  net.pass(5s);
  played.states = samples(op.radio(), "adit/robot_state", false) - before;
  ask("take r1");
  net.pass(1200ms);
  ask("mode r1 manual");
  played.stick_latency = stick_latency(net, op, observer, between);
  return played;
}

/// Whether two latencies are within 30 % of each other, or within what it takes to wake a thread.
bool alike(double a, double b) {
  constexpr double kWake = 150e-6;  // s
  return std::abs(a - b) <= std::max(kWake, 0.3 * std::max(a, b));
}

TEST(SameScenario, LiveAndInRehearsal) {
  // A latency is the machine's as well: it has three chances, deliveries have one.
  for (int attempt = 1;; ++attempt) {
    const auto live_net = make_live_net();
    HopMeter hops(*live_net);
    const Played live = play<LiveWorld>(*live_net, [&] { hops.once(); });
    // The model knows the network it stands for, and nothing of the programs.
    wire::LinkProfile link{};
    link.bandwidth = 10e9;
    link.latency = hops.radio();
    const auto rehearsal_net = make_rehearsal_net(link, from_seconds(hops.inner()));
    const Played rehearsed = play<RehearsedWorld>(*rehearsal_net, [] {});
    std::printf(
        "hop %.0f us, inner hop %.0f us; command to answer: live %.0f us, rehearsed %.0f us; joystick to the "
        "driver: live %.0f us, "
        "rehearsed %.0f us; way: live %.2f m, rehearsed %.2f m\n",
        hops.radio() * 1e6, hops.inner() * 1e6, live.command_latency * 1e6, rehearsed.command_latency * 1e6,
        live.stick_latency * 1e6, rehearsed.stick_latency * 1e6, live.way, rehearsed.way);
    EXPECT_THAT(live.answers, testing::ElementsAreArray(rehearsed.answers));
    EXPECT_GT(live.way, 0.0);
    // Periods and latencies are the machine's as well: compared where nothing else runs.
    if (patience() > 1.0) break;
    EXPECT_NEAR(static_cast<double>(live.sticks_sent), static_cast<double>(rehearsed.sticks_sent),
                std::max(2.0, 0.02 * static_cast<double>(rehearsed.sticks_sent)));
    EXPECT_LE(live.sticks_sent - live.sticks_heard, live.sticks_sent / 50);
    EXPECT_LE(rehearsed.sticks_sent - rehearsed.sticks_heard, rehearsed.sticks_sent / 50);
    EXPECT_NEAR(static_cast<double>(live.states), static_cast<double>(rehearsed.states), 1.0);
    EXPECT_NEAR(live.moving, rehearsed.moving, 0.1 * rehearsed.moving);
    EXPECT_NEAR(live.way, rehearsed.way, 0.05 * rehearsed.way);
    if (testing::Test::HasFailure() || (alike(live.command_latency, rehearsed.command_latency) &&
                                        alike(live.stick_latency, rehearsed.stick_latency)))
      break;
    ASSERT_LT(attempt, 3) << "latencies are not within 30 % of each other";
  }
}

}  // namespace
}  // namespace adit::live
