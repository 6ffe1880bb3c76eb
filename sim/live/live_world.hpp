// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "core/exec/live_runtime.hpp"
#include "core/wire/participant.hpp"
#include "sim/driver/robot_driver.hpp"
#include "sim/live/domain_claim.hpp"
#include "sim/rehearsal/expectations.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace adit::sim {

struct LiveWorldParams {
  std::uint64_t seed{1};
  std::uint32_t domain_base{100};  ///< Robot k (from 1) is on DDS domain domain_base + k, [0, 200].
  bool await_script{false};        ///< Scenario time begins with begin_script(), not with start().
};

/// A scenario's world and robots in real time, speaking each robot's domain over Fast DDS on loopback. The
/// script, the faults and what is said on the radio are not its business: it is what the robots' drivers
/// would be.
class LiveWorld {
 public:
  /// `scenario` outlives it. Errors: in_use, when another process simulates a robot
  /// of these domains; as Simulation::create; wire_failed.
  static Result<std::unique_ptr<LiveWorld>> open(const Scenario& scenario, std::shared_ptr<const World> world,
                                                 const LiveWorldParams& params);
  ~LiveWorld();
  Result<void> start();
  /// The script begins now: times of expectations count from here. From any thread but the world's.
  void begin_script();
  /// Ends it and gives the truth of the run: ways, contacts, and which of the scenario's places were reached.
  /// Expectations of what robots say are left out: nothing here listens to them.
  RunOutcome finish();

 private:
  LiveWorld(const Scenario& scenario, Simulation simulation, const LiveWorldParams& params);
  void step();
  void observe();
  Evidence evidence() const;
  /// Runs the task on the world's strand and waits for it.
  void on_strand(const Task& task);

  Scenario judged_;  ///< The scenario with the expectations that need the truth alone.
  LiveWorldParams params_;
  Simulation simulation_;
  Expectations expectations_;
  std::vector<DomainClaim> claims_{};
  std::vector<std::unique_ptr<wire::Participant>> wires_{};
  LiveRuntime runtime_;
  std::shared_ptr<Executor> strand_;
  std::vector<std::unique_ptr<RobotDriver>> drivers_{};
  Timer step_{}, observe_{};
  Time started_{};
  std::optional<Duration> script_began_{};  // on the simulation's clock
  std::map<std::string, Trail> trails_{};
  std::vector<Trail> people_{};
};

}  // namespace adit::sim
