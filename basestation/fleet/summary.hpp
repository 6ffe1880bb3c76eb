// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/fleet/fleet.hpp"
#include "basestation/model/world.hpp"

namespace adit::station {

/// What front ends receive of the fleet. The link and the counts of commands are left empty.
World world_of(const Fleet& fleet, Time now);

}  // namespace adit::station
