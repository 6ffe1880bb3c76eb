// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/input/pad_mapping.hpp"

namespace adit::gui {

/// The operator's settings of the window.
struct SettingsValues {
  static constexpr double kMinScale = 0.6, kMaxScale = 2.5;

  bool light{false};  ///< The light theme.
  bool glove{false};  ///< Larger targets, longer presses.
  double scale{1.0};  ///< Size of a millimetre, of what the screen states, [kMinScale, kMaxScale].
  bool operator==(const SettingsValues&) const = default;
};

/// The settings of a file, and what is wrong with it.
struct SettingsRead {
  SettingsValues values{};
  station::input::PadMapping pad{};     ///< Buttons of the game controller.
  std::vector<std::string> problems{};  ///< "line 3: ...".
};

/// Reads the text of gui.yaml. What is wrong is reported, and the rest is used.
SettingsRead read_settings(const std::string& text);
std::string settings_text(const SettingsValues& values, const station::input::PadMapping& pad = {});

}  // namespace adit::gui
