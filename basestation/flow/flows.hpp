// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "basestation/flow/flow.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// The flows of a station, by the handle of their command line.
class Flows {
 public:
  static constexpr std::size_t kMaxFlows = 64;

  /// Starts a flow. A drive takes over its robot from an earlier drive. Error: queue_full.
  Result<void> start(std::uint64_t handle, const std::shared_ptr<Flow>& flow);
  void cancel(std::uint64_t handle);
  /// Sets the stick of a drive; other flows ignore it.
  void set_velocity(std::uint64_t handle, const StickVelocity& velocity);
  /// Reports the refusal of a robot's joystick stream to its drives.
  void stream_refused(const std::string& robot, Reason reason, const std::string& text);
  void end_drives(const std::string& robot, Reason reason);
  /// Returns a handler of the robot's answer to a command that requests a mode: if accepted, it ends the
  /// drives of now. One that begins later continues.
  Flow::Done end_drives_when_accepted(const std::string& robot) const;
  void drop_ended();

 private:
  using Chosen = std::vector<std::shared_ptr<Flow>>;
  Chosen of(std::uint64_t handle) const;
  Chosen drives_of(const std::string& robot) const;

  std::multimap<std::uint64_t, std::shared_ptr<Flow>> flows_{};
};

}  // namespace adit::station
