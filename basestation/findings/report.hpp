// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "basestation/findings/book.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/findings/marks.hpp"
#include "basestation/fleet/fleet.hpp"
#include "basestation/map/chunk_store.hpp"
#include "basestation/model/found.hpp"
#include "core/findings/photo_store.hpp"

namespace adit::station {

inline constexpr double kSameObject = 2.0;  ///< m

/// The findings of the named robots and stations, or of all, where they are in the map now; the most
/// important first. Objects of one kind that the detectors of different robots found within kSameObject are
/// one: the finding with the lowest number is listed and names the others.
FoundReport findings_report(const FindingDesk& desk, const FindingBook& book, const Marks& marks,
                            const findings::PhotoStore& photos, const ChunkStore& chunks, const Fleet& fleet,
                            const std::vector<std::string>& robots);
std::string findings_text(const FoundReport& report);
/// As json_of(FoundReport), with the data and the owner of each finding.
nlohmann::json findings_json(const FoundReport& report, const FindingDesk& desk, const FindingBook& book);

}  // namespace adit::station
