// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace adit::agent {

/// Start of the console's answer to a line that was not executed.
inline constexpr const char* kConsoleRefusal = "refused: ";

inline std::string refused_at_console(const std::string& why) { return kConsoleRefusal + why + "\n"; }

}  // namespace adit::agent
