// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace adit::station {

/// How a command line ended.
struct Outcome {
  int exit_code{0};       ///< 0: done, 1: refused, 2: wrong usage, 3: no answer.
  std::string text{};     ///< Readable result; lines end in a newline.
  std::string error{};    ///< Readable refusals and reasons; lines end in a newline.
  nlohmann::json json{};  ///< The same for scripts, as one object.
};

}  // namespace adit::station
