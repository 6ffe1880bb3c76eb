// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/findings/finding.hpp"

/// Marks: findings that an operator reports. A mark is a finding of the operator's station: its key names the
/// station and, as the owner, the station's identity; its data is a tag, which no finding of a robot has.
namespace adit::findings {

/// Data of a mark: a tag and a version, 5 bytes.
store::Bytes encode_mark();
/// The station whose operator reported the finding; nothing: it is no mark.
std::optional<Owner> marked_by(const Finding& finding);

/// The importance of a kind where its reporter gives none: 9 (person, fire), 7 (gas, hazard) or 5.
std::uint8_t usual_importance(std::string_view kind);

}  // namespace adit::findings
