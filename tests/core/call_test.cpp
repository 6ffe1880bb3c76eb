// SPDX-License-Identifier: Apache-2.0
#include "core/component/call.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "core/component/component.hpp"
#include "core/component/local_topic.hpp"
#include "core/exec/fault.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/supervisor/unit.hpp"

namespace adit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Squares = Service<int, int>;

/// Offers squares: at once, after modelled work, never, or not without failing.
class Mathematician final : public Component {
 public:
  enum class Mood { answers, computes, stores, drops, throws, hangs };
  Mathematician(Executor& strand, Squares& service, Mood mood)
      : Component("squares", strand), service_(service), mood_(mood) {}
  ~Mathematician() override { stop(); }

  int asked{};
  std::vector<Reply<int>> stored{};

 private:
  Result<void> on_start() override {
    offer(service_, [this](int x, const Reply<int>& reply) {
      ++asked;
      if (mood_ == Mood::answers) reply(x * x);
      if (mood_ == Mood::stores) stored.push_back(reply);
      if (mood_ == Mood::throws) throw std::runtime_error("no square");
      if (mood_ == Mood::hangs) hang(executor());
      if (mood_ == Mood::computes)
        compute(
            {.modelled = 1s}, [x] { return x * x; },
            [reply](Result<int> square) { reply(std::move(square)); });
    });
    return {};
  }
  Squares& service_;
  Mood mood_;
};
using Mood = Mathematician::Mood;

/// Asks, and writes down what comes back and when.
class Asker final : public Component {
 public:
  using Component::Component;
  using Component::set_generation;
  CallHandle ask(const Squares& service, int x, Duration deadline = 10s) {
    return call(service, x, {.deadline = deadline}, [this](Result<int> square) {
      results.push_back(square ? *square : -static_cast<int>(square.reason()));
      texts.push_back(square ? "" : square.error().text);
      at.push_back(now());
    });
  }
  std::vector<int> results{};  ///< Squares; negative: the number of a reason.
  std::vector<std::string> texts{};
  std::vector<Time> at{};
};

constexpr int kNoAnswer = -static_cast<int>(Reason::no_answer);
constexpr int kQueueFull = -static_cast<int>(Reason::queue_full);
constexpr int kCancelled = -static_cast<int>(Reason::cancelled);

class CallTest : public testing::Test {
 protected:
  CallTest() { EXPECT_TRUE(asker->start()); }
  std::unique_ptr<Mathematician> offering(Mood mood) {
    auto made = std::make_unique<Mathematician>(*server, service, mood);
    EXPECT_TRUE(made->start());
    return made;
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }
  UnitParams unit_params() {
    UnitParams params{};
    params.name = "squares";
    params.make = [this](Executor& strand) -> Result<std::unique_ptr<Component>> {
      return std::unique_ptr<Component>(std::make_unique<Mathematician>(strand, service, mood_of_next));
    };
    return params;
  }

  Mood mood_of_next{Mood::answers};
  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 50s)};
  std::shared_ptr<Strand> server{machine->strand("server")}, caller{machine->strand("caller")};
  Squares service{"squares", 2};
  std::unique_ptr<Asker> asker{std::make_unique<Asker>("asker", *caller)};
};

TEST_F(CallTest, IsAnsweredInALaterTaskOfTheCaller) {
  const auto callee = offering(Mood::answers);
  asker->ask(service, 3);
  EXPECT_THAT(asker->results, ElementsAre());
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(9));
}

TEST_F(CallTest, WithoutAnOfferCompletesAtOnce) {
  asker->ask(service, 3);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kNoAnswer));
  EXPECT_THAT(asker->texts[0], HasSubstr("squares: no component offers it now"));
}

TEST_F(CallTest, CompletesAtItsDeadlineInModelledTimeAndNotAgain) {
  const auto callee = offering(Mood::computes);
  const Time begin = caller->now();
  asker->ask(service, 3, 999ms);
  run(5s);
  EXPECT_THAT(asker->results, ElementsAre(kNoAnswer));
  EXPECT_EQ(asker->at[0] - begin, 999ms);
  asker->ask(service, 3, 1001ms);
  run(5s);
  EXPECT_THAT(asker->results, ElementsAre(kNoAnswer, 9));
}

TEST_F(CallTest, BeyondTheBoundIsRefusedUntilAnAnswerIsGiven) {
  const auto callee = offering(Mood::stores);
  for (int x : {1, 2, 3}) asker->ask(service, x);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kQueueFull));
  callee->stored.front()(1);
  callee->stored.erase(callee->stored.begin());
  asker->ask(service, 4);
  run(1ms);
  EXPECT_EQ(callee->asked, 3);
  EXPECT_THAT(asker->results, ElementsAre(kQueueFull, 1));
}

// One that is too late for its caller still occupies the component that works on it.
TEST_F(CallTest, ARequestCountsUntilTheComponentIsDoneWithIt) {
  const auto callee = offering(Mood::stores);
  for (int x : {1, 2}) asker->ask(service, x, 1ms);
  run(1s);
  EXPECT_FALSE(callee->stored.front().wanted());
  asker->ask(service, 3);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kNoAnswer, kNoAnswer, kQueueFull));
}

TEST_F(CallTest, ThatIsCancelledCompletesOnceAndTheComponentKnows) {
  const auto callee = offering(Mood::stores);
  const CallHandle first = asker->ask(service, 1);
  run(1ms);
  first.cancel();
  first.cancel();
  EXPECT_FALSE(callee->stored.front().wanted());
  callee->stored.front()(1);
  const CallHandle second = asker->ask(service, 2);
  second.cancel();
  run(1s);
  EXPECT_EQ(callee->asked, 1) << "the second never reached it";
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, kCancelled));
}

TEST_F(CallTest, IsCancelledWhenItsReplyIsDropped) {
  const auto callee = offering(Mood::drops);
  asker->ask(service, 1);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled));
}

TEST_F(CallTest, AnExceptionOfTheHandlerIsItsFailureAndCancelsTheCall) {
  const auto callee = offering(Mood::throws);
  asker->ask(service, 1);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled));
  EXPECT_EQ(callee->health().failures, 1u);
  EXPECT_EQ(asker->health().failures, 0u);
}

TEST_F(CallTest, ToAComponentThatStopsIsCancelledAndTheNextInstanceAnswers) {
  auto callee = offering(Mood::computes);
  asker->ask(service, 3);
  run(500ms);
  callee->stop();
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled));
  callee = offering(Mood::answers);
  asker->ask(service, 4);
  run(2s);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, 16));
}

TEST_F(CallTest, ToAReplacedInstanceIsCancelledAndItsLateAnswerIsIgnored) {
  const auto old = offering(Mood::stores);
  asker->ask(service, 3);
  run(1ms);
  const auto next = offering(Mood::answers);
  old->stored.front()(-9);
  asker->ask(service, 5);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, 25));
  EXPECT_EQ(old->asked, 1);
}

TEST_F(CallTest, AnAnswerOfARevokedInstanceNeverArrives) {
  const auto generation = std::make_shared<Generation>();
  Mathematician callee(*server, service, Mood::stores);
  callee.set_generation(generation);
  ASSERT_TRUE(callee.start());
  asker->ask(service, 3);
  run(1ms);
  callee.stored.front()(9);  // on its way to the caller
  generation->revoke();
  asker->ask(service, 4);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, kNoAnswer));
}

TEST_F(CallTest, ARevokedInstanceDoesNotReplaceTheOneThatOffers) {
  const auto good = offering(Mood::answers);
  const auto generation = std::make_shared<Generation>();
  Mathematician late(*server, service, Mood::answers);  // its construction took longer than it may
  late.set_generation(generation);
  generation->revoke();
  ASSERT_TRUE(late.start());
  asker->ask(service, 4);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(16));
  EXPECT_EQ(good->asked, 1);
}

TEST_F(CallTest, ARequestOfARevokedCallerHasNoEffect) {
  const auto callee = offering(Mood::answers);
  const auto generation = std::make_shared<Generation>();
  Asker replaced("replaced", *caller);
  replaced.set_generation(generation);
  ASSERT_TRUE(replaced.start());
  replaced.ask(service, 3);
  generation->revoke();
  run(1ms);
  EXPECT_EQ(callee->asked, 0);
}

TEST_F(CallTest, OfACallerThatIsGoneEndsInNothing) {
  const auto callee = offering(Mood::computes);
  asker->ask(service, 3);
  asker->ask(service, 4);
  run(1ms);
  asker.reset();
  run(5s);
  asker = std::make_unique<Asker>("asker", *caller);
  ASSERT_TRUE(asker->start());
  asker->ask(service, 5);
  run(5s);
  EXPECT_THAT(asker->results, ElementsAre(25)) << "the two before it are done with";
  caller->end();
  asker->ask(service, 6);
  run(5s);
}

TEST_F(CallTest, ToARestartedUnitIsCancelledAndTheNextOneAnswered) {
  Unit unit(*machine, unit_params());
  ASSERT_TRUE(unit.open());
  mood_of_next = Mood::stores;
  unit.restart();
  run(1ms);
  asker->ask(service, 3);
  run(1ms);
  mood_of_next = Mood::answers;
  unit.restart();
  run(1ms);
  asker->ask(service, 4);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, 16));
  unit.end();
}

TEST_F(CallTest, ToAHungUnitEndsAtItsDeadlineOrWhenTheUnitIsReplaced) {
  Unit unit(*machine, unit_params());
  ASSERT_TRUE(unit.open());
  mood_of_next = Mood::hangs;
  unit.restart();
  run(1ms);
  asker->ask(service, 3, 500ms);
  asker->ask(service, 4, 10s);
  run(600ms);
  // The second request waited behind the first: dropped with the queue of the strand that hangs.
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, kNoAnswer));
  mood_of_next = Mood::answers;
  unit.replace();
  run(1ms);
  asker->ask(service, 5);
  run(1ms);
  EXPECT_THAT(asker->results, ElementsAre(kCancelled, kNoAnswer, 25));
}

}  // namespace
}  // namespace adit
