// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "core/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// The end of a command line.
struct Outcome {
  int exit_code{0};       ///< 0: done, 1: refused, 2: wrong usage, 3: no answer.
  std::string text{};     ///< Readable result; lines end in a newline.
  std::string error{};    ///< Readable refusals and reasons; lines end in a newline.
  nlohmann::json json{};  ///< The same for scripts, as one object.
};

/// The outcome of a command that was carried out. `values`: its result for scripts, an object.
Outcome done_outcome(const command::Request& request, std::string text,
                     const nlohmann::json& values = nlohmann::json::object());
/// The outcome of a refused command. `line`: for the operator, without the newline; `error`: for scripts;
/// empty: the reason says it all.
Outcome refused_outcome(const command::Request& request, Reason reason, const std::string& line,
                        const std::string& error = {});

/// The outcome of a line that was not run, e.g. as it does not parse.
Outcome failed_outcome(int exit_code, const Error& error);

}  // namespace adit::station
