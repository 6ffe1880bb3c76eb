// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "core/result/reason.hpp"

namespace adit::agent {

enum class Severity : std::uint8_t { info, warning, error };

/// A notification for operators.
struct Notice {
  std::string operator_name{};  ///< The operator concerned; empty: all operators.
  Severity severity{Severity::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
};

}  // namespace adit::agent
