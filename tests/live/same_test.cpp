// The same scenario live and in rehearsal: same deliveries, like latencies.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "tests/live/driver.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

using namespace std::chrono_literals;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::uint64_t samples(const wire::Wire& wire, const std::string& topic, bool out) {
  std::uint64_t sum = 0;
  for (const auto& count : wire.counters().topics)
    if (count.topic == topic) sum += out ? count.samples_out : count.samples_in;
  return sum;
}

struct Played {
  std::vector<std::string> answers{};  ///< command and reason, in order
  std::uint64_t sticks_sent{}, sticks_heard{}, states{};
  int moving{};              ///< velocities other than zero at the driver
  double command_latency{};  ///< s, median: command to acknowledgement
};

Played play(Net& net) {
  agent::AgentParams params{};
  params.platform.max_speed = 2.0;
  Robot robot(net, params);
  PlainDriver driver(net);
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
  net.pass(1s);
  std::vector<double> latencies;
  for (int i = 0; i < 40; ++i) {
    latencies.push_back(ask(i % 2 == 0 ? "lock r1" : "unlock r1"));
    net.pass(20ms);
  }
  played.command_latency = median(latencies);
  ask("drive r1 0.3 0 0 --for 5");
  net.pass(1500ms);
  played.sticks_sent = samples(op.radio(), "adit/joystick", true);
  played.sticks_heard = samples(robot.radio(), "adit/joystick", false);
  played.moving = driver.told().moving;
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
  return played;
}

/// From a write to the handler on its strand: one way over the bare wire, s, median.
double one_hop(Net& net) {
  struct Heard {
    Time sent{};
    std::vector<double> hops{};
  };
  Shared<Heard> heard;
  const auto strand = net.machine("hop").strand("hop");
  const auto from = net.join_radio("hop1"), to = net.join_radio("hop2");
  const auto writer = std::move(from->make_writer(wire::topics::command, "hop")).value();
  auto reader = std::move(to->make_reader(wire::topics::command, "hop", *strand, [&](auto, const auto&) {
                  heard.use([&](Heard& h) { h.hops.push_back(seconds(strand->now() - h.sent)); });
                  return true;
                })).value();
  net.until([&] { return writer->matched() == 1; });
  const std::vector<std::uint8_t> payload(120, 1);
  for (std::size_t i = 1; i <= 100; ++i) {
    net.on(*strand, [&] {
      heard.use([&](Heard& h) { h.sent = strand->now(); });
      (void)writer->write(payload);
    });
    net.until([&] { return heard.get().hops.size() >= i; }, 1s);
    net.pass(20ms);
  }
  reader.reset();
  return median(heard.get().hops);
}

double apart(double a, double b) { return std::abs(a - b) / std::max(a, b); }

TEST(SameScenario, LiveAndInRehearsal) {
  // A latency is the machine's as well: it has three chances, deliveries have one.
  for (int attempt = 1;; ++attempt) {
    const auto live_net = make_live_net();
    const double hop = one_hop(*live_net);
    const Played live = play(*live_net);
    wire::LinkProfile link{};
    link.bandwidth = 10e9;
    link.latency = hop;
    const auto rehearsal_net = make_rehearsal_net(link);
    const Played rehearsed = play(*rehearsal_net);
    std::printf("hop %.0f us; command to answer: live %.0f us, rehearsed %.0f us\n", hop * 1e6,
                live.command_latency * 1e6, rehearsed.command_latency * 1e6);
    EXPECT_THAT(live.answers, testing::ElementsAreArray(rehearsed.answers));
    EXPECT_NEAR(static_cast<double>(live.sticks_sent), static_cast<double>(rehearsed.sticks_sent),
                std::max(2.0, 0.02 * static_cast<double>(rehearsed.sticks_sent)));
    EXPECT_LE(live.sticks_sent - live.sticks_heard, live.sticks_sent / 50);
    EXPECT_LE(rehearsed.sticks_sent - rehearsed.sticks_heard, rehearsed.sticks_sent / 50);
    EXPECT_NEAR(static_cast<double>(live.states), static_cast<double>(rehearsed.states), 1.0);
    EXPECT_NEAR(live.moving, rehearsed.moving, 0.1 * rehearsed.moving);
    if (testing::Test::HasFailure() || apart(live.command_latency, rehearsed.command_latency) <= 0.3) break;
    ASSERT_LT(attempt, 3) << "latency live " << live.command_latency << " s, rehearsed "
                          << rehearsed.command_latency << " s";
  }
}

}  // namespace
}  // namespace adit::live
