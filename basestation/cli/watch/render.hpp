#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace adit::station::cli {

/// What the dashboard shows besides the fleet.
struct WatchState {
  std::string selected{};  ///< robot
  std::string message{};   ///< answer to the last key
  bool refused{false};     ///< the message is a refusal
  bool help{false};
  bool driving{false};  ///< the keys are the stick of the selected robot
  std::string driving_text{};
  bool typing{false};  ///< a command line is being typed
  std::string line{};
  bool silent{false};  ///< the station does not answer
};

/// The dashboard as `rows` lines of at most `columns` cells. Colours by escape sequences when `colour`; they
/// take no cells. Pure: same input, same lines.
std::vector<std::string> render(const nlohmann::json& snapshot, const WatchState& state, int rows,
                                int columns, bool colour);

/// The robots' names in the order shown.
std::vector<std::string> robots_of(const nlohmann::json& snapshot);

}  // namespace adit::station::cli
