// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "basestation/camera/cameras.hpp"
#include "basestation/commands/outcome.hpp"

namespace adit::station {

/// The commands `camera ...`.
class CameraCommands {
 public:
  using Done = std::function<void(const Outcome&)>;
  /// The first picture of a camera that was switched on has so long to come.
  static constexpr Duration kFirst{6s};

  CameraCommands(Executor& strand, Cameras& cameras) : strand_(strand), cameras_(cameras) {}

  /// Runs the command; `done` is called once, when the first picture or the single one is here.
  void run(const command::Request& request, const Done& done);

 private:
  void switch_on(const command::Request& request, const std::string& camera, const Done& done);
  void await_first(const command::Request& request, const std::string& camera, Time until, const Done& done);
  void shoot(const command::Request& request, const std::string& camera, const Done& done);
  void write(const command::Request& request, const std::string& camera, const ShotPicture& picture,
             const Done& done);

  Executor& strand_;
  Cameras& cameras_;
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

/// Answers `cameras`.
Outcome cameras_outcome(const command::Request& request, const Fleet& fleet, const Cameras& cameras);

}  // namespace adit::station
