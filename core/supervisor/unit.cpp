#include "core/supervisor/unit.hpp"

#include "core/exec/fault.hpp"

namespace adit {

Seat::~Seat() {
  fittings.reset();
  if (strand) strand->end();
  if (component) component->stop();
  component.reset();
}

LeftBehind::~LeftBehind() = default;

Unit::Unit(Runtime& runtime, UnitParams params) : runtime_(runtime), params_(std::move(params)) {}

Result<void> Unit::open() {
  auto seat = std::make_shared<Seat>();
  seat->strand = params_.heavy ? runtime_.worker(params_.name) : runtime_.strand(params_.name);
  if (params_.fit) {
    auto fittings = params_.fit(seat);
    if (!fittings) return fittings.error();
    seat->fittings = std::move(*fittings);
  }
  const std::lock_guard lock(mutex_);
  seat_ = std::move(seat);
  return {};
}

void Unit::restart() {
  const auto record = std::make_shared<Record>();
  std::shared_ptr<Seat> seat;
  {
    const std::lock_guard lock(mutex_);
    record_->generation->revoke();
    record_ = record;
    seat = seat_;
  }
  // The seat outlives its strand's tasks.
  seat->strand->post_control([this, seat = seat.get(), record] { begin(*seat, record); });
  // Now: what is posted by who sees the new number runs after begin().
  instance_.fetch_add(1, std::memory_order_acq_rel);
}

void Unit::begin(Seat& seat, const std::shared_ptr<Record>& record) {
  if (seat.component) seat.component->stop();
  seat.component.reset();
  if (!record->generation->valid()) return;  // ordered anew meanwhile
  Result<void> started;
  try {
    auto made = params_.make(*seat.strand);
    if (!record->generation->valid()) return;  // it took so long that another instance replaced it
    started = made ? Result<void>{} : Result<void>{made.error()};
    if (made) {
      seat.component = std::move(*made);
      seat.component->adopt(record->generation);
      started = seat.component->start();
    }
  } catch (const HangReleased&) {
    throw;
  } catch (...) {
    started = Error{Reason::internal, current_exception_text()};
  }
  if (!started) return report_failure(*record, started.error().text);
  seat.component->on_failure([this, &seat, record](const ComponentFailure& failure) {
    record->generation->revoke();
    seat.component->stop();
    report_failure(*record, failure.text);
  });
  {
    const std::lock_guard lock(record->mutex);
    record->vital = seat.component->vital();
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
  std::shared_ptr<Seat> hung = seat();
  hung->generation->revoke();
  hung->strand->abandon();
  left_behind_.seats.push_back(std::move(hung));
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
  if (seat_) seat_->generation->revoke();
}

void Unit::abandon() {
  revoke();
  seat()->strand->abandon();
}

void Unit::end() {
  if (const auto now = seat()) now->strand->end();
}

Pulse Unit::pulse() const {
  std::shared_ptr<Record> record;
  {
    const std::lock_guard lock(mutex_);
    record = record_;
  }
  Pulse pulse;
  const std::lock_guard lock(record->mutex);
  pulse.failed = record->failed;
  pulse.text = record->text;
  if (record->vital) {
    const ComponentHealth health = record->vital->health(Time{});
    pulse.running = health.running;
    pulse.beats = health.beats;
  }
  return pulse;
}

std::shared_ptr<Seat> Unit::seat() const {
  const std::lock_guard lock(mutex_);
  return seat_;
}

void Unit::inject(ComponentFault fault) {
  const auto now = seat();
  now->strand->post([seat = now.get(), fault] {
    if (seat->component) seat->component->inject(fault);
  });
}

}  // namespace adit
