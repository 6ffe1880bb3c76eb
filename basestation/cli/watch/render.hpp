// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/world.hpp"

namespace adit::station::cli {

/// State of the dashboard beside the fleet.
struct WatchState {
  std::string selected{};  ///< Name of the selected robot.
  std::string message{};   ///< Answer to the last key.
  bool refused{false};     ///< The message is a refusal.
  bool help{false};
  bool driving{false};  ///< The keys steer the selected robot.
  std::string driving_text{};
  bool typing{false};  ///< A command line is being typed.
  std::string line{};
  bool silent{false};  ///< The station does not answer.
};

/// Renders the dashboard as `rows` lines of at most `columns` cells. `colour`: adds escape sequences, which
/// take no cells. A pure function.
std::vector<std::string> render(const World& world, const WatchState& state, int rows, int columns,
                                bool colour);

/// The robots' names in display order.
std::vector<std::string> names_of(const World& world);

}  // namespace adit::station::cli
