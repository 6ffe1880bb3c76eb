// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/fault.hpp"
#include "core/component/health_state.hpp"
#include "core/exec/executor.hpp"
#include "core/exec/failure.hpp"
#include "core/log/log.hpp"
#include "core/result/result.hpp"

namespace adit {

/// A failure of a component: an exception that one of its callbacks or jobs threw, or one that it reported by
/// fail().
struct ComponentFailure {
  std::string component{};
  std::string text{};
  Time at{};
  std::uint64_t count{0};  ///< Failures of this component so far, this one included.
};

/// Base class of components that live on a strand. A component is created, started, stopped and destroyed on
/// its strand, or while that strand does not run (before its first use, after its end); the executor must
/// outlive stop().
///
/// Every callback that it passes to others goes through guard(): such a callback does nothing once the
/// component is gone, and an exception that it throws becomes a ComponentFailure instead of ending the
/// process. The heartbeat is a timer of the same loop: it stops when a callback hangs.
class Component {
 public:
  Component(std::string name, Executor& executor, Log log = {}, HealthParams health = {});
  virtual ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  /// Starts the heartbeat and calls on_start(); an exception in it is an Error (internal). A second start
  /// without a stop is an Error (in_use).
  Result<void> start();
  /// Ends the heartbeat and calls on_stop(). Callbacks are dropped from then on.
  void stop();
  bool running() const { return lifetime_ != nullptr; }

  const std::string& name() const { return health_state_->name(); }
  /// State for watchers on other strands; it outlives the component.
  std::shared_ptr<const HealthState> health_state() const { return health_state_; }
  ComponentHealth health() const { return health_state_->health(executor_.now()); }
  /// Injects a fault: makes a callback of this component throw or never return.
  void inject(ComponentFault fault);
  /// The token of this instance. What the instance passes to other strands is ignored once the supervisor has
  /// revoked the token.
  const std::shared_ptr<const Generation>& generation() const { return generation_; }
  /// Sets the generation that the supervisor revokes. Call it before start().
  void set_generation(std::shared_ptr<const Generation> generation) { generation_ = std::move(generation); }
  /// Sets the handler that receives each failure, on the strand.
  void on_failure(std::function<void(const ComponentFailure&)> handler) {
    failure_handler_ = std::move(handler);
  }

 protected:
  virtual Result<void> on_start() { return {}; }
  virtual void on_stop() {}

  Executor& executor() const { return executor_; }
  Time now() const { return executor_.now(); }
  const Log& log() const { return log_; }
  /// Reports a failure that the component itself detected.
  void fail(const std::string& text);

  /// Wraps a callback that returns nothing; it works between start() and stop() and must be called on the
  /// strand.
  template <class F>
  auto guard(F callback) {
    return [lifetime = std::weak_ptr<Lifetime>(lifetime_),
            callback = std::move(callback)](auto&&... args) mutable {
      const auto alive = lifetime.lock();
      if (!alive || !alive->owner) return;
      try {
        callback(std::forward<decltype(args)>(args)...);
      } catch (...) {
        const std::string text = current_exception_text();
        if (alive->owner) alive->owner->fail(text);
      }
    };
  }
  /// Calls the callback now, on the strand; an exception becomes a failure.
  template <class F>
  void protect(F callback) {
    guard(std::move(callback))();
  }
  /// Guarded versions of post, timers and compute.
  template <class F>
  bool post(F task) {
    return executor_.post(guard(std::move(task)));
  }
  template <class F>
  Timer after(Duration delay, F task) {
    return executor_.after(delay, guard(std::move(task)));
  }
  template <class F>
  Timer every(Duration period, F task) {
    return executor_.every(period, guard(std::move(task)));
  }
  /// Implements a service until stop(): `handler(Request, Reply<Response>)` runs on this strand for each
  /// request, and answers at once or later, from a completion. When it throws, the call completes with
  /// `cancelled`.
  template <class Request, class Response, class Handler>
  void offer(Service<Request, Response>& service, Handler handler) {
    offers_.push_back(service.offer(executor_, generation_, guard(std::move(handler))));
  }
  /// Calls a service: `done(Result<Response>)` runs on this strand exactly once, unless this component is
  /// stopped first. core/component/call.hpp has the errors.
  template <class Request, class Response, class Done>
  CallHandle call(const Service<Request, Response>& service, std::type_identity_t<Request> request,
                  CallSpec spec, Done done) {
    spec.caller = generation_;
    return service.call(executor_, std::move(request), std::move(spec), guard(std::move(done)));
  }
  /// Executor::compute with a guarded completion, which never runs once this component is stopped. An
  /// exception of `work` is a failure of this component; if the component still runs afterwards, `done`
  /// receives the Error, too.
  template <class Work, class Done>
  JobHandle compute(JobSpec spec, Work work, Done done) {
    auto failure = std::make_shared<std::string>();  // Shared by the two wrappers.
    auto completed = reporting<job_value_t<Work>>(std::move(done), failure);
    return executor_.compute(std::move(spec), catching(std::move(work), failure),
                             guard(std::move(completed)));
  }

 private:
  /// Exists from start() to stop(). Guarded callbacks hold it weakly and then do nothing.
  struct Lifetime {
    Component* owner;  ///< Null once the component has stopped, for callbacks that run at that moment.
  };

  /// Wraps `work` so that an exception becomes an Error, and stores the text of the exception in `failure`.
  template <class Work>
  static auto catching(Work work, std::shared_ptr<std::string> failure) {
    using Value = job_value_t<Work>;
    return [failure, work = std::move(work)](std::stop_token stop) mutable -> Result<Value> {
      try {
        if constexpr (std::is_same_v<decltype(run_work(work, stop)), void>) {
          run_work(work, std::move(stop));
          return {};
        } else {
          return run_work(work, std::move(stop));
        }
      } catch (...) {
        *failure = "compute: " + current_exception_text();
        return Error{Reason::internal, *failure};
      }
    };
  }
  /// Wraps `done` so that a failure of the work is reported first, which may stop the component.
  template <class Value, class Done>
  auto reporting(Done done, std::shared_ptr<std::string> failure) {
    return [this, lifetime = std::weak_ptr<Lifetime>(lifetime_), failure,
            done = std::move(done)](Result<Value> result) mutable {
      // The text may be read only after the work has returned: an Error of the executor, which can arrive
      // earlier, has another reason.
      if (result.reason() == Reason::internal && !failure->empty()) fail(*failure);
      if (const auto alive = lifetime.lock(); alive && alive->owner) done(std::move(result));
    };
  }

  Executor& executor_;
  Log log_;
  std::shared_ptr<HealthState> health_state_;
  std::shared_ptr<Lifetime> lifetime_{};
  std::shared_ptr<const Generation> generation_{std::make_shared<Generation>()};
  std::vector<Offer> offers_{};
  std::function<void(const ComponentFailure&)> failure_handler_{};
  std::uint64_t failures_{0};
  Timer heartbeat_{};
};

}  // namespace adit
