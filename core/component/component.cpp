// SPDX-License-Identifier: Apache-2.0
#include "core/component/component.hpp"

#include <stdexcept>

#include "core/exec/fault.hpp"

namespace adit {

Component::Component(std::string name, Executor& executor, Log log, HealthParams health)
    : executor_(executor),
      log_(log.named(name, &executor)),
      health_state_(std::make_shared<HealthState>(std::move(name), health)) {}

Component::~Component() {
  // on_stop() of a derived class can no longer be called, because that part is already destroyed. Components
  // that need it call stop().
  if (lifetime_) lifetime_->owner = nullptr;
  health_state_->stopped();
}

Result<void> Component::start() {
  if (lifetime_) return Error{Reason::in_use, name() + " is already running"};
  lifetime_ = std::make_shared<Lifetime>(Lifetime{this});
  health_state_->started(now());
  heartbeat_ = executor_.every(health_state_->params().beat, guard([this] { health_state_->beat(now()); }));
  const std::uint64_t failures_before = failures_;
  Result<void> result;
  try {
    result = on_start();
  } catch (...) {
    const std::string text = current_exception_text();
    fail(text);
    result = Error{Reason::internal, name() + " did not start: " + text};
  }
  if (result && failures_ != failures_before) {
    // A guarded callback threw within on_start(), before any handler could process the failure.
    stop();
    return Error{Reason::internal, name() + " did not start: " + health_state_->health(now()).last_failure};
  }
  if (!result) {
    lifetime_->owner = nullptr;
    lifetime_.reset();
    offers_.clear();
    heartbeat_.cancel();
    health_state_->stopped();
  }
  return result;
}

void Component::stop() {
  if (!lifetime_) return;
  lifetime_->owner = nullptr;
  lifetime_.reset();
  offers_.clear();
  heartbeat_.cancel();
  health_state_->stopped();
  try {
    on_stop();
  } catch (...) {
    fail("stop: " + current_exception_text());
  }
}

void Component::fail(const std::string& text) {
  const Time at = now();
  health_state_->failed(at, text);
  log_.error("failed: " + text);
  ++failures_;
  if (failure_handler_) failure_handler_({name(), text, at, failures_});
}

void Component::inject(ComponentFault fault) {
  post([this, fault] {
    if (fault == ComponentFault::hang) hang(executor_);
    throw std::runtime_error("a crash on purpose");
  });
}

}  // namespace adit
