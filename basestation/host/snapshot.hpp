// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/model/world.hpp"
#include "basestation/station/station.hpp"

namespace adit::station::host {

/// What front ends receive of the station now. Call it on the station's strand.
World world_of(const Station& station);

}  // namespace adit::station::host
