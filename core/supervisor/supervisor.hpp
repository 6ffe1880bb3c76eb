// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/supervisor/restart_policy_engine.hpp"
#include "core/supervisor/unit.hpp"

namespace adit {

/// Watches units from its own strand: starts and restarts them, and requests a restart of the agent when that
/// does not help. A component that hangs cannot block it, because it never waits for another strand.
class Supervisor : public Component {
 public:
  /// Callbacks on the supervisor's strand.
  struct Outputs {
    std::function<void(const PartEvent&, const std::string& part)> notify{};
    /// Called when the agent must be restarted. Called once; no action follows.
    std::function<void(const std::string& why)> escalate{};
    /// Called after each poll, every SupervisionParams::period.
    std::function<void(Time now)> looked{};
  };

  Supervisor(SupervisionParams params, Executor& strand, Log log, Outputs outputs);
  /// Adds a unit before start(), which starts the units in this order. `unit` must outlive this strand.
  void watch(Unit& unit, PartSpec spec);

  /// Restarts a component on the operator's command; call it on this strand. Errors are those of
  /// RestartPolicyEngine.
  Result<void> restart(const std::string& part);
  Result<void> set_policy(const std::string& part, RestartPolicy policy);

  const std::vector<PartStatus>& status() const { return restart_policy_.status(); }
  bool escalated() const { return restart_policy_.escalated(); }

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  void poll();
  void execute(const RestartPolicyEngine::Decision& decision);

  SupervisionParams params_;
  Outputs outputs_;
  RestartPolicyEngine restart_policy_;
  std::vector<Unit*> units_{};
  Timer timer_{};
};

}  // namespace adit
