// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::station {

/// Exit codes of the programs, and of a command's outcome.
inline constexpr int kExitDone = 0;
inline constexpr int kExitRefused = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitNoAnswer = 3;

}  // namespace adit::station
