#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::command {

/// Splits a command line at blanks. 'single' and "double" quotes keep blanks together; outside single
/// quotes a backslash takes the next character as it is. Errors: syntax (a quote that does not end, a control
/// character, a line over 4096 bytes).
Result<std::vector<std::string>> split_words(std::string_view line);

/// The candidate that is most likely meant by `typed`: starts with it, or is at most two edits away
/// (insertion, deletion, substitution, swap of neighbours). Empty when none is near.
std::string nearest(std::string_view typed, const std::vector<std::string>& candidates);

/// A name that travels on the radio: 1 to 32 of [A-Za-z0-9_-].
bool valid_name(std::string_view name);

/// Text from the radio as a terminal may show it: printable ASCII, at most `limit` bytes.
std::string clean(std::string_view text, std::size_t limit);

/// "a, b, c"; `none` when empty.
std::string joined(const std::vector<std::string>& words, std::string_view none);

}  // namespace adit::command
