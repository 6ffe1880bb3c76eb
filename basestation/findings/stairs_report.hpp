// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/findings/book.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/fleet/fleet.hpp"
#include "basestation/map/chunk_store.hpp"
#include "basestation/model/stairs.hpp"

namespace adit::station {

/// The staircases of the map, merged from all findings of kind stairs, and who of the fleet may climb them.
/// Rejecting the finding whose number a staircase has rejects it; other rejected findings are left out of its
/// values.
StairsReport stairs_report(const FindingDesk& desk, const FindingBook& book, const ChunkStore& chunks,
                           const Fleet& fleet);
std::string stairs_text(const StairsReport& report);

}  // namespace adit::station
