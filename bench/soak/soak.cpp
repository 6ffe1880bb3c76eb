// SPDX-License-Identifier: Apache-2.0
// soak: four supervised agents, a station and the simulated world; an agent is killed (SIGKILL) again and
// again. The memory of the surviving processes must not grow, and none may restart by itself. Run it
// by tools/soak.sh, which gives it a network and a /dev/shm of its own.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <set>
#include <thread>

#include "bench/soak/gauge.hpp"
#include "tests/live/process.hpp"

namespace {

using namespace adit::soak;
using adit::live::eventually;
using adit::live::Folder;
using adit::live::Process;
using adit::live::Seconds;
using Clock = std::chrono::steady_clock;

constexpr Seconds kPatience(30.0);  // a busy machine is late; who is not back by then does not come back
constexpr double kLate = 5.0;       // s; reported, but no failure: the machine may be the cause

struct Options {
  double length{600.0}, every{10.0};
  int agents{4};
};

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

class Soak {
 public:
  explicit Soak(const Options& options) : options_(options), base_(adit::live::domain()) {}

  int run() {
    if (!start()) return 2;
    const auto begin = Clock::now();
    for (double next = options_.every; since(begin) < options_.length;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      sample();
      if (since(begin) < next) continue;
      next += options_.every;
      restart_one();
    }
    return report();
  }

 private:
  bool start() {
    std::string scenario =
        "world: {boxes: [], floor: 0, ceiling: 3}\nduration: 36000\nlidar: planar\nrobots:\n";
    for (int i = 1; i <= options_.agents; ++i)
      scenario += "  - {id: r" + std::to_string(i) + ", platform: wheeled, pose: [0, " +
                  std::to_string(3 * i) + ", 0]}\n";
    scenario += "basestations:\n  - {id: op1, pose: [0, 0]}\n";
    simulate_ =
        spawn({"simulate", folder_.write("soak.yaml", scenario), "--domain-base", std::to_string(base_)});
    if (!simulate_->wait_for_output("simulate: ready", Seconds(20))) return fail("no simulator");
    for (int i = 1; i <= options_.agents; ++i) {
      const std::string name = "r" + std::to_string(i);
      const std::string file = folder_.write(
          name + ".yaml", "name: " + name + "\nplatform: wheeled\npose: [0, " + std::to_string(3 * i) +
                              ", 0]\nradio: {domain: " + std::to_string(base_) + "}\nrobot_domain: " +
                              std::to_string(base_ + static_cast<unsigned>(i)) + "\nlog: error\n");
      parents_.push_back(spawn({"robot_agent", "--supervised", "--config", file}));
    }
    station_ = spawn({"basestation", "--name", "op1", "--domain", std::to_string(base_), "--serve=-1"});
    for (int i = 1; i <= options_.agents; ++i)
      if (!eventually([&] { return command({"take", "r" + std::to_string(i)}); }, Seconds(20)))
        return fail("the station does not get its robots");
    return true;
  }
  static bool fail(const char* why) {
    std::fprintf(stderr, "soak: %s\n", why);
    return false;
  }
  std::unique_ptr<Process> spawn(const std::vector<std::string>& words) {
    return std::make_unique<Process>(words, folder_.environment());
  }
  bool command(std::vector<std::string> words) {
    words.insert(words.begin(), {"basestation", "--name", "op1"});
    const auto ended = adit::live::run(words, folder_.environment());
    if (ended.exit_code != 0) refusal_ = ended.out + ended.err;
    return ended.exit_code == 0;
  }
  pid_t child(std::size_t agent) const {
    const auto found = children(parents_[agent]->pid());
    return found.empty() ? -1 : found.front();
  }

  void sample() {
    series_["simulate"].add(gauge(simulate_->pid()));
    series_["station op1"].add(gauge(station_->pid()));
    for (std::size_t i = 0; i < parents_.size(); ++i)
      series_["parent of r" + std::to_string(i + 1)].add(gauge(parents_[i]->pid()));
    // The last agent is never killed: it sees all the others come and go.
    for (std::size_t i = 0; i < parents_.size(); ++i) see_child(child(i), i);
    series_["agent r" + std::to_string(parents_.size()) + " (never killed)"].add(
        gauge(child(parents_.size() - 1)));
    const SharedMemory shared = shared_memory();
    shm_files_.push_back(static_cast<double>(shared.files));
    shm_mb_.push_back(shared.mb);
  }

  /// Another child than before, whose forerunner was not killed by us, was started because the agent gave up.
  void see_child(pid_t now, std::size_t agent) {
    children_.resize(parents_.size(), -1);
    pid_t& before = children_[agent];
    if (now <= 0 || now == before) return;
    if (before > 0 && !killed_.contains(before)) ++by_themselves_;
    before = now;
  }

  void restart_one() {
    const std::size_t agent = turn_++ % (parents_.size() - 1);
    const std::string name = "r" + std::to_string(agent + 1);
    const pid_t before = child(agent);
    if (before <= 0) {
      ++missing_;
      return;
    }
    ::kill(before, SIGKILL);
    killed_.insert(before);
    ++restarts_;
    const auto killed = Clock::now();
    const bool back = eventually([&] { return command({"take", name}); }, kPatience);
    obeys_after_.push_back(since(killed));
    const std::string x = turn_ % 2 == 0 ? "3" : "0", y = std::to_string(3 * (agent + 1));
    const bool drives = eventually([&] { return command({"goto", name, x, y}); }, kPatience);
    drives_after_.push_back(since(killed));
    if (!back || !drives) {
      ++missing_;
      std::fprintf(stderr, "restart %zu, %s: %s", restarts_, name.c_str(), refusal_.c_str());
    }
    if (drives_after_.back() > kLate) ++late_;
  }

  int report() {
    bool flat = true;
    std::printf(
        "%.0f s, %d agents, %zu restarts by SIGKILL, %d by themselves\n"
        "answers a take again after %.2f s (median), %.2f s (worst), a goto after %.2f s, %.2f s\n"
        "%d times late (a goto not accepted within %.0f s of the kill), %d times not there or not back "
        "within %.0f s\n",
        options_.length, options_.agents, restarts_, by_themselves_, median(obeys_after_),
        maximum(obeys_after_), median(drives_after_), maximum(drives_after_), late_, kLate, missing_,
        kPatience.count());
    std::printf("%-28s %26s %18s %18s\n", "", "memory MB: early, late, max", "threads", "files");
    for (const auto& [name, series] : series_) {
      const Trend m = trend(series.rss_mb), t = trend(series.threads), f = trend(series.fds);
      // Caches and tables fill up to their bounds, and a port of a neighbour that comes up under another
      // number is opened once; a leak goes on.
      const bool ok = m.growth <= m.early * 0.1 + 2.0 && t.growth < 0.5 && f.growth < 0.5 &&
                      t.late <= t.early + 2.0 && f.late <= f.early + 6.0;
      std::printf("%-28s %8.1f %8.1f %8.1f %6.0f %6.0f %4.0f %6.0f %6.0f %4.0f%s\n", name.c_str(), m.early,
                  m.late, m.max, t.early, t.late, t.max, f.early, f.late, f.max, ok ? "" : "   GROWS");
      flat = flat && ok;
    }
    const Trend files = trend(shm_files_), mb = trend(shm_mb_);
    const bool ok = files.growth <= files.early * 0.1 + 4.0 && mb.growth <= mb.early * 0.1 + 2.0;
    std::printf("%-28s %8.1f %8.1f %8.1f %18s %6.0f %6.0f %4.0f%s\n", "/dev/shm", mb.early, mb.late, mb.max,
                "", files.early, files.late, files.max, ok ? "" : "   GROWS");
    for (const auto* process : {simulate_.get(), station_.get()}) missing_ += alive(process->pid()) ? 0 : 1;
    for (const auto& parent : parents_) missing_ += alive(parent->pid()) ? 0 : 1;
    const bool there = missing_ == 0 && by_themselves_ == 0;
    std::printf("%s%s\n", flat && ok ? "flat" : "NOT FLAT", there ? "" : ", NOT ALWAYS THERE");
    return flat && ok && there ? 0 : 1;
  }
  static bool alive(pid_t pid) { return gauge(pid).rss_mb > 0.0; }

  Options options_;
  unsigned base_;
  Folder folder_{};
  std::unique_ptr<Process> simulate_{}, station_{};
  std::vector<std::unique_ptr<Process>> parents_{};
  std::map<std::string, Series> series_{};
  std::vector<double> shm_files_{}, shm_mb_{}, obeys_after_{}, drives_after_{};
  std::vector<pid_t> children_{};
  std::set<pid_t> killed_{};
  std::size_t restarts_{}, turn_{};
  int missing_{}, late_{}, by_themselves_{};
  std::string refusal_{};  // the last
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Agents that are killed again and again: does what the others hold grow?", "soak"};
  Options options;
  app.add_option("--for", options.length, "s")->check(CLI::Range(5.0, 86400.0))->capture_default_str();
  app.add_option("--every", options.every, "s between kills")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--agents", options.agents, "number of agents")
      ->check(CLI::Range(2, 4))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return Soak(options).run();
}
