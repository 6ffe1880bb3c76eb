// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/program/seeds.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

#include "sim/rehearsal/program/interrupt.hpp"

namespace adit::sim {
namespace {

/// The table, and what is summed up below it. Its callers hold the lock.
class Table {
 public:
  explicit Table(SeedsOutcome& out) : out_(out) {
    std::printf("%8s %6s %9s %9s %9s %7s %9s  %s\n", "seed", "ok", "commands", "accepted", "refused",
                "faults", "speed", "digest");
  }

  void add(const RunReport& r) {
    std::printf("%8llu %6s %9llu %9llu %9llu %7llu %8.0fx  %s\n", static_cast<unsigned long long>(r.seed),
                r.ok() ? "yes" : "NO", static_cast<unsigned long long>(r.commands.sent),
                static_cast<unsigned long long>(r.commands.accepted),
                static_cast<unsigned long long>(r.commands.refused),
                static_cast<unsigned long long>(r.fault_count()), r.virtual_s / r.wall_s, r.digest.c_str());
    print_complaints(r);
    const bool first = out_.done == 0;
    out_.fewest_commands = first ? r.commands.sent : std::min(out_.fewest_commands, r.commands.sent);
    out_.fewest_faults = first ? r.fault_count() : std::min(out_.fewest_faults, r.fault_count());
    out_.commands += r.commands.sent;
    out_.faults += r.fault_count();
    out_.virtual_s += r.virtual_s;
    ++out_.done;
    if (!r.ok()) out_.failed.emplace(r.seed, r);
    if (!tty_) return;
    std::fprintf(stderr, "\r%llu of %llu, %zu failed ", static_cast<unsigned long long>(out_.done),
                 static_cast<unsigned long long>(out_.wanted), out_.failed.size());
  }

  ~Table() {
    if (tty_) std::fprintf(stderr, "\r                                        \r");
  }

 private:
  SeedsOutcome& out_;
  const bool tty_{isatty(STDERR_FILENO) == 1};
};

}  // namespace

void print_complaints(const RunReport& report) {
  for (const std::string& line : report.complaints())
    std::fprintf(stderr, "seed %llu: %s\n", static_cast<unsigned long long>(report.seed), line.c_str());
}

SeedsOutcome run_seeds(const Scenario& scenario, const std::shared_ptr<const World>& world,
                       const RunParams& params, const SeedRange& seeds, bool until_failure) {
  SeedsOutcome out;
  out.wanted = seeds.last - seeds.first + 1;
  const auto begin = std::chrono::steady_clock::now();
  {
    std::atomic<std::uint64_t> next{seeds.first};
    std::mutex printing;
    Table table(out);
    const auto work = [&] {
      for (std::uint64_t seed = next++; seed <= seeds.last && !interrupted(); seed = next++) {
        RunParams own = params;
        own.seed = seed;
        own.workers = 1;
        auto outcome = rehearse(scenario, world, own);
        const std::lock_guard lock(printing);
        if (outcome)
          table.add(outcome->report);
        else
          out.broken = outcome.error();
        if (!outcome || (until_failure && !out.failed.empty())) next = seeds.last + 1;
      }
    };
    const auto cores = std::max<std::uint64_t>(1, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (std::uint64_t i = 0; i < std::min(cores, out.wanted); ++i) threads.emplace_back(work);
  }
  out.wall_s = seconds(std::chrono::steady_clock::now() - begin);
  return out;
}

}  // namespace adit::sim
