// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command/map_commands.hpp"

namespace adit::agent {
namespace {

constexpr std::size_t kMaxJudged = 16;

}  // namespace

void MapCommands::handle(const Command& command, const Answered& answered) {
  if (command.request.verb == command::verb("goto") && !command.invalid) return judge(command, answered);
  const auto given = commands_.handle(command, services_.now());
  if (!given || !given->accepted() || command.request.verb != command::verb("plan")) return answered(given);
  services_.find_route(place_of(command.request),
                       [answered, given = *given](const Result<PlannedRoute>& route) {
                         Answer with_route = given;
                         with_route.reason = route ? Reason::none : route.reason();
                         if (route)
                           with_route.route = *route;
                         else
                           with_route.text = route.error().text;
                         answered(with_route);
                       });
}

void MapCommands::judge(const Command& asked, const Answered& answered) {
  const std::pair key{asked.from.participant, asked.seq};
  if (const auto same = judged_.find(key); same != judged_.end()) return (void)++same->second;
  if (judged_.size() >= kMaxJudged) return answered(commands_.handle(asked, services_.now()));
  judged_.emplace(key, 1);
  services_.check_goal(place_of(asked.request), asked.request.has("--nearest"),
                       [this, key, asked, answered](const Result<GoalReport>& report) {
                         const auto samples = judged_.extract(key);
                         Command command = asked;
                         if (report) command.goal = *report;
                         // The command interface answers a repeat with the first answer.
                         for (int n = samples ? samples.mapped() : 1; n > 0; --n)
                           answered(commands_.handle(command, services_.now()));
                       });
}

}  // namespace adit::agent
