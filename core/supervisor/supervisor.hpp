#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/supervisor/restart_policy_engine.hpp"
#include "core/supervisor/unit.hpp"

namespace adit {

/// Watches units from a strand of its own: starts them, makes them anew, gives up for the agent when that
/// does not help. What hangs elsewhere cannot stop it: it never waits for another strand.
class Supervisor : public Component {
 public:
  /// Called on the supervisor's strand.
  struct Outputs {
    std::function<void(const PartEvent&, const std::string& part)> notify{};
    /// The agent must be restarted. Once; nothing is ordered after it.
    std::function<void(const std::string& why)> escalate{};
    /// After each look, every SupervisionParams::period.
    std::function<void(Time now)> looked{};
  };

  Supervisor(SupervisionParams params, Executor& strand, Log log, Outputs outputs);
  /// Before start(), which starts the units in this order. `unit` must outlive this strand.
  void watch(Unit& unit, PartSpec spec);

  /// The operator's word, on this strand. Errors of the RestartPolicyEngine.
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
