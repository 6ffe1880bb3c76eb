#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace adit::station {

/// How a command line ended.
struct Outcome {
  int exit_code{0};       ///< 0 done, 1 refused, 2 wrong usage, 3 no answer
  std::string text{};     ///< for people: what was done or asked for; lines end in \n
  std::string error{};    ///< for people: what was refused and why; lines end in \n
  nlohmann::json json{};  ///< the same for scripts: one object
};

}  // namespace adit::station
