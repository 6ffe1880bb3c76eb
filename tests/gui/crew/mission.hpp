// SPDX-License-Identifier: Apache-2.0
// The work of ten robots, and what goes wrong meanwhile. Pure.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace adit::gui::crew {

inline constexpr std::size_t kRobots = 10;
inline constexpr std::size_t kGoals = 4;  ///< Of each robot.

struct Place {
  double x{}, y{};  ///< Map frame, m.
};

/// What happens to a robot on its way to one of its goals.
enum class Event : std::uint8_t {
  blocked,   ///< The goal is inside a pillar that is not seen before the robot is near.
  stopped,   ///< Another operator stops it.
  cut,       ///< Its radio link is gone for a while.
  hung,      ///< Its driver does not answer for a while.
  handover,  ///< Another operator asks for it, drives nowhere, and releases it.
};
const char* to_string(Event event);

struct Intervention {
  std::size_t robot{}, goal{};
  Event event{};
  double after{};  ///< Time after the goal was accepted, s.
};

/// Each robot is in a gallery of its own, 4 m wide.
struct Mission {
  double length{};  ///< Of a gallery, m.
  std::array<std::array<Place, kGoals>, kRobots> goals{};
  std::vector<Intervention> interventions{};

  /// Draws goals at alternating ends of the galleries, and ten interventions: 2 blocked, 2 stopped by op2, 3
  /// lost links, 1 hung part, 2 hand-overs, each of another robot. `length`: at least 15 m.
  static Mission draw(std::uint64_t seed, double length);
  const Intervention* intervention(std::size_t robot, std::size_t goal) const;
  /// Where a robot begins.
  static Place start(std::size_t robot);
  /// Where to send a robot whose goal turns out to be blocked: beside the pillar.
  Place instead(std::size_t robot, std::size_t goal) const;
  /// The scenario of one robot for the program `simulate`.
  std::string scenario(std::size_t robot) const;
};
inline std::string name_of(std::size_t robot) { return "r" + std::to_string(robot + 1); }

/// What an operator can see of a robot: texts of its card.
struct Seen {
  std::string holder{}, headline{}, detail{};
};

/// What an operator does next with a robot, by what he sees alone.
enum class Step : std::uint8_t { wait, take, lock, reset, go_on, next_goal, another_way };
Step next_step(const Seen& seen);

/// How far a robot is.
struct Progress {
  std::size_t goals_sent{};  ///< Goals that were commanded; the last one is the one under way.
  bool left{};               ///< It was seen under way to the last one of these.
  bool arrived{};            ///< At that one, after it was under way.
  bool done() const { return goals_sent == kGoals && arrived; }
  /// Notes what is seen of the robot.
  void see(const Seen& seen) {
    if (goals_sent > 0 && seen.detail != "arrived") left = true;
    arrived = left && seen.detail == "arrived";
  }
};

}  // namespace adit::gui::crew
