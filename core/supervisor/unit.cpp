// SPDX-License-Identifier: Apache-2.0
#include "core/supervisor/unit.hpp"

#include "core/exec/fault.hpp"

namespace adit {

ComponentSlot::~ComponentSlot() {
  io.reset();
  if (strand) strand->end();
  if (component) component->stop();
  component.reset();
}

LeftBehind::~LeftBehind() = default;

Unit::Unit(Runtime& runtime, UnitParams params) : runtime_(runtime), params_(std::move(params)) {}

Result<void> Unit::open() {
  auto slot = std::make_shared<ComponentSlot>();
  slot->strand = params_.dedicated ? runtime_.dedicated_strand(params_.name) : runtime_.strand(params_.name);
  if (params_.open_io) {
    auto io = params_.open_io(slot);
    if (!io) return io.error();
    slot->io = std::move(*io);
  }
  const std::lock_guard lock(mutex_);
  slot_ = std::move(slot);
  return {};
}

void Unit::restart() {
  const auto record = std::make_shared<Record>();
  std::shared_ptr<ComponentSlot> slot;
  {
    const std::lock_guard lock(mutex_);
    record_->generation->revoke();
    record_ = record;
    slot = slot_;
  }
  // The slot outlives the tasks of its strand.
  slot->strand->post_control([this, slot = slot.get(), record] { begin(*slot, record); });
  // Increased at once: a task posted by a thread that sees the new number runs after begin().
  instance_.fetch_add(1, std::memory_order_acq_rel);
}

void Unit::begin(ComponentSlot& slot, const std::shared_ptr<Record>& record) {
  if (slot.component) slot.component->stop();
  slot.component.reset();
  if (!record->generation->valid()) return;  // Restarted again meanwhile.
  Result<void> started;
  try {
    auto made = params_.make(*slot.strand);
    // The start took so long that another instance replaced this one.
    if (!record->generation->valid()) return;
    started = made ? Result<void>{} : Result<void>{made.error()};
    if (made) {
      slot.component = std::move(*made);
      slot.component->set_generation(record->generation);
      started = slot.component->start();
    }
  } catch (const HangReleased&) {
    throw;
  } catch (...) {
    started = Error{Reason::internal, current_exception_text()};
  }
  if (!started) return report_failure(*record, started.error().text);
  slot.component->on_failure([this, &slot, record](const ComponentFailure& failure) {
    record->generation->revoke();
    slot.component->stop();
    report_failure(*record, failure.text);
  });
  {
    const std::lock_guard lock(record->mutex);
    record->health_state = slot.component->health_state();
  }
  if (changed_) changed_();
}

void Unit::report_failure(Record& record, const std::string& text) const {
  record.generation->revoke();
  {
    const std::lock_guard lock(record.mutex);
    record.failed = true;
    record.text = text;
  }
  if (changed_) changed_();
}

void Unit::replace() {
  std::shared_ptr<ComponentSlot> hung = slot();
  hung->generation->revoke();
  hung->strand->abandon();
  left_behind_.slots.push_back(std::move(hung));
  if (const auto opened = open(); !opened) {
    const std::lock_guard lock(mutex_);
    record_->generation->revoke();
    record_ = std::make_shared<Record>();
    record_->failed = true;
    record_->text = opened.error().text;
    return;
  }
  restart();
}

void Unit::revoke() {
  const std::lock_guard lock(mutex_);
  record_->generation->revoke();
  if (slot_) slot_->generation->revoke();
}

void Unit::abandon() {
  revoke();
  slot()->strand->abandon();
}

void Unit::end() {
  if (const auto now = slot()) now->strand->end();
}

HealthSample Unit::health_sample() const {
  std::shared_ptr<Record> record;
  {
    const std::lock_guard lock(mutex_);
    record = record_;
  }
  HealthSample sample;
  const std::lock_guard lock(record->mutex);
  sample.failed = record->failed;
  sample.text = record->text;
  if (record->health_state) {
    const ComponentHealth health = record->health_state->health(Time{});
    sample.running = health.running;
    sample.heartbeats = health.heartbeats;
  }
  return sample;
}

std::shared_ptr<ComponentSlot> Unit::slot() const {
  const std::lock_guard lock(mutex_);
  return slot_;
}

void Unit::inject(ComponentFault fault) {
  const auto now = slot();
  now->strand->post([slot = now.get(), fault] {
    if (slot->component) slot->component->inject(fault);
  });
}

}  // namespace adit
