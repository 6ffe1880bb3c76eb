// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/mux.hpp"

#include <gmock/gmock.h>

namespace adit::agent {
namespace {

struct MotionLog : NavigationInput {
  void accept(MuxKey, const Motion& motion, Time) override { passed.push_back(motion); }
  std::vector<Motion> passed{};
};

// Rule 5 at compile time: only the mux can write to navigation.
template <class Input>
concept AnyoneCanWrite = requires(Input& input) {
  input.accept({}, Motion{Stand{}}, Time{});
};
static_assert(!AnyoneCanWrite<NavigationInput>);
static_assert(!AnyoneCanWrite<MotionLog>);
static_assert(!std::is_default_constructible_v<MuxKey>);
static_assert(!std::is_aggregate_v<MuxKey>);

constexpr Velocity kSlow{{0.2, 0, 0}};
constexpr Velocity kFast{{1.0, 0, 0}};

class MuxTest : public testing::Test {
 protected:
  Motion last() const { return nav.passed.back(); }
  void settle() {
    now += 50ms;
    mux.step(now);
    nav.passed.clear();
  }
  MotionLog nav{};
  Mux mux{nav};
  Mux::Output a{mux.connect("a", 300ms)}, b{mux.connect("b", 300ms)};
  Time now{Duration{1h}};
};

TEST_F(MuxTest, NothingPassesUntilASourceIsEnabled) {
  a.write(kSlow, now);
  EXPECT_TRUE(nav.passed.empty());
  mux.step(now);
  EXPECT_EQ(last(), Motion{Stand{}});
  EXPECT_FALSE(mux.fresh(now));
}

TEST_F(MuxTest, OnlyTheEnabledSourcePassesAndAtOnce) {
  mux.enable("a", now);
  settle();
  b.write(kFast, now);
  EXPECT_TRUE(nav.passed.empty());
  a.write(kSlow, now);
  EXPECT_THAT(nav.passed, testing::ElementsAre(Motion{kSlow}));
  mux.step(now);
  EXPECT_EQ(last(), Motion{kSlow});
}

TEST_F(MuxTest, ChangeOfSourcePassesThroughZeroForAPeriod) {
  mux.enable("a", now);
  settle();
  a.write(kSlow, now);
  mux.enable("b", now);
  EXPECT_EQ(last(), Motion{Stand{}});
  b.write(kFast, now);
  mux.step(now + 49ms);
  EXPECT_THAT(nav.passed, testing::ElementsAre(Motion{kSlow}, Motion{Stand{}}, Motion{Stand{}}));
  mux.step(now + 50ms);
  EXPECT_EQ(last(), Motion{kFast});
}

TEST_F(MuxTest, EnablingTheSameSourceAgainIsNoChange) {
  mux.enable("a", now);
  settle();
  a.write(kSlow, now);
  mux.enable("a", now);
  EXPECT_EQ(last(), Motion{kSlow});
}

TEST_F(MuxTest, OutputBeforeEnablingMovesNothing) {
  b.write(kFast, now);
  mux.enable("b", now);
  now += 60ms;
  mux.step(now);
  EXPECT_EQ(last(), Motion{Stand{}});
}

TEST_F(MuxTest, SilentSourceBecomesZeroAtItsAge) {
  mux.enable("a", now);
  settle();
  a.write(kSlow, now);
  mux.step(now + 299ms);
  EXPECT_EQ(last(), Motion{kSlow});
  EXPECT_TRUE(mux.fresh(now + 299ms));
  mux.step(now + 300ms);
  EXPECT_EQ(last(), Motion{Stand{}});
  EXPECT_FALSE(mux.fresh(now + 300ms));
}

TEST_F(MuxTest, UnknownNameEnablesNothing) {
  mux.enable("a", now);
  settle();
  mux.enable("c", now);
  EXPECT_FALSE(mux.fresh(now));
  a.write(kSlow, now);
  b.write(kSlow, now);
  EXPECT_FALSE(mux.fresh(now));
  EXPECT_EQ(last(), Motion{Stand{}});
}

}  // namespace
}  // namespace adit::agent
