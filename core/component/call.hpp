// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/exec/generation.hpp"

/// Calls between components of one process. A Service is a named method that exists as long as the process;
/// the component that implements it offers it while it runs (Component::offer), and other components call it
/// (Component::call). core/component/README.md has an example.
namespace adit {

/// Deadline of a call, and the generation of its caller.
struct CallSpec {
  /// Time from the call to its completion, by the caller's clock, (0, 1 h]; after it the completion carries
  /// no_answer.
  Duration deadline{2s};
  /// Generation of the caller; a request of a revoked one has no effect. Null: it cannot be revoked.
  std::shared_ptr<const Generation> caller{};
};

/// A call from its start to its completion. The first call of settle() decides the result. Thread safe.
template <class R>
class PendingCall final : public JobControl, public std::enable_shared_from_this<PendingCall<R>> {
 public:
  using Done = std::function<void(Result<R>)>;

  PendingCall(std::string name, std::shared_ptr<Inbox> home, Done done)
      : name_(std::move(name)), home_(std::move(home)), done_(std::move(done)) {}

  /// Starts the deadline on the caller's strand. Call it before other threads can access the call.
  void watch(Executor& caller, Duration deadline) {
    deadline_ = caller.after(deadline, [weak = this->weak_from_this()] {
      if (const auto call = weak.lock()) call->fail(Reason::no_answer, "no answer by its deadline");
    });
  }
  /// Accepts an answer only while `callee` is valid. Call it before other threads can access the call.
  void depend_on(std::shared_ptr<const Generation> callee) { callee_ = std::move(callee); }

  bool settled() const { return settled_.load(std::memory_order_acquire); }
  void settle(Result<R> result) {
    if (settled_.exchange(true, std::memory_order_acq_rel)) return;
    home_->post_control([self = this->shared_from_this(), result = std::move(result)]() mutable {
      self->deadline_.cancel();
      if (result && self->callee_ && !self->callee_->valid())
        result = Error{Reason::cancelled, self->name_ + ": the component that answered was replaced"};
      std::exchange(self->done_, nullptr)(std::move(result));
    });
  }
  void fail(Reason reason, const std::string& why) { settle(Error{reason, name_ + ": " + why}); }
  void cancel() override { fail(Reason::cancelled, "cancelled"); }

 private:
  const std::string name_;
  const std::shared_ptr<Inbox> home_;
  Done done_;  ///< Called on the caller's strand.
  std::shared_ptr<const Generation> callee_{};
  Timer deadline_{};
  std::atomic<bool> settled_{false};
};

/// A running call, as its caller sees it; dropping the handle changes nothing.
class CallHandle {
 public:
  CallHandle() = default;
  explicit CallHandle(std::weak_ptr<JobControl> call) : call_(std::move(call)) {}
  /// Cancels the call, on the caller's strand. Unless the call is settled, its completion carries
  /// `cancelled`.
  void cancel() const {
    if (const auto call = call_.lock()) call->cancel();
  }

 private:
  std::weak_ptr<JobControl> call_{};
};

/// Sends the answer to one request. Copies share it; when the last copy is destroyed without an answer, the
/// completion carries `cancelled`. Capture it in the completion of a computation, never in its work.
template <class R>
class Reply {
 public:
  using Call = std::shared_ptr<PendingCall<R>>;
  Reply(Call call, std::shared_ptr<std::atomic<std::size_t>> in_flight)
      : slot_(std::make_shared<Slot>(std::move(call), std::move(in_flight))) {}

  /// Sends an answer; only the first one counts. Safe to call from any thread while the process lives.
  void operator()(Result<R> result) const { slot_->call->settle(std::move(result)); }
  /// False once the caller has its completion: the answer is too late, or the caller cancelled.
  bool wanted() const { return !slot_->call->settled(); }

 private:
  struct Slot {
    Slot(Call c, std::shared_ptr<std::atomic<std::size_t>> n) : call(std::move(c)), in_flight(std::move(n)) {}
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    ~Slot() {
      in_flight->fetch_sub(1, std::memory_order_acq_rel);
      call->fail(Reason::cancelled, "its request was dropped without an answer");
    }
    Call call;
    std::shared_ptr<std::atomic<std::size_t>> in_flight;
  };
  std::shared_ptr<Slot> slot_;
};

/// Withdraws a service when destroyed: pending calls complete with `cancelled`.
class [[nodiscard]] Offer {
 public:
  Offer() = default;
  explicit Offer(std::function<void()> withdraw) : withdraw_(std::move(withdraw)) {}
  Offer(Offer&& other) noexcept : withdraw_(std::exchange(other.withdraw_, nullptr)) {}
  Offer& operator=(Offer&& other) noexcept {
    if (this != &other) {
      withdraw();
      withdraw_ = std::exchange(other.withdraw_, nullptr);
    }
    return *this;
  }
  ~Offer() { withdraw(); }
  void withdraw() {
    if (const auto now = std::exchange(withdraw_, nullptr)) now();
  }

 private:
  std::function<void()> withdraw_{};
};

/// A method that one component implements for all others of its process. Components start and stop; the
/// service persists and knows which instance offers it now. Thread safe.
///
/// A call completes exactly once with Result<Response>, in a later task of the caller's strand, whatever
/// happens. Errors: no_answer (no component offers the service, or the deadline passed), queue_full (the
/// component still holds the Reply of `max_in_flight` requests), cancelled (by the caller; or the instance
/// with the request failed, was replaced, or dropped it). Only when the caller's strand ends first is there
/// no completion. An answer of a revoked instance never arrives. In rehearsal all of it happens on modelled
/// time.
template <class Request, class Response>
class Service {
 public:
  using Handler = std::function<void(Request, Reply<Response>)>;
  using Done = std::function<void(Result<Response>)>;

  /// `name`: for texts of errors; `max_in_flight`: requests that a component may hold unanswered, >= 1.
  explicit Service(std::string name, std::size_t max_in_flight = 8)
      : state_(std::make_shared<State>(std::move(name), std::max<std::size_t>(1, max_in_flight))) {}

  /// Makes `handler` receive each request on `strand`, in place of the instance that offered the service
  /// before. Answers count while `generation` is valid; the offer of a revoked instance has no effect.
  Offer offer(Executor& strand, std::shared_ptr<const Generation> generation, Handler handler) {
    auto next = std::make_shared<Offering>(strand.inbox(), std::move(generation), std::move(handler));
    const auto before = state_->exchange(next);
    if (!before) return {};
    if (*before) (*before)->close();
    return Offer([state = std::weak_ptr(state_), weak = std::weak_ptr(next)] {
      const auto mine = weak.lock();
      if (!mine) return;
      if (const auto known = state.lock()) known->remove(mine);
      mine->close();
    });
  }

  /// Call it on `caller`, or before that strand runs.
  CallHandle call(Executor& caller, Request request, CallSpec spec, Done done) const {
    const auto call = std::make_shared<PendingCall<Response>>(state_->name, caller.inbox(), std::move(done));
    call->watch(caller, std::clamp<Duration>(spec.deadline, 1ns, 1h));
    const auto offering = state_->current();
    if (!offering || !offering->generation->valid()) {
      call->fail(Reason::no_answer, "no component offers it now");
      return CallHandle(call);
    }
    call->depend_on(offering->generation);
    if (const auto admitted = offering->admit(call, state_->max_in_flight); !admitted) {
      call->fail(admitted.reason(), admitted.error().text);
      return CallHandle(call);
    }
    // When the post is refused, the task is destroyed, and with it the reply, which completes the call.
    offering->inbox->post([offering, from = std::move(spec.caller), request = std::move(request),
                           reply = Reply<Response>(call, offering->in_flight)]() mutable {
      if (from && !from->valid()) return;
      if (reply.wanted() && offering->generation->valid()) offering->handler(std::move(request), reply);
    });
    return CallHandle(call);
  }

 private:
  /// The service as one instance offers it.
  struct Offering {
    Offering(std::shared_ptr<Inbox> i, std::shared_ptr<const Generation> g, Handler h)
        : inbox(std::move(i)), generation(std::move(g)), handler(std::move(h)) {}

    Result<void> admit(const std::shared_ptr<PendingCall<Response>>& call, std::size_t max) {
      const std::lock_guard lock(mutex);
      if (closed) return {Reason::cancelled, kClosed};
      if (in_flight->load(std::memory_order_acquire) >= max)
        return {Reason::queue_full, "too many requests wait for an answer"};
      in_flight->fetch_add(1, std::memory_order_acq_rel);
      std::erase_if(calls, [](const auto& c) { return c.expired(); });
      calls.push_back(call);
      return {};
    }
    void close() {
      std::vector<std::weak_ptr<PendingCall<Response>>> open;
      {
        const std::lock_guard lock(mutex);
        closed = true;
        open.swap(calls);
      }
      for (const auto& weak : open)
        if (const auto call = weak.lock()) call->fail(Reason::cancelled, kClosed);
    }

    static constexpr const char* kClosed = "the component that offers it ended or was replaced";
    const std::shared_ptr<Inbox> inbox;
    const std::shared_ptr<const Generation> generation;
    const Handler handler;
    const std::shared_ptr<std::atomic<std::size_t>> in_flight{std::make_shared<std::atomic<std::size_t>>(0)};
    std::mutex mutex{};  // Guards the members below.
    std::vector<std::weak_ptr<PendingCall<Response>>> calls{};
    bool closed{false};
  };

  struct State {
    State(std::string n, std::size_t max) : name(std::move(n)), max_in_flight(max) {}
    std::shared_ptr<Offering> current() const {
      const std::lock_guard lock(mutex);
      return offering;
    }
    /// Sets the current offering and returns the previous one, which may be null. Returns nothing when the
    /// instance of `next` was revoked: it must not replace another.
    std::optional<std::shared_ptr<Offering>> exchange(std::shared_ptr<Offering> next) {
      const std::lock_guard lock(mutex);
      if (!next->generation->valid()) return std::nullopt;
      return std::exchange(offering, std::move(next));
    }
    void remove(const std::shared_ptr<Offering>& gone) {
      const std::lock_guard lock(mutex);
      if (offering == gone) offering.reset();
    }
    const std::string name;
    const std::size_t max_in_flight;
    mutable std::mutex mutex{};  // Guards the next member.
    std::shared_ptr<Offering> offering{};
  };
  std::shared_ptr<State> state_;
};

}  // namespace adit
