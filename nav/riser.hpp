// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// From below, the lowest return of a stair's riser lies so much above its foot, m.
inline constexpr double kRiser = 0.06;

}  // namespace adit::nav
