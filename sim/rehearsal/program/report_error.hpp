// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdio>

#include "core/result/result.hpp"

/// How the programs that read a scenario end, and how they say why.
namespace adit::sim {

inline constexpr int kExitFailed = 1;      ///< An expectation or a rule does not hold.
inline constexpr int kExitUnreadable = 2;  ///< The scenario, or a file it needs, is missing or unreadable.

/// One line on stderr; gives the exit status.
inline int report_error(const char* program, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", program, error.text.c_str());
  return kExitUnreadable;
}

}  // namespace adit::sim
