#pragma once
#include <memory>
#include <optional>

#include "core/component/component.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/motion/driver.hpp"
#include "robot_agent/motion/localisation.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/motion/navigation.hpp"
#include "robot_agent/radio/radio_edge.hpp"
#include "robot_agent/state/restored.hpp"
#include "robot_agent/state/state_keeper.hpp"

namespace adit::agent {

/// The command strand's component: owns what lives there and keeps its beat. Private to agent.cpp.
class Agent::Core : public Component {
 public:
  Core(const AgentParams& params, Executor& command, std::unique_ptr<Decider> decider,
       std::unique_ptr<RadioEdge> radio, std::shared_ptr<Executor> disk_strand);

  /// Opens the driver and begins to listen. The timers begin with Component::start().
  Result<void> open(wire::Wire& robot, Executor& sensors);
  /// Nothing arrives any more. From any thread.
  void close();
  std::string at_console(const std::string& line);
  void report(const Error& error) { fail(error.text); }

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  void beat();
  void send_state();
  void send_status();
  void send_behaviour();
  void send_health();
  void watch_driver();
  void tell_restored();
  void keep();
  void tell(Notice notice);
  void tell_holder(Notice notice);
  Facts sense(Time now) const;
  CommandInterface::Outputs command_outputs();
  Behaviour::Inputs behaviour_inputs();
  Behaviour::Outputs behaviour_outputs();
  Navigation::Outputs navigation_outputs();
  StateKeeper::Outputs keeper_outputs();

  AgentParams params_;
  std::unique_ptr<RadioEdge> radio_;
  Localisation localisation_;
  Navigation navigation_;
  Mux mux_;
  Behaviour behaviour_;
  CommandInterface commands_;
  Directory directory_;
  Restored restored_;
  StateKeeper keeper_;
  std::unique_ptr<Driver> driver_{};
  float battery_{-1.0f};
  bool driver_was_alive_{};
  Time started_{};
  std::vector<Timer> timers_{};
};

}  // namespace adit::agent
