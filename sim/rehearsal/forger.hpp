// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "sim/checker/observation.hpp"
#include "sim/rehearsal/robot_machine.hpp"

namespace adit::sim {

/// A foreign participant of the radio domain that listens, and then writes well-formed commands and joystick
/// samples to a robot in an operator's name, with his station's id and the epoch in force.
class Forger {
 public:
  Forger(Stage& stage, const Forge& forge, const StationId& id);
  ~Forger();
  Result<void> start();

 private:
  struct Endpoints;
  void write();

  Stage& stage_;
  Forge forge_;
  StationId id_;
  std::unique_ptr<Endpoints> endpoints_{};
};

}  // namespace adit::sim
