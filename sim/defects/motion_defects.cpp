// SPDX-License-Identifier: Apache-2.0
// Defects of what moves the robot, made of the velocities that leave for its driver.
#include "sim/defects/decorations.hpp"
#include "sim/defects/radio_interceptor.hpp"

namespace adit::sim {
namespace {

class TwoSources final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_velocity(Twist2& velocity) override {
    const bool pushed = stick_age() && *stick_age() < 300ms && !stick().zero();
    if (velocity.zero() && pushed && !drives_by_hand() && !mode().empty() && authority().stops().empty())
      velocity = stick();
  }
};

/// Until the next source gives a velocity, that of the former one goes on.
class ChangeWithoutZero final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    const radio::CommandKind kind = command.sample.kind();
    if ((kind == radio::CMD_MODE || kind == radio::CMD_GOTO) && held_by(command.sample.station_id()) &&
        !stands())
      until_ = now() + 500ms;
    out.push_back(arrival(command));
  }
  void on_velocity(Twist2& velocity) override {
    if (until_ && now() < *until_ && velocity.zero()) velocity = last_motion();
  }

 private:
  std::optional<Time> until_{};
};

class NoZeroOnStale final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_velocity(Twist2& velocity) override {
    const bool silent = stick_age() && *stick_age() > 250ms && !stick().zero();
    if (velocity.zero() && silent && drives_by_hand() && authority().stops().empty())
      velocity = last_motion();
  }
};

class ManualSurvivesHandover final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    if (command.sample.kind() == radio::CMD_TAKE && !held_by(command.sample.station_id()) &&
        !authority().locked() && drives_by_hand() && !stands()) {
      until_ = now() + 1s;
      mode_ = mode();
    }
    out.push_back(arrival(command));
  }
  void on_behaviour(radio::BehaviourState& behaviour) override {
    if (goes_on()) behaviour.mode(mode_);
  }
  void on_velocity(Twist2& velocity) override {
    if (goes_on() && velocity.zero()) velocity = last_motion();
  }

 private:
  bool goes_on() const { return until_ && now() < *until_ && authority().stops().empty(); }
  std::optional<Time> until_{};
  std::string mode_{};
};

}  // namespace

namespace decorations {

Decoration two_sources(const Subject& s) { return on_wires<TwoSources>(s); }
Decoration change_without_zero(const Subject& s) { return on_wires<ChangeWithoutZero>(s); }
Decoration no_zero_on_stale(const Subject& s) { return on_wires<NoZeroOnStale>(s); }
Decoration manual_survives_handover(const Subject& s) { return on_wires<ManualSurvivesHandover>(s); }

}  // namespace decorations
}  // namespace adit::sim
