// SPDX-License-Identifier: Apache-2.0
// Round trips over our wire beside bare Fast DDS, in one process and in two: bench_wire_latency [ROUNDS
// [PACE]]. One is under way at a time; the next starts at once, or PACE milliseconds later, as commands do.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <semaphore>
#include <thread>

#include "bench/wire/echo.hpp"
#include "tests/live/process.hpp"

namespace adit::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Microseconds = std::chrono::duration<double, std::micro>;

/// One way of going there and back.
struct Path {
  const char* name{};
  std::function<void(std::span<const std::uint8_t>)> send{};
  std::vector<double> times{};
};

struct Client {
  explicit Client(unsigned domain) {
    wire = std::move(wire::open_fastdds({.domain = domain, .name = "client"})).value();
    urgent = std::move(wire->make_writer(kPingUrgent, "")).value();
    stream = std::move(wire->make_writer(kPingStream, "")).value();
    const auto pong = [this](auto, const wire::SampleInfo&) { return arrived(), true; };
    urgent_in = std::move(wire->make_reader(kPongUrgent, "", *strand, pong)).value();
    stream_in = std::move(wire->make_reader(kPongStream, "", *strand, pong)).value();
    bare = std::make_unique<BareDds>(domain, "bare/ping", "bare/pong", [this](auto) { arrived(); });
  }
  void arrived() {
    at = SteadyClock::now();
    back.release();
  }
  bool matched() const { return bare->matched() && urgent->matched() > 0 && stream->matched() > 0; }

  SteadyClock::time_point at{};
  std::counting_semaphore<64> back{0};
  LiveRuntime runtime{};
  std::shared_ptr<Executor> strand{runtime.strand("client")};
  std::unique_ptr<wire::Participant> wire{};
  std::unique_ptr<wire::RawWriter> urgent{}, stream{};
  std::unique_ptr<wire::RawReader> urgent_in{}, stream_in{};
  std::unique_ptr<BareDds> bare{};
};

void measure(const char* where, unsigned domain, int rounds, std::chrono::milliseconds pace,
             std::size_t size) {
  Client client(domain);
  if (!live::eventually([&] { return client.matched(); })) {
    std::printf("%s: not matched\n", where);
    return;
  }
  // The pongs' readers are matched a moment after the pings' writers.
  live::eventually([] { return false; }, live::Seconds(0.5));
  std::vector<std::uint8_t> payload(size);
  payload[1] = 1;
  Path paths[] = {{"bare Fast DDS", [&](auto bytes) { client.bare->write(bytes); }, {}},
                  {"wire, stream", [&](auto bytes) { (void)client.stream->write(bytes); }, {}},
                  {"wire, urgent", [&](auto bytes) { (void)client.urgent->write(bytes); }, {}}};
  for (int round = 0; round < rounds; ++round) {
    for (Path& path : paths) {  // in turns: whatever disturbs the machine disturbs all
      if (pace.count() > 0) std::this_thread::sleep_for(pace);
      const auto start = SteadyClock::now();
      path.send(payload);
      if (!client.back.try_acquire_for(std::chrono::seconds(1))) continue;
      path.times.push_back(Microseconds(client.at - start).count());
    }
  }
  for (Path& path : paths) {
    std::sort(path.times.begin(), path.times.end());
    if (path.times.empty()) continue;
    std::printf("%-14s %-14s %4zu B  round trips %5zu  median %7.1f us  p99 %7.1f us  (%.2f x bare)\n", where,
                path.name, size, path.times.size(), path.times[path.times.size() / 2],
                path.times[path.times.size() * 99 / 100],
                path.times[path.times.size() / 2] / paths[0].times[paths[0].times.size() / 2]);
  }
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 3000;
  const std::chrono::milliseconds pace(argc > 2 ? std::atoi(argv[2]) : 0);
  const unsigned domain = adit::live::domain(0), other = adit::live::domain(1);
  {
    const adit::bench::Echo echo(domain);
    adit::bench::measure("one process", domain, rounds, pace, 96);
  }
  adit::live::Process process({"wire_echo", std::to_string(other)});
  if (!process.wait_for_output("ready", adit::live::Seconds(10))) return 1;
  adit::bench::measure("two processes", other, rounds, pace, 96);
}
