#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "basestation/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Parses one command line: the same in the shell, the prompt, a scenario's script and behind buttons.
/// Errors (all wrong usage): syntax, unknown_command (with the nearest one), bad_argument, out_of_range,
/// mode_unknown; the text is one line that tells what to type.
Result<Request> parse(std::string_view line);
Result<Request> parse(const std::vector<std::string>& words);

}  // namespace adit::station
