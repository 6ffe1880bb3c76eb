#pragma once
#include <cstdint>
#include <string>

#include "core/result/reason.hpp"

namespace adit::agent {

enum class Severity : std::uint8_t { info, warning, error };

/// Something an operator should know.
struct Notice {
  std::string operator_name{};  ///< whom it concerns; empty: everybody
  Severity severity{Severity::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
};

}  // namespace adit::agent
