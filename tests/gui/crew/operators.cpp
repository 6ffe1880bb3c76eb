// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/crew/operators.hpp"

#include <nlohmann/json.hpp>

#include "basestation/gui/bridge/card.hpp"
#include "basestation/model/json.hpp"

namespace adit::gui::crew {
namespace {

std::string text_of(double metres) { return std::to_string(metres); }

}  // namespace

ShellOperators::ShellOperators(const Mission& mission, const Crew& crew) : mission_(mission), crew_(crew) {
  for (std::size_t robot = 0; robot < kRobots; ++robot)
    threads_.emplace_back([this, robot] { operate(robot); });
}

ShellOperators::~ShellOperators() {
  ends_ = true;
  for (std::thread& thread : threads_) thread.join();
}

std::array<Progress, kRobots> ShellOperators::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void ShellOperators::operate(std::size_t robot) {
  const std::string name = name_of(robot);
  const auto give = [&](std::vector<std::string> words) {
    ++commands_;
    const bool done = crew_.shell("op1", std::move(words)).exit_code == 0;
    if (!done) ++refused_;
    return done;
  };
  Progress at{};
  while (!ends_ && !at.done()) {
    live::eventually([this] { return ends_.load(); }, kLook);
    const auto status =
        nlohmann::json::parse(crew_.shell("op1", {"--json", "status", name}).out, nullptr, false);
    const auto known = station::robot_from(status);
    if (!known) continue;
    const Card card = card_of(*known, 1, 0.0, 1.0);
    const Place goal = at.goals_sent > 0 ? mission_.goals[robot][at.goals_sent - 1] : Place{};
    const Seen seen{card.holder, card.headline, card.detail};
    at.see(seen);
    if (crew_.asked(robot) && known->mine) {
      give({"grant", name, "op2"});
      continue;
    }
    switch (next_step(seen)) {
      case Step::wait:
        break;
      case Step::take:
        give({"take", name});
        break;
      case Step::lock:
        give({"lock", name});
        break;
      case Step::reset:
        give({"reset", name, "--override"});
        break;
      case Step::go_on:
        give({"mode", name, "waypoint"});
        break;
      case Step::another_way: {
        const Place other = mission_.instead(robot, at.goals_sent - 1);
        give({"goto", name, text_of(other.x), text_of(other.y)});
        break;
      }
      case Step::next_goal:
        if (at.goals_sent > 0 &&
            card.detail == "ready") {  // The goal got lost, e.g. with a change of holder.
          give({"goto", name, text_of(goal.x), text_of(goal.y)});
          break;
        }
        if (at.goals_sent == 0 || (at.arrived && !at.done())) {
          const Place next = mission_.goals[robot][at.goals_sent];
          if (give({"goto", name, text_of(next.x), text_of(next.y)})) at = {at.goals_sent + 1, false, false};
        }
        break;
    }
    const std::lock_guard lock(mutex_);
    progress_[robot] = at;
  }
}

}  // namespace adit::gui::crew
