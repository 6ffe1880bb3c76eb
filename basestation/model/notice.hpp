// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "core/result/reason.hpp"

namespace adit::station {

enum class Level : std::uint8_t { info, warning, error };

/// A notification for operators, from a robot or from the station (lost, back).
struct Notice {
  std::uint64_t id{};  ///< Unique in one run of the station, rising from 1; never changes.
  double age{};        ///< Time since the event, s.
  std::string robot{};
  std::string operator_name{};  ///< The operator concerned; empty: all operators.
  Level level{Level::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
  bool mine{};  ///< It concerns this operator.
  bool operator==(const Notice&) const = default;
};

const char* to_string(Level level);

}  // namespace adit::station
