// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"
#include "core/result/result.hpp"

namespace adit::station::cli {

/// One line of a scenario's script.
struct ScriptLine {
  double at{};  ///< Time from the start, s.
  std::string by{};
  std::string line{};
  std::string say{};  ///< Text shown to viewers before the line is run.
};

/// Reads the `script:` of a scenario, in the order of time. Errors: cannot_read, syntax, and invalid lines,
/// e.g. a command that does not parse, with file and line number.
Result<std::vector<ScriptLine>> read_script(const std::string& path);

/// Plays a script on the real clock: the lines of options.name, or of every operator at the operator's own
/// station. A refused command does not end the play. Returns 0 at the end, 1 if a command was refused, 2 if
/// the script has no line of that operator, 3 if a command had no answer or the connection to a station was
/// lost, 130 if interrupted.
int play(const Options& options, const std::vector<ScriptLine>& script, bool all_operators);

}  // namespace adit::station::cli
