// SPDX-License-Identifier: Apache-2.0
// Radio traffic of an idle fleet, live on loopback beside the simulated network, and the
// bytes of a start-up: bench_wire_traffic [SECONDS].
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/wire/idle.hpp"

namespace adit::bench {
namespace {

using wire::WireCounters;

template <class Net>
void measure(Net& net, const char* where, int pairs, Duration time) {
  std::vector<std::unique_ptr<Idle>> all;
  for (int i = 0; i < pairs; ++i) {
    all.push_back(robot(net, "r" + std::to_string(i)));
    all.push_back(station(net, "op" + std::to_string(i), pairs));
  }
  net.pass(5s);
  std::vector<WireCounters> before, after;
  for (const auto& one : all) before.push_back(one->wire->counters());
  net.pass(time);
  for (const auto& one : all) after.push_back(one->wire->counters());
  const double n = static_cast<double>(all.size()), s = seconds(time);
  double startup = 0, total = 0, discovery = 0, received = 0;
  std::map<std::string, double> topics;
  for (std::size_t i = 0; i < all.size(); ++i) {
    startup += static_cast<double>(before[i].discovery_out);
    total += static_cast<double>(after[i].total_out - before[i].total_out);
    received += static_cast<double>(after[i].total_in - before[i].total_in);
    discovery += static_cast<double>(after[i].discovery_out - before[i].discovery_out);
    for (const auto& count : after[i].topics) topics[count.topic] += static_cast<double>(count.bytes_out);
    for (const auto& count : before[i].topics) topics[count.topic] -= static_cast<double>(count.bytes_out);
  }
  std::printf(
      "%-9s %d participants: start-up discovery %6.0f B each; at rest, each: sent %6.0f B/s, received %6.0f "
      "B/s, "
      "discovery %4.0f B/s\n",
      where, 2 * pairs, startup / n, total / n / s, received / n / s, discovery / n / s);
  for (const auto& [topic, bytes] : topics) {
    if (bytes > 0) std::printf("            %-22s %7.1f B/s all together\n", topic.c_str(), bytes / s);
  }
  for (auto& one : all) one->timers.clear();
}

/// A fleet that starts on a thin link: bytes and time until every station's commands reach every robot.
template <class Net>
void start_up(const char* where, const wire::LinkProfile& link, int robots, int stations) {
  Net net(link);
  const Duration start = net.elapsed();
  std::vector<std::unique_ptr<Idle>> all;
  for (int i = 0; i < robots; ++i) all.push_back(robot(net, "r" + std::to_string(i)));
  for (int i = 0; i < stations; ++i) all.push_back(station(net, "op" + std::to_string(i), robots));
  const bool known = net.until(
      [&] {
        for (const auto& one : all) {
          for (const auto& writer : one->commands) {
            if (writer->matched() == 0) return false;
          }
        }
        return true;
      },
      120s);
  double bytes = 0, discovery = 0;
  for (const auto& one : all) {
    bytes += static_cast<double>(one->wire->counters().total_out);
    discovery += static_cast<double>(one->wire->counters().discovery_out);
  }
  std::printf(
      "start-up of %d robots, %d stations on %s, %s: all %s after %.1f s, %.0f B sent, %.0f B of them "
      "discovery\n",
      robots, stations, link.name.c_str(), where, known ? "known" : "NOT known",
      seconds(net.elapsed() - start), bytes, discovery);
  std::fflush(stdout);
  for (auto& one : all) one->timers.clear();
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit;
  const Duration time = std::chrono::seconds(argc > 1 ? std::atoi(argv[1]) : 20);
  for (const int pairs : {1, 2}) {
    if (time == 0s) break;  // start-up alone
    wire::LiveNet live;
    bench::measure(live, "live", pairs, time);
    wire::MemoryNet memory;
    bench::measure(memory, "rehearsal", pairs, time);
  }
  // As config/links has them.
  const wire::LinkProfile mesh_500k{.name = "mesh_500k", .bandwidth = 500e3, .latency = 0.05, .loss = 0.05};
  const wire::LinkProfile mesh_100k{.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1};
  for (const auto& link : {mesh_500k, mesh_100k}) {
    for (const int pairs : {1, 2}) bench::start_up<wire::MemoryNet>("rehearsal", link, pairs, pairs);
  }
  bench::start_up<wire::MemoryNet>("rehearsal", mesh_100k, 10, 1);
  bench::start_up<wire::LiveNet>("live", mesh_100k, 10, 1);
}
