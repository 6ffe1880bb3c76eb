// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::command {

/// Splits a command line at blanks. Single and double quotes group words with blanks; outside single quotes a
/// backslash takes the next character literally. Errors: syntax (a quote that does not end, a control
/// character, a line over 4096 bytes).
Result<std::vector<std::string>> split_words(std::string_view line);

/// Returns the candidate that `typed` most likely means: one that starts with it, or is at most one edit away
/// for each three letters typed, two at most (insertion, deletion, substitution, swap of neighbours). Empty
/// when there is none.
std::string nearest(std::string_view typed, const std::vector<std::string>& candidates);

/// Whether a name may be sent over the radio: 1 to 32 of [A-Za-z0-9_-].
bool valid_name(std::string_view name);

/// Whether a robot may have a name: a valid one that no command reads as another word, as `all` or
/// `--override`.
bool valid_robot_name(std::string_view name);

/// What valid_robot_name() expects, for errors.
inline constexpr const char* kRobotName = "1 to 32 of [A-Za-z0-9_-], not 'all' and no '-' first";

/// Makes text from the radio safe for a terminal: printable ASCII, at most `limit` bytes.
std::string clean(std::string_view text, std::size_t limit);

/// Joins words as "a, b, c"; returns `none` when there are none.
std::string joined(const std::vector<std::string>& words, std::string_view none);

}  // namespace adit::command
