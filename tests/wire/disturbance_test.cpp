// SPDX-License-Identifier: Apache-2.0
// Faults of the rehearsal's radio: each kind, and several at once.
#include <gtest/gtest.h>

#include "core/wire/memory/simulated_network.hpp"

namespace adit::wire {
namespace {

constexpr TopicInfo kNumbers{"adit/test_numbers", "Number", QosClass::state, 1, false, 64};

/// One writer and one reader on two machines; counts what arrives.
struct Pair {
  explicit Pair(LinkProfile link = {.latency = 0.01}) : network(scheduler, {.link = std::move(link)}) {
    a = network.join(77, "a"), b = network.join(77, "b"), c = network.join(77, "c");
    writer = std::move(a->make_writer(kNumbers, "")).value();
    back = std::move(b->make_writer(kNumbers, "")).value();
    reader = hear(*b, at_b);
    back_reader = hear(*a, at_a);
    c_reader = hear(*c, at_c);
    scheduler.run_until(2s);
  }
  std::unique_ptr<RawReader> hear(Participant& wire, std::vector<std::uint8_t>& seen) {
    return std::move(wire.make_reader(kNumbers, "", *strand,
                                      [&seen](auto bytes, const SampleInfo&) {
                                        seen.push_back(bytes[4]);
                                        return true;
                                      }))
        .value();
  }
  void send(int count, Duration apart = 20ms) {
    for (int i = 0; i < count; ++i) {
      const std::array<std::uint8_t, 8> sample{0, 1, 0, 0, ++number};
      (void)writer->write(sample);
      (void)back->write(sample);
      scheduler.run_until(scheduler.elapsed() + apart);
    }
    scheduler.run_until(scheduler.elapsed() + 1s);
  }

  VirtualScheduler scheduler{1};
  SimulatedNetwork network;
  std::unique_ptr<Runtime> machine{scheduler.machine("main", 0ms)};
  std::shared_ptr<Executor> strand{machine->strand("main")};
  std::unique_ptr<Participant> a{}, b{}, c{};
  std::vector<std::uint8_t> at_a{}, at_b{}, at_c{};
  std::unique_ptr<RawWriter> writer{}, back{};
  std::unique_ptr<RawReader> reader{}, back_reader{}, c_reader{};
  std::uint8_t number{};
};

TEST(Disturbance, AOneWayCutCutsOneWay) {
  Pair pair;
  const auto cut = pair.network.disturb({.from = {"a"}, .to = {"b"}, .both_ways = false, .cut = true});
  pair.send(10);
  EXPECT_EQ(pair.at_b.size(), 0U);
  EXPECT_EQ(pair.at_a.size(), 10U);
  pair.network.end_disturbance(cut);
  pair.send(10);
  EXPECT_EQ(pair.at_b.size(), 10U);
}

TEST(Disturbance, OverlappingCutsEndAlone) {
  Pair pair;
  const auto one = pair.network.disturb({.from = {"a"}, .to = {"b"}, .cut = true});
  const auto two = pair.network.disturb({.from = {"b"}, .cut = true});
  pair.network.end_disturbance(one);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 0U);
  pair.network.end_disturbance(one);  // twice does no harm
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 0U);
  pair.network.end_disturbance(two);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 5U);
}

TEST(Disturbance, TheSwitchesDoNotEndOthers) {
  Pair pair;
  const auto one = pair.network.disturb({.from = {"a"}, .to = {"b"}, .loss = 1.0});
  pair.network.degrade("b", "a", 0.5);
  pair.network.degrade("a", "b", std::nullopt);
  pair.network.cut("a", "b", true);
  pair.network.cut("b", "a", false);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 0U);
  pair.network.end_disturbance(one);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 5U);
}

TEST(Disturbance, APartitionKeepsGroupsApartAndLeavesTheRest) {
  Pair pair;
  const auto apart = pair.network.disturb({.groups = {{"a"}, {"b"}}, .cut = true});
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 0U);
  EXPECT_EQ(pair.at_c.size(), 10U);  // hears both
  pair.network.end_disturbance(apart);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 5U);
}

TEST(Disturbance, ReorderedAndDuplicatedMessagesAreNeitherDoubledNorTurned) {
  Pair pair;
  (void)pair.network.disturb({.reorder = 0.5, .reorder_by = 100ms, .duplicate = 0.5});
  pair.send(100);
  EXPECT_LT(pair.at_b.size(), 95U);  // best effort: what comes late is dropped
  EXPECT_GT(pair.at_b.size(), 30U);
  EXPECT_TRUE(std::is_sorted(pair.at_b.begin(), pair.at_b.end()));
  EXPECT_EQ(std::adjacent_find(pair.at_b.begin(), pair.at_b.end()), pair.at_b.end());
}

TEST(Disturbance, DelayAndSlownessAreFelt) {
  Pair pair({.bandwidth = 1e6, .latency = 0.01});
  const auto first = [&] {
    pair.at_b.clear();
    const std::array<std::uint8_t, 8> sample{0, 1, 0, 0, ++pair.number};
    (void)pair.writer->write(sample);
    const Duration start = pair.scheduler.elapsed();
    while (pair.at_b.empty()) pair.scheduler.run_until(pair.scheduler.elapsed() + 1ms);
    return pair.scheduler.elapsed() - start;
  };
  pair.scheduler.run_until(pair.scheduler.elapsed() + 8s);  // the first announcements are over
  EXPECT_LE(first(), 15ms);
  const auto late = pair.network.disturb({.from = {"a"}, .delay = 300ms});
  EXPECT_GE(first(), 310ms);
  pair.network.end_disturbance(late);
  pair.scheduler.run_until(5s);
  (void)pair.network.disturb({.from = {"a"}, .slower = 100});
  EXPECT_GE(first(), 80ms);  // 100 B and more at 10 kbit/s
}

TEST(Disturbance, WallsAttenuateLinksThatFade) {
  Pair pair({.latency = 0.01, .range = 100, .fading = 2.5});
  EXPECT_FALSE(pair.network.signal("a", "b"));
  pair.network.set_position("a", 0, 0);
  pair.network.set_position("b", 10, 0);
  EXPECT_NEAR(*pair.network.signal("a", "b"), -38, 1e-9);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 5U);
  pair.network.set_attenuation([](const Position& from, const Position& to) {
    return from.x < 5 && to.x > 5 ? 60.0 : 0.0;  // a wall that is thick from one side
  });
  EXPECT_NEAR(*pair.network.signal("a", "b"), -98, 1e-9);
  pair.send(5);
  EXPECT_EQ(pair.at_b.size(), 5U);
  EXPECT_EQ(pair.at_a.size(), 10U);
}

TEST(Disturbance, AWindowOfOneSecondDropsTheRest) {
  Pair pair({.bandwidth = 20e3, .latency = 0.01, .window = 1});
  pair.scheduler.run_until(20s);
  for (int i = 0; i < 100; ++i) {
    const std::array<std::uint8_t, 8> sample{0, 1, 0, 0, 1};
    (void)pair.writer->write(sample);
    pair.scheduler.run_until(pair.scheduler.elapsed() + 10ms);
  }
  // 2500 B a second; two readers, 100 B each.
  EXPECT_GT(pair.at_b.size(), 8U);
  EXPECT_LT(pair.at_b.size(), 16U);
}

}  // namespace
}  // namespace adit::wire
