// What the command component does by itself: lost link, empty battery, findings (rule 9).
#include <cmath>

#include "robot_agent/agent_core.hpp"

namespace adit::agent {

void Agent::Core::watch_link() {
  const Authority& authority = commands_.authority();
  LinkLoss::Inputs in{};
  in.held = authority.holder().has_value();
  in.heard = authority.heard();
  in.autonomous = behaviour_.mode().autonomous();
  in.arrived = behaviour_.view().goal_state == GoalState::reached;
  if (localisation_.initialised()) in.place = Eigen::Vector2d(localisation_.pose().x, localisation_.pose().y);
  const LinkLoss::Step step = link_loss_.tick(in, now());
  const std::string holder = authority.holder_name();
  if (step.lost)
    tell({{},
          Severity::warning,
          "link_lost",
          Reason::no_answer,
          params_.name + " has not heard " + holder + " for " +
              std::to_string(std::lround(seconds(step.silence))) + " s"});
  if (step.found)
    tell({{}, Severity::info, "link_back", Reason::none, params_.name + " hears " + holder + " again"});
  if (step.hold) {
    behaviour_.hold(Reason::no_answer, now());
    tell(
        {{},
         Severity::warning,
         "mode_changed",
         Reason::no_answer,
         params_.name + " holds until it hears " + holder + " again and is told to go on; its goal is kept"});
  }
  if (step.go_to) go_back(*step.go_to, "its holder is not heard");
}

void Agent::Core::go_back(const Eigen::Vector2d& place, const std::string& why) {
  const auto asked = behaviour_.request_goal({place.x(), place.y(), std::nan("")}, now());
  if (!asked) return link_loss_.refused(now());
  tell({{},
        Severity::warning,
        "returning",
        Reason::none,
        params_.name + " goes back to " + std::to_string(std::lround(place.x())) + " " +
            std::to_string(std::lround(place.y())) + ": " + why});
}

void Agent::Core::battery_fell(BatteryLevel level) {
  const char* code = level == BatteryLevel::last  ? "battery_last"
                     : level == BatteryLevel::low ? "battery_low"
                                                  : "battery_warning";
  tell({{},
        level == BatteryLevel::last ? Severity::error : Severity::warning,
        code,
        Reason::none,
        params_.name + " has " + std::to_string(std::lround(battery_ * 100)) + " % of its battery left"});
  // Who drives by hand sees it, and decides.
  if (level != BatteryLevel::last || !behaviour_.mode().autonomous()) return;
  if (params_.return_at_last_battery)
    return go_back({params_.start.x, params_.start.y}, "its battery is nearly empty");
  behaviour_.hold(Reason::none, now());
  tell({{},
        Severity::warning,
        "mode_changed",
        Reason::none,
        params_.name + " holds: its battery is nearly empty; its goal is kept"});
}

void Agent::Core::send_findings() {
  for (const findings::Finding* f : edges_.findings->due(commands_.stations().heard_ids(now()), now()))
    edges_.radio->send(*f, edges_.findings->size(), edges_.findings->overflowed());
}

}  // namespace adit::agent
