// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::command {

/// Parses one command line; the shell, the prompt, scenario scripts and buttons all use it. Errors (all wrong
/// usage): syntax, unknown_command (with the nearest one), bad_argument, out_of_range, mode_unknown; the text
/// is one line that says what to type.
Result<Request> parse(std::string_view line, Table rows = table());
Result<Request> parse(const std::vector<std::string>& words, Table rows = table());

}  // namespace adit::command
