// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "basestation/model/world.hpp"

namespace adit::gui {

/// The touch that a button needs.
enum class Touch : std::uint8_t {
  tap,
  hold,        ///< Press and hold: it takes something from someone, or concerns many robots.
  place,       ///< A tap on the map follows.
  place_held,  ///< A press on the map follows that is held.
};

/// A place of the action bar. Its position never changes.
struct Slot {
  const char* id{};  ///< As station::id_of(), "drive" or "convoy".
  const char* key{};
  const char* before{};  ///< The command line: before, robots, after.
  const char* after{};
  const char* label{};  ///< Where no robot knows the action.
  bool motion{};        ///< It can start motion: its key acts when it is released.
};
inline constexpr std::array kSlots{
    Slot{"take", "t", "take", "", "Take", false},
    Slot{"release", "r", "release", "", "Release", false},
    Slot{"lock", "l", "lock", "", "Lock", false},
    Slot{"mode_hold", "h", "mode", "hold", "Hold", false},
    Slot{"mode_waypoint", "w", "mode", "waypoint", "Waypoint", true},
    Slot{"goto", "g", "goto", "", "Go to", true},
    Slot{"home", "", "home", "", "Home", true},
    Slot{"explore", "x", "explore", "", "Explore", true},
    Slot{"drive", "m", "", "", "Drive", true},
    Slot{"convoy", "", "convoy start", "", "Convoy", true},
    Slot{"stop", "s", "stop", "", "Stop", false},
    Slot{"reset", "e", "reset", "", "Reset", false},
};

/// A button of the action bar in its present state.
struct BarButton {
  std::string id{}, label{}, key{};
  std::string hint{};                 ///< "2/3", or "from op2".
  std::string short_hint{};           ///< The same without names: "from another", "4 robots".
  std::string line{};                 ///< The command, with the robots' names.
  std::vector<std::string> robots{};  ///< Those that would accept it; empty: it is not possible now.
  Touch touch{Touch::tap};
  bool operator==(const BarButton&) const = default;
};

/// Why actions are not possible now for some robots, and what would change that.
struct Refusal {
  std::string label{};
  std::string robots{};      ///< "r1, r3".
  std::string why{};         ///< In words.
  std::string cure_label{};  ///< Empty: there is none.
  std::string cure_line{};
  bool cure_hold{};
  bool operator==(const Refusal&) const = default;
};

struct ActionBar {
  std::vector<BarButton> buttons{};  ///< One for each of kSlots, in their order.
  std::vector<Refusal> not_now{};
  bool operator==(const ActionBar&) const = default;
};

/// The robots' names as words of a command line.
std::string words_of(const std::vector<std::string>& robots);

/// Whether an action of so many robots needs a press that is held, or the Enter key: more than three, unless
/// it stops or holds them. `action`: as station::id_of().
bool needs_hold(std::string_view action, std::size_t robots);

/// What the robots of a selection would accept now, by their station's catalogue of actions.
ActionBar bar_of(const station::World& world, const std::vector<std::string>& selection);

}  // namespace adit::gui
