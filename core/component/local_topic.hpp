// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "core/exec/executor.hpp"

namespace adit {

/// Subscription to a LocalTopic; it ends when this object is destroyed.
class [[nodiscard]] Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::shared_ptr<std::atomic<bool>> alive) : alive_(std::move(alive)) {}
  Subscription(Subscription&&) = default;
  Subscription& operator=(Subscription&& other) noexcept {
    if (this != &other) {
      cancel();
      alive_ = std::move(other.alive_);
    }
    return *this;
  }
  ~Subscription() { cancel(); }
  void cancel() {
    if (alive_) alive_->store(false, std::memory_order_relaxed);
    alive_.reset();
  }

 private:
  std::shared_ptr<std::atomic<bool>> alive_{};
};

/// A typed topic inside one process, with one writer strand and any number of subscribers. A published value
/// is shared, never copied, and immutable. Subscribers on the writer's strand are called directly, others
/// through the inbox of their own strand; a subscriber whose strand has ended receives nothing. Subscribing
/// and publishing happen on the owner's strand, or at start-up before the strands run.
template <class T>
class LocalTopic {
 public:
  using Value = std::shared_ptr<const T>;
  using Handler = std::function<void(const Value&)>;

  explicit LocalTopic(Executor& owner) : owner_(owner.inbox()) {}

  /// Calls `handler` on `strand` for each value published after this call.
  Subscription subscribe(Executor& strand, Handler handler) {
    auto alive = std::make_shared<std::atomic<bool>>(true);
    subscribers_.push_back({strand.inbox(), std::make_shared<Handler>(std::move(handler)), alive});
    return Subscription(alive);
  }

  void publish(T value) { publish(std::make_shared<const T>(std::move(value))); }
  void publish(Value value) {
    std::erase_if(subscribers_, [](const Entry& e) { return !e.alive->load(std::memory_order_relaxed); });
    // By index, because a handler may subscribe.
    for (std::size_t i = 0; i < subscribers_.size(); ++i) {
      const Entry entry = subscribers_[i];
      auto deliver = [handler = entry.handler, alive = entry.alive, value] {
        if (alive->load(std::memory_order_relaxed)) (*handler)(value);
      };
      if (entry.inbox == owner_)
        deliver();
      else
        entry.inbox->post(std::move(deliver));
    }
  }

 private:
  struct Entry {
    std::shared_ptr<Inbox> inbox;
    std::shared_ptr<Handler> handler;
    std::shared_ptr<std::atomic<bool>> alive;
  };
  std::shared_ptr<Inbox> owner_;
  std::vector<Entry> subscribers_{};
};

}  // namespace adit
