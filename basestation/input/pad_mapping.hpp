// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::station::input {

/// An action of a button or an axis of the game controller.
enum class PadAction : std::uint8_t {
  // Axes.
  forward,
  sideways,
  turn,
  // Buttons, the most important ones first.
  dead_man,
  stop,
  stop_all,
  let_go,
  take,
  drive,
  next,
  previous,
  fast,
  precise,
};
inline constexpr std::size_t kPadActions = 13;

/// A button or an axis of a game controller, by the names of SDL.
struct PadInput {
  enum class Kind : std::uint8_t { none, button, axis };
  Kind kind{Kind::none};
  int index{-1};         ///< As SDL_GameControllerButton or SDL_GameControllerAxis.
  bool reversed{false};  ///< Of an axis: "-lefty".
  bool operator==(const PadInput&) const = default;
};

/// The assignment of inputs to actions. An axis that stands for a button counts as pressed beyond its half.
class PadMapping {
 public:
  /// The layout of docs/gui.md.
  PadMapping();
  const PadInput& of(PadAction action) const { return inputs_[static_cast<std::size_t>(action)]; }
  /// Gives an action another input, by its name ("leftshoulder", "lefttrigger", "-righty", "none"). Reasons
  /// of errors: bad_argument (the name is none, or not one for that action).
  Result<void> set(PadAction action, const std::string& name);
  /// Takes inputs away from actions that share one with a more important action; returns what that changed,
  /// in words, and the actions. If a stop or the dead man's switch would be without an input, the mapping is
  /// the default one.
  struct Clash {
    PadAction keeps{}, loses{};
    std::string input{};
  };
  std::vector<Clash> resolve();
  bool operator==(const PadMapping&) const = default;

 private:
  std::array<PadInput, kPadActions> inputs_{};
};

/// Names of the actions in the settings, in the order of PadAction.
std::span<const std::string_view> pad_action_names();
/// SDL's names, in the order of its numbers.
std::span<const std::string_view> pad_button_names();
std::span<const std::string_view> pad_axis_names();
std::string name_of(const PadInput& input);

}  // namespace adit::station::input
