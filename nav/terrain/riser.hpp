// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// Height of the lowest return of a stair's riser above its foot when seen from below, m.
inline constexpr double kRiser = 0.06;

}  // namespace adit::nav
