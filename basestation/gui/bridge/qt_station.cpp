// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/qt_station.hpp"

#include <algorithm>
#include <chrono>

#include "basestation/gui/bridge/control.hpp"

namespace adit::gui {
namespace {

constexpr int kLookMs = 250;
constexpr int kShowMs = 80;  // Shortest time between two snapshots that are shown.

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

QtStation::QtStation(std::unique_ptr<station::client::Station> station) : station_(std::move(station)) {
  connect(&timer_, &QTimer::timeout, this, &QtStation::look);
  show_.setSingleShot(true);
  shown_.start();
  connect(&show_, &QTimer::timeout, this, &QtStation::show_world);
}

QtStation::~QtStation() {
  if (starter_.joinable()) starter_.join();
}

void QtStation::show_in(Control& control) {
  control_ = &control;
  station_->on_change([this] { QMetaObject::invokeMethod(this, &QtStation::take, Qt::QueuedConnection); });
  station_->want_map(true);
  timer_.start(kLookMs);
  take();
  show_world();
  if (!station_->remark().empty()) control.add_remark(text_of(station_->remark()));
}

void QtStation::take() {
  const station::client::Changes changes = station_->take();
  for (const station::Notice& notice : changes.notices) control_->add_notice(notice);
  for (const station::CommandEvent& event : changes.commands) control_->add_command(event);
  if (changes.missed > 0)
    control_->add_remark(QString("%1 lines were too many and did not come").arg(changes.missed));
  // The first change after a while is shown at once, and what follows it together.
  if (changes.world && !show_.isActive())
    show_.start(static_cast<int>(std::max<qint64>(0, kShowMs - shown_.elapsed())));
  if (changes.map) control_->show_map(station_->map());
  if (changes.link) look();
}

void QtStation::show_world() {
  shown_.start();
  control_->show(station_->world(), steady_seconds());
}

void QtStation::look() {
  const station::client::Link link = station_->link();
  control_->show_link(link.connected, link.silent_for, link.why);
}

double QtStation::silent_for() const {
  constexpr double kNoStation = 1e6;
  const station::client::Link link = station_->link();
  return link.connected ? link.silent_for : kNoStation;
}

void QtStation::start_station() {
  if (starting_) return;
  starting_ = true;
  control_->add_remark("the station is started again");
  starter_ = std::jthread([this] {
    const Result<void> started = station_->start_station();
    const QString why = started ? QString() : text_of(started.error().text);
    QMetaObject::invokeMethod(this, [this, why] {
      starting_ = false;
      if (!why.isEmpty()) control_->add_remark("the station did not start: " + why);
    });
  });
}

}  // namespace adit::gui
