// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "basestation/model/outcome.hpp"
#include "basestation/model/stick_velocity.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// The way of sticks and of stops to the station, from any thread.
class DriveSink {
 public:
  using Done = std::function<void(const station::CommandOutcome&)>;
  virtual ~DriveSink() = default;

  virtual std::shared_ptr<const station::World> world() const = 0;
  /// Time since the station's last snapshot, s; large without a station.
  virtual double silent_for() const = 0;
  /// Begins to drive a robot by hand; returns what stick() and cancel() take. `done`: called in the thread of
  /// the window when it ends.
  virtual std::int64_t drive(const std::string& robot, Done done) = 0;
  virtual void stick(std::int64_t drive, const station::StickVelocity& velocity) = 0;
  virtual void cancel(std::int64_t drive) = 0;
  /// Software stop of these robots, or of all if there is none.
  virtual void halt(const std::vector<std::string>& robots) = 0;
};

}  // namespace adit::gui
