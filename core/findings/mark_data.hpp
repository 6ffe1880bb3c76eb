// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/findings/finding.hpp"

/// Marks: findings that an operator reports. A mark is a finding of the operator's station. Its key names the
/// station, its data the station's identity, which no finding of a robot has.
namespace adit::findings {

/// 128 random bits on a station's disk.
using StationId = std::array<std::uint8_t, 16>;

/// Data of a mark: a tag, a version and the station's identity, 21 bytes.
store::Bytes encode_mark(const StationId& station);
/// The station whose operator reported the finding; nothing: it is no mark.
std::optional<StationId> marked_by(const Finding& finding);

/// The importance of a kind where its reporter gives none: 9 (person, fire), 7 (gas, hazard) or 5.
std::uint8_t usual_importance(std::string_view kind);

}  // namespace adit::findings
