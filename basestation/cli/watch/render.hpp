// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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
std::vector<std::string> render(const nlohmann::json& snapshot, const WatchState& state, int rows,
                                int columns, bool colour);

/// The robots' names in display order.
std::vector<std::string> robots_of(const nlohmann::json& snapshot);

}  // namespace adit::station::cli
