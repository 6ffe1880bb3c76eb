// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/contract/robot.hpp"

namespace adit::station {

using contract::Severity;

/// A notification for operators, from a robot or from the station (lost, back).
struct Notice : contract::Notification {
  std::uint64_t id{};  ///< Unique in one run of the station, rising from 1; never changes.
  double age{};        ///< Time since the event, s.
  bool mine{};         ///< It concerns this operator.
  bool operator==(const Notice&) const = default;
};

}  // namespace adit::station
