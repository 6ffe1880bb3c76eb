#pragma once
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"
#include "core/result/result.hpp"

namespace adit::station::cli {

/// One line of a scenario's script.
struct ScriptLine {
  double at{};  ///< s from the start
  std::string by{};
  std::string line{};
  std::string say{};  ///< told to whoever looks on, before the line is run
};

/// The `script:` of a scenario, in the order of time. Errors: cannot_read, syntax, and whatever is wrong with
/// a line, with file and line number; a command that does not parse is one of them.
Result<std::vector<ScriptLine>> read_script(const std::string& path);

/// Plays it on the real clock: the lines of options.name, or every operator's at his station. A refusal is an
/// event, not a failure. 0 at the end, 3 when a station went away, 130 when interrupted.
int play(const Options& options, const std::vector<ScriptLine>& script, bool all_operators);

}  // namespace adit::station::cli
