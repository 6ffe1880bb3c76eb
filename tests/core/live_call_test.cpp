// SPDX-License-Identifier: Apache-2.0
// Calls between threads: instances come and go while others call them.
#include <gmock/gmock.h>

#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <thread>

#include "core/component/call.hpp"
#include "core/exec/live_runtime.hpp"

namespace adit {
namespace {

/// Squares in 64 bits: the square of a call's number may exceed an int.
using WideSquares = Service<std::int64_t, std::int64_t>;

/// Offers squares from a thread of its own, by one instance after the other.
class Successors {
 public:
  /// `stay` gets the number of an instance, and returns when the next one may replace it.
  Successors(WideSquares& service, Executor& server, std::function<void(int instance)> stay)
      : thread_([this, &service, &server, stay = std::move(stay)] {
          for (int instance = 0; !over_; ++instance) {
            const auto generation = std::make_shared<Generation>();
            const Offer offer = service.offer(
                server, generation, [](std::int64_t x, const Reply<std::int64_t>& reply) { reply(x * x); });
            stay(instance);
            if (instance % 3 == 0) generation->revoke();
          }
        }) {}
  ~Successors() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// Calls in chains: the completion of a call makes the next one.
class Chains {
 public:
  Chains(WideSquares& service, Executor& caller, int calls) : service_(service), caller_(caller) {
    completions.resize(static_cast<std::size_t>(calls), 0);
  }
  std::vector<int> completions{};    ///< By call; these are the caller's strand's.
  std::map<Reason, int> outcomes{};  ///< Reason::none: answered.
  std::atomic<int> answered{0};

  /// False: not all calls complete in time.
  bool run(int chains) {
    for (int i = 0; i < chains; ++i) caller_.post([this] { next(); });
    return all_.get_future().wait_for(30s) == std::future_status::ready;
  }

 private:
  void next() {
    const std::int64_t i = begun_;
    if (i == static_cast<std::int64_t>(completions.size())) return;
    ++begun_;
    service_.call(caller_, i, {.deadline = (i % 3 == 0) ? Duration(1us) : Duration(10s)},
                  [this, i](const Result<std::int64_t>& square) {
                    if (square) {
                      EXPECT_EQ(*square, i * i);
                      ++answered;
                    }
                    ++outcomes[square.reason()];
                    ++completions[static_cast<std::size_t>(i)];
                    if (++ended_ == static_cast<int>(completions.size())) all_.set_value();
                    next();
                  });
  }
  WideSquares& service_;
  Executor& caller_;
  int begun_{}, ended_{};
  std::promise<void> all_{};
};

// Instances come and go, replies race with deadlines: each call completes exactly once, for a reason that
// Service names. Every second instance stays until it has answered a call.
TEST(LiveCall, CompletesExactlyOnceInEveryRace) {
  LiveRuntime runtime;
  const auto server = runtime.strand("server"), caller = runtime.strand("caller");
  constexpr int kCalls = 2000;
  WideSquares service{"squares", 4};
  Chains calls(service, *caller, kCalls);
  {
    std::atomic<bool> over{false};
    const Successors instances(service, *server, [&](int instance) {
      const int before = calls.answered;
      do std::this_thread::yield();
      while (instance % 2 == 1 && calls.answered == before && !over);
    });
    EXPECT_TRUE(calls.run(8));
    over = true;
  }
  caller->end();
  EXPECT_THAT(calls.completions, testing::Each(1));
  EXPECT_GT(calls.outcomes[Reason::none], 0);
  int sum = 0;
  for (const Reason reason : {Reason::none, Reason::no_answer, Reason::queue_full, Reason::cancelled})
    sum += calls.outcomes[reason];
  EXPECT_EQ(sum, kCalls);
}

// There is room for every call: an instance that is replaced while it gets a request is not a full one.
TEST(LiveCall, ThatRacesWithTheReplacementOfTheInstanceIsCancelled) {
  LiveRuntime runtime;
  const auto server = runtime.strand("server"), caller = runtime.strand("caller");
  constexpr int kCalls = 60000;
  WideSquares service{"squares", kCalls};
  Chains calls(service, *caller, kCalls);
  {
    const auto leave_at_once = [](int) {};
    const Successors some(service, *server, leave_at_once), others(service, *server, leave_at_once);
    EXPECT_TRUE(calls.run(8));
  }
  caller->end();
  EXPECT_GT(calls.outcomes[Reason::cancelled], 0);
  EXPECT_EQ(calls.outcomes[Reason::queue_full], 0);
}

}  // namespace
}  // namespace adit
