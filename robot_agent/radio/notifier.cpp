#include "robot_agent/radio/notifier.hpp"

#include <chrono>
#include <mutex>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "robot_agent/radio/convert.hpp"

namespace adit::agent {

struct Notifier::Endpoint {
  std::string robot{};
  std::timed_mutex mutex{};  // guards what follows
  wire::Writer<radio::Notification> writer{};
  std::uint64_t seq{};
};

Notifier::Notifier() : endpoint_(std::make_unique<Endpoint>()) {}
Notifier::~Notifier() = default;

Result<std::unique_ptr<Notifier>> Notifier::open(wire::Wire& radio, const std::string& robot) {
  auto writer = wire::Writer<radio::Notification>::make(radio, wire::topics::notification);
  if (!writer) return writer.error();
  std::unique_ptr<Notifier> notifier(new Notifier);
  notifier->endpoint_->robot = robot;
  notifier->endpoint_->writer = std::move(*writer);
  return notifier;
}

bool Notifier::send(const Notice& notice) {
  Endpoint& e = *endpoint_;
  auto sample = to_radio(notice, e.robot);
  const std::unique_lock lock(e.mutex, std::chrono::milliseconds(20));
  if (!lock) return false;
  sample.seq(++e.seq);
  (void)e.writer.write(sample);
  return true;
}

}  // namespace adit::agent
