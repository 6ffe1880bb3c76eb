// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/pad_mapping.hpp"

#include <algorithm>

#include "core/command/words.hpp"

namespace adit::station::input {
namespace {

using namespace std::string_view_literals;

constexpr std::array kActionNames{"forward"sv,  "sideways"sv, "turn"sv,   "dead_man"sv, "stop"sv,
                                  "stop_all"sv, "let_go"sv,   "take"sv,   "drive"sv,    "next"sv,
                                  "previous"sv, "fast"sv,     "precise"sv};
static_assert(kActionNames.size() == kPadActions);

// Numbers and names of SDL 2 never change.
constexpr std::array kButtonNames{"a"sv,
                                  "b"sv,
                                  "x"sv,
                                  "y"sv,
                                  "back"sv,
                                  "guide"sv,
                                  "start"sv,
                                  "leftstick"sv,
                                  "rightstick"sv,
                                  "leftshoulder"sv,
                                  "rightshoulder"sv,
                                  "dpup"sv,
                                  "dpdown"sv,
                                  "dpleft"sv,
                                  "dpright"sv,
                                  "misc1"sv,
                                  "paddle1"sv,
                                  "paddle2"sv,
                                  "paddle3"sv,
                                  "paddle4"sv,
                                  "touchpad"sv};
constexpr std::array kAxisNames{"leftx"sv,  "lefty"sv,       "rightx"sv,
                                "righty"sv, "lefttrigger"sv, "righttrigger"sv};

constexpr std::array kDefaults{"lefty", "leftx",   "rightx", "leftshoulder",  "a",          "back", "b", "x",
                               "start", "dpright", "dpleft", "rightshoulder", "lefttrigger"};
static_assert(kDefaults.size() == kPadActions);

bool is_axis(PadAction action) { return action <= PadAction::turn; }
/// Without these, a robot could not be halted by the controller, or would drive without a hand.
bool is_needed(PadAction action) { return action >= PadAction::dead_man && action <= PadAction::let_go; }

PadInput parse(std::string_view name) {
  if (const auto at = std::ranges::find(kButtonNames, name); at != kButtonNames.end())
    return {PadInput::Kind::button, static_cast<int>(at - kButtonNames.begin())};
  const bool reversed = name.starts_with('-');
  if (reversed) name.remove_prefix(1);
  if (const auto at = std::ranges::find(kAxisNames, name); at != kAxisNames.end())
    return {PadInput::Kind::axis, static_cast<int>(at - kAxisNames.begin()), reversed};
  return {};
}

}  // namespace

PadMapping::PadMapping() {
  for (std::size_t i = 0; i < kPadActions; ++i) inputs_[i] = parse(kDefaults[i]);
}

Result<void> PadMapping::set(PadAction action, const std::string& name) {
  const std::string shown = command::clean(name, 40);
  const std::string what(kActionNames[static_cast<std::size_t>(action)]);
  PadInput input;
  if (name == "none") {
    if (is_needed(action)) return Error{Reason::bad_argument, what + " needs a button"};
  } else {
    input = parse(name);
    if (input.kind == PadInput::Kind::none) {
      std::vector<std::string> known(kButtonNames.begin(), kButtonNames.end());
      known.insert(known.end(), kAxisNames.begin(), kAxisNames.end());
      const std::string meant = command::nearest(name, known);
      return Error{Reason::bad_argument, "no button or axis '" + shown + "'" +
                                             (meant.empty() ? "" : ", did you mean " + meant + "?")};
    }
    if (is_axis(action) && input.kind != PadInput::Kind::axis)
      return Error{Reason::bad_argument, what + " is an axis, not the button " + shown};
  }
  inputs_[static_cast<std::size_t>(action)] = input;
  return {};
}

std::vector<PadMapping::Clash> PadMapping::resolve() {
  // The dead man's switch and the stops come before the axes, which come before the rest.
  constexpr std::array kOrder{PadAction::dead_man, PadAction::stop, PadAction::stop_all, PadAction::let_go,
                              PadAction::forward,  PadAction::turn, PadAction::sideways, PadAction::take,
                              PadAction::drive,    PadAction::next, PadAction::previous, PadAction::fast,
                              PadAction::precise};
  std::vector<Clash> clashes;
  for (std::size_t i = 0; i < kOrder.size(); ++i) {
    PadInput& later = inputs_[static_cast<std::size_t>(kOrder[i])];
    if (later.kind == PadInput::Kind::none) continue;
    for (std::size_t j = 0; j < i; ++j) {
      const PadInput& earlier = of(kOrder[j]);
      if (earlier.kind != later.kind || earlier.index != later.index) continue;
      clashes.push_back({kOrder[j], kOrder[i], name_of(earlier)});
      later = {};
      break;
    }
  }
  // Without a dead man's switch or a stop there is no driving: then all is as it was made.
  const bool complete = std::all_of(kOrder.begin(), kOrder.end(), [this](PadAction action) {
    return !is_needed(action) || of(action).kind != PadInput::Kind::none;
  });
  if (!complete) *this = {};
  return clashes;
}

std::span<const std::string_view> pad_action_names() { return kActionNames; }
std::span<const std::string_view> pad_button_names() { return kButtonNames; }
std::span<const std::string_view> pad_axis_names() { return kAxisNames; }

std::string name_of(const PadInput& input) {
  if (input.kind == PadInput::Kind::none) return "none";
  const auto index = static_cast<std::size_t>(input.index);
  if (input.kind == PadInput::Kind::button) return std::string(kButtonNames[index]);
  return (input.reversed ? "-" : "") + std::string(kAxisNames[index]);
}

}  // namespace adit::station::input
