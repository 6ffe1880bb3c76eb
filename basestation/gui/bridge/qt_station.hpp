// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <memory>
#include <thread>

#include "basestation/client/station.hpp"
#include "basestation/gui/bridge/command_sink.hpp"
#include "basestation/gui/bridge/drive_sink.hpp"

namespace adit::gui {

class Control;

/// Brings the operator's station and the window together. Everything happens in the window's thread but the
/// start of a station, which takes a while.
class QtStation : public QObject, public CommandSink, public DriveSink {
  Q_OBJECT

 public:
  explicit QtStation(std::unique_ptr<station::client::Station> station);
  ~QtStation() override;

  /// Shows the station in a window from now on.
  void show_in(Control& control);

  void execute(const std::string& line, CommandSink::Done done) override { station_->execute(line, done); }
  void query(const std::string& line, CommandSink::Done done) override { station_->execute(line, done); }
  void camera(const station::CameraRequest& request, CommandSink::Done done) override {
    station_->camera(request, done);
  }
  void photo(const std::string& id, findings::PhotoPart part, CommandSink::Done done) override {
    station_->photo(id, part, done);
  }
  void stop(const std::vector<std::string>& robots, CommandSink::Done done) override {
    station_->stop(robots, done);
  }
  std::shared_ptr<const station::World> world() const override { return station_->world(); }
  double silent_for() const override;
  std::int64_t drive(const std::string& robot, DriveSink::Done done) override {
    return station_->drive(robot, done);
  }
  void stick(std::int64_t drive, const station::StickVelocity& velocity) override {
    station_->stick(drive, velocity);
  }
  void cancel(std::int64_t drive) override { station_->cancel(drive); }
  void look_at(const std::optional<station::LookedAt>& place) override { station_->look_at(place); }
  void halt(const std::vector<std::string>& robots) override { station_->stop(robots, {}); }
  void start_station() override;

 private:
  void take();
  void look();
  void show_world();

  std::unique_ptr<station::client::Station> station_;
  Control* control_{};
  QTimer timer_{};  ///< Notices that the station is silent.
  QTimer show_{};   ///< Runs while a snapshot waits to be shown: states of many robots come one by one.
  QElapsedTimer shown_{};  ///< Since a snapshot was shown.
  std::jthread starter_{};
  bool starting_{false};
};

}  // namespace adit::gui
