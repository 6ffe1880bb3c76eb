// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/notifier.hpp"

#include <mutex>

#include "adit/robot.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace adit::agent {

struct Notifier::Endpoint {
  std::string robot{};
  const Executor* clock{};
  std::mutex mutex{};  // Guards the members below.
  wire::Writer<radio::Notification> writer{};
  std::uint64_t seq{};
  void write(Notice notice) {
    notice.robot = robot;
    notice.stamp = to_stamp(clock->now());
    radio::Notification sample = encode(notice);
    sample.seq(++seq);
    (void)writer.write(sample);
  }
};

Notifier::Notifier() : endpoint_(std::make_unique<Endpoint>()) {}
Notifier::~Notifier() = default;

Result<std::unique_ptr<Notifier>> Notifier::open(wire::Participant& radio, const std::string& robot,
                                                 const Executor& clock) {
  auto writer = wire::Writer<radio::Notification>::make(radio, wire::topics::kNotification);
  if (!writer) return writer.error();
  std::unique_ptr<Notifier> notifier(new Notifier);
  notifier->endpoint_->robot = robot;
  notifier->endpoint_->clock = &clock;
  notifier->endpoint_->writer = std::move(*writer);
  return notifier;
}

void Notifier::send(const Notice& notice) {
  const std::lock_guard lock(endpoint_->mutex);
  endpoint_->write(notice);
}

bool Notifier::try_send(const Notice& notice) {
  const std::unique_lock lock(endpoint_->mutex, std::try_to_lock);
  if (!lock) return false;
  endpoint_->write(notice);
  return true;
}

}  // namespace adit::agent
