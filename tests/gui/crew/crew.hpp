// SPDX-License-Identifier: Apache-2.0
// Ten robots, each on a machine of its own with its agent and its simulated body, and two operators'
// stations.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "tests/gui/crew/mission.hpp"
#include "tests/hosts/hosts.hpp"

namespace adit::gui::crew {

/// Seconds of a clock that never falls.
double steady_now();

class Crew {
 public:
  /// Starts everything and waits until op1 knows all robots. `max_speed`: of the robots, m/s. Check failure()
  /// afterwards.
  Crew(const Mission& mission, double max_speed);
  ~Crew();

  const std::string& failure() const { return failure_; }
  /// Environment of programs that talk to the stations.
  const std::map<std::string, std::string>& environment() const { return environment_; }
  /// Runs a command of an operator in the shell.
  live::Finished shell(const std::string& operator_name, std::vector<std::string> words) const;
  /// Lets happen what is due, by how far the robots are.
  void tick(const std::array<Progress, kRobots>& progress);
  /// Whether another operator asks for a robot that is locked, and does not have it yet.
  bool asked(std::size_t robot) const { return asked_[robot]; }
  /// Interventions that are not over.
  std::size_t open() const;
  /// What happened so far, one line each.
  const std::vector<std::string>& events() const { return events_; }
  /// Ends the simulations; the number of robots that touched something, as their simulations say.
  int contacts();

 private:
  struct Due {
    Intervention what{};
    double sent_at{-1.0};  ///< The goal was accepted, s.
    int stage{0};
    double next{0.0};  ///< Time of the next stage, s.
    bool over{false};
  };
  void act(Due& due, double now);
  std::string holder_of(std::size_t robot) const;

  const Mission& mission_;
  live::Folder folder_{};
  std::map<std::string, std::string> environment_{};
  hosts::Hosts hosts_{};
  std::vector<live::Process> simulations_{}, agents_{}, stations_{};
  std::vector<Due> due_{};
  std::array<std::atomic<bool>, kRobots> asked_{};
  std::vector<std::string> events_{};
  std::string failure_{};
  double begun_{};
};

}  // namespace adit::gui::crew
