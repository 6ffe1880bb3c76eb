// SPDX-License-Identifier: Apache-2.0
#include "core/component/component.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "core/component/local_topic.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/supervisor/unit.hpp"

namespace adit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Sample final : public Component {
 public:
  using Component::after;
  using Component::Component;
  using Component::compute;
  using Component::every;
  using Component::guard;
  using Component::post;
  ~Sample() override { stop(); }
  Result<void> on_start() override {
    if (fail_start) throw std::runtime_error("no sensor");
    timer = every(1s, [this] { ++ticks; });
    return refuse ? Result<void>(Reason::in_use, "port in use") : Result<void>{};
  }
  void on_stop() override { ++stops; }
  bool fail_start{false}, refuse{false};
  int ticks{0}, stops{0};
  Timer timer{};
};

struct Fixture : testing::Test {
  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 50s)};
  std::shared_ptr<Executor> strand{machine->strand("main")};
  std::shared_ptr<MemoryLog> memory{std::make_shared<MemoryLog>()};
  Log log{memory, "r1"};
};
using ComponentTest = Fixture;

TEST_F(ComponentTest, beats_while_its_loop_turns) {
  Sample sample("mux", *strand, log);
  EXPECT_FALSE(sample.health().running);
  ASSERT_TRUE(sample.start());
  EXPECT_EQ(sample.start().reason(), Reason::in_use);
  scheduler.run_until(2s);
  EXPECT_EQ(sample.ticks, 2);
  const ComponentHealth h = sample.health();
  EXPECT_EQ(h.name, "mux");
  EXPECT_TRUE(h.healthy);
  EXPECT_EQ(h.heartbeats, 10u);
  EXPECT_LE(h.beat_age, 200ms);
}

// A replaced strand is gone while the writer of a topic still knows its subscriber.
TEST_F(ComponentTest, a_topic_outlives_the_strands_of_its_subscribers) {
  LocalTopic<int> topic(*strand);
  std::vector<int> seen;
  auto old = machine->strand("old");
  const Subscription gone = topic.subscribe(*old, [&](const auto& x) { seen.push_back(-*x); });
  const Subscription here = topic.subscribe(*strand, [&](const auto& x) { seen.push_back(*x); });
  topic.publish(1);
  scheduler.run_until(1s);
  old.reset();
  const auto next = machine->strand("next");  // most likely at the address of the one that is gone
  topic.publish(2);
  scheduler.run_until(2s);
  EXPECT_THAT(seen, ElementsAre(1, -1, 2));
}

TEST_F(ComponentTest, a_silent_loop_is_unhealthy_for_a_watcher) {
  Sample sample("mux", *strand, log);
  ASSERT_TRUE(sample.start());
  scheduler.run_until(1s);
  const auto health_state = sample.health_state();
  EXPECT_TRUE(health_state->health(strand->now() + 900ms).healthy);
  EXPECT_FALSE(health_state->health(strand->now() + 1100ms).healthy);
  EXPECT_TRUE(health_state->health(strand->now() + 1100ms).running);
}

TEST_F(ComponentTest, an_exception_becomes_a_failure_and_the_rest_goes_on) {
  Sample sample("mux", *strand, log);
  std::vector<ComponentFailure> failures;
  sample.on_failure([&](const ComponentFailure& f) { failures.push_back(f); });
  ASSERT_TRUE(sample.start());
  const Timer once = sample.after(1500ms, [] { throw std::runtime_error("broken tree"); });
  scheduler.run_until(3s);
  EXPECT_EQ(sample.ticks, 3);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failures[0].component, "mux");
  EXPECT_EQ(failures[0].text, "broken tree");
  EXPECT_EQ(failures[0].at.time_since_epoch(), 51500ms);
  EXPECT_EQ(failures[0].count, 1u);
  EXPECT_EQ(scheduler.failures(), 0u);  // it never reached the scheduler
  EXPECT_FALSE(sample.health().healthy);
  EXPECT_EQ(sample.health().last_failure, "broken tree");
  EXPECT_THAT(memory->lines(), ElementsAre("[   51.500000] error mux: failed: broken tree"));
  scheduler.run_until(12s);
  EXPECT_TRUE(sample.health().healthy);
  EXPECT_EQ(sample.health().failures, 1u);
}

TEST_F(ComponentTest, callbacks_are_dropped_after_stop_and_after_destruction) {
  int called = 0;
  std::function<void(int)> callback;
  std::shared_ptr<const HealthState> health_state;
  {
    Sample sample("mux", *strand, log);
    ASSERT_TRUE(sample.start());
    health_state = sample.health_state();
    callback = sample.guard([&called](int n) { called += n; });
    callback(2);
    sample.post([&called] { called += 100; });
    sample.stop();
    callback(10);
    EXPECT_EQ(sample.stops, 1);
    ASSERT_TRUE(sample.start());  // and what was guarded before stays dropped
    callback(10);
  }
  callback(10);
  scheduler.run_until(1s);
  EXPECT_EQ(called, 2);
  EXPECT_FALSE(health_state->health(strand->now()).running);
}

TEST_F(ComponentTest, a_start_that_fails_is_an_error_and_leaves_nothing_behind) {
  Sample throwing("slam", *strand, log);
  throwing.fail_start = true;
  const auto result = throwing.start();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().reason, Reason::internal);
  EXPECT_THAT(result.error().text, HasSubstr("slam did not start: no sensor"));
  Sample refusing("net", *strand, log);
  refusing.refuse = true;
  EXPECT_EQ(refusing.start().reason(), Reason::in_use);
  scheduler.run_until(5s);
  EXPECT_EQ(refusing.ticks, 0);
  EXPECT_FALSE(refusing.running());
  EXPECT_EQ(refusing.health().heartbeats, 0u);
}

TEST_F(ComponentTest, failed_work_is_a_failure_of_the_component) {
  Sample sample("planner", *strand, log);
  ASSERT_TRUE(sample.start());
  std::vector<bool> done;
  const auto note = [&](const Result<void>& result) { done.push_back(result.ok()); };
  sample.compute(
      {.modelled = 100ms}, [] { throw std::runtime_error("no grid"); }, note);
  sample.compute(
      {.modelled = 100ms}, [] {}, note);
  scheduler.run_until(1s);
  EXPECT_THAT(done, ElementsAre(false, true));
  EXPECT_EQ(sample.health().last_failure, "compute: no grid");
}

/// A callback of it throws while it starts, as one does that gets a sample at once.
class FailsWhileItStarts final : public Component {
 public:
  using Component::Component;
  ~FailsWhileItStarts() override { stop(); }
  Result<void> on_start() override {
    protect([] { throw std::runtime_error("first sample"); });
    return {};
  }
  void on_stop() override { ++stops; }
  int stops{0};
};

TEST_F(ComponentTest, a_callback_that_throws_during_the_start_fails_the_start) {
  FailsWhileItStarts component("slam", *strand, log);
  const auto result = component.start();
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().text, HasSubstr("first sample"));
  EXPECT_FALSE(component.running());
  EXPECT_EQ(component.stops, 1) << "what it started is stopped again";
}

TEST_F(ComponentTest, a_unit_reports_a_component_that_fails_while_it_starts) {
  UnitParams params{};
  params.name = "slam";
  params.make = [](Executor& on) -> Result<std::unique_ptr<Component>> {
    return std::unique_ptr<Component>(std::make_unique<FailsWhileItStarts>("slam", on));
  };
  Unit unit(*machine, params);
  ASSERT_TRUE(unit.open());
  unit.restart();
  scheduler.run_until(1s);
  EXPECT_TRUE(unit.health_sample().failed);
  EXPECT_THAT(unit.health_sample().text, HasSubstr("first sample"));
}

}  // namespace
}  // namespace adit
