// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "core/findings/finding.hpp"
#include "core/geometry/staircase.hpp"
#include "core/result/result.hpp"

namespace adit::findings {

/// Kind of a finding that is a staircase. Its position is Staircase::foot, its data what encode_stairs()
/// writes.
inline constexpr const char* kStairs = "stairs";

/// Encodes all but the foot, at most 32 bytes: a version, then multiples of 0.1 mm and 0.1 mrad.
store::Bytes encode_stairs(const Staircase& stairs);

/// Decodes the staircase of a finding, from anyone. Errors: wrong_protocol for another version; malformed for
/// another kind, truncated data, bytes behind its end, or a staircase that is not valid().
Result<Staircase> stairs_of(const Finding& finding);

}  // namespace adit::findings
