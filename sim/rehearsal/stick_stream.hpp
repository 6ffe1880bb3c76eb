// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/wire/participant.hpp"
#include "sim/checker/observation.hpp"

namespace adit::sim {

/// Streams a pushed stick to a robot at the joystick's rate, with the epoch in force and a fresh echo,
/// whatever the robot answers: what no well-behaved station does. Used by faults.
class StickStream {
 public:
  /// `wire` outlives it; `id` is the station id it claims.
  StickStream(wire::Participant& wire, std::shared_ptr<Executor> strand, std::string robot,
              const StationId& id);
  ~StickStream();
  Result<void> start();

  bool heard() const;  ///< The robot's state was heard: samples are sent.
  std::uint64_t start_of_epoch() const;
  std::uint32_t epoch_counter() const;
  std::uint64_t sequence() const;

 private:
  struct Endpoints;
  void write();

  wire::Participant& wire_;
  std::shared_ptr<Executor> strand_;
  std::string robot_;
  StationId id_;
  std::unique_ptr<Endpoints> endpoints_{};
};

}  // namespace adit::sim
