// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/outcome.hpp"

#include <utility>

namespace adit::station {

Outcome done_outcome(const command::Request& request, std::string text, const nlohmann::json& values) {
  Outcome outcome{.text = std::move(text), .json = values};
  outcome.json.update({{"command", request.info->name}, {"exit", 0}, {"ok", true}});
  return outcome;
}

Outcome refused_outcome(const command::Request& request, Reason reason, const std::string& line,
                        const std::string& error) {
  Outcome outcome{.exit_code = 1, .error = line + "\n"};
  outcome.json = {{"command", request.info->name}, {"exit", 1}, {"ok", false}, {"reason", name(reason)}};
  if (!error.empty()) outcome.json["error"] = error;
  return outcome;
}

Outcome failed_outcome(int exit_code, const Error& error) {
  return {
      .exit_code = exit_code,
      .error = error.text + "\n",
      .json = {{"exit", exit_code}, {"ok", false}, {"reason", name(error.reason)}, {"error", error.text}}};
}

}  // namespace adit::station
