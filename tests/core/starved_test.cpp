// SPDX-License-Identifier: Apache-2.0
// Live: a component that gets no processor is not hung, one that is blocked beside it is.
#include <gtest/gtest.h>
#include <sched.h>

#include <condition_variable>
#include <ctime>
#include <map>
#include <thread>

#include "core/exec/fault.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/supervisor/supervisor.hpp"

namespace adit {
namespace {

constexpr Duration kWork = 150ms;  // of the processor, in one callback: well below what counts as hung
constexpr int kRivals = 16;

/// This thread shares one processor with all who call this.
void stay_on_one_processor() {
  cpu_set_t all, one;
  CPU_ZERO(&all);
  CPU_ZERO(&one);
  sched_getaffinity(0, sizeof all, &all);
  for (int i = CPU_SETSIZE - 1; i >= 0; --i)
    if (CPU_ISSET(i, &all)) {
      CPU_SET(i, &one);
      break;
    }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
}

Duration processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

class Plain : public Component {
 public:
  using Component::Component;
};

/// Two units, heavy and light, under a supervisor whose words are kept.
class Starved : public testing::Test {
 protected:
  static UnitParams unit(const char* name, bool dedicated) {
    UnitParams params{};
    params.name = name;
    params.dedicated = dedicated;
    params.make = [name](Executor& strand) {
      return Result<std::unique_ptr<Component>>(
          std::make_unique<Plain>(name, strand, Log{}, HealthParams{.beat = 50ms}));
    };
    return params;
  }
  Starved() {
    EXPECT_TRUE(starved.open());
    EXPECT_TRUE(other.open());
    supervisor.watch(starved, {.name = "starved", .replaceable = false});
    supervisor.watch(other, {.name = "other"});
    strand->post([this] { EXPECT_TRUE(supervisor.start()); });
    EXPECT_TRUE(wait([this] { return looks > 0; }));
  }
  ~Starved() override {
    strand->end();
    for (Unit* u : {&starved, &other}) u->end();
    supervisor.stop();
    rivals_end = true;
    for (std::thread& rival : rivals) rival.join();
  }
  /// Until the condition holds; false after a minute.
  template <class Condition>
  bool wait(Condition condition) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, 60s, condition);
  }
  template <class Change>
  void set(Change change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  }
  void let_rivals_in() {
    for (int i = 0; i < kRivals; ++i)
      rivals.emplace_back([this] {
        stay_on_one_processor();
        while (!rivals_end) {
        }
      });
  }

  std::mutex mutex{};
  std::condition_variable changed{};
  std::vector<std::string> events{};
  int looks{};
  bool escalated{}, done{};
  Duration took{};
  std::atomic<bool> rivals_end{false};
  std::vector<std::thread> rivals{};
  LiveRuntime runtime{{.compute_nice = 0}};  // all at equal priority
  Unit starved{runtime, unit("starved", true)}, other{runtime, unit("other", false)};
  std::shared_ptr<Strand> strand = runtime.strand("watch");
  Supervisor supervisor{{},
                        *strand,
                        Log{},
                        {[this](const PartEvent& event, const std::string& part) {
                           if (event.kind == PartEvent::Kind::hung) set([&] { events.push_back(part); });
                         },
                         [this](const std::string&) { set([&] { escalated = true; }); },
                         [this](Time) { set([&] { ++looks; }); }}};
};

TEST_F(Starved, DoesNotRestartAStarvedComponentAndFindsATrueHangBesideIt) {
  let_rivals_in();
  starved.slot()->strand->post([this] {
    stay_on_one_processor();
    const auto began = std::chrono::steady_clock::now();
    const Duration until = processor_time() + kWork;
    while (processor_time() < until) {
    }
    set([&] {
      took = std::chrono::steady_clock::now() - began;
      done = true;
    });
  });
  other.inject(ComponentFault::hang);
  EXPECT_TRUE(wait([this] { return !events.empty(); }));
  EXPECT_TRUE(wait([this] { return done; }));
  const int seen = looks;
  EXPECT_TRUE(wait([&] { return looks > seen + 3; }));
  EXPECT_GT(took, 1s) << "it was not starved: this shows nothing";
  EXPECT_EQ(events, std::vector<std::string>{"other"});
  EXPECT_FALSE(escalated);
  EXPECT_EQ(starved.instance(), 1u);
}

TEST_F(Starved, FindsAComponentThatRunsForTooLongWithoutReturning) {
  starved.slot()->strand->post([this] {
    const Duration until = processor_time() + 30s;
    while (processor_time() < until && !rivals_end) {
    }
  });
  EXPECT_TRUE(wait([this] { return escalated; }));
  EXPECT_EQ(events, std::vector<std::string>{"starved"});
  rivals_end = true;
}

}  // namespace
}  // namespace adit
