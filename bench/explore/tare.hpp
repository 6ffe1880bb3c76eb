// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace adit::bench {

/// Medians of TARE (Cao et al., Science Robotics 2023; docs/references.md) in the worlds of seed 0, at 2 m/s
/// and 1.5 m/s2 with perfect odometry, from its first scan. Five runs in blocks3, three in blocks5.
struct TareRow {
  std::string_view world;
  std::array<double, 5> times;  ///< To 50, 90, 95, 97 and 99 %, s; not all runs came to the last two.
  double metres;                ///< Driven until 99 %, m.
  std::string_view done;        ///< When it says that it has finished, s, and the share then.
};
inline constexpr std::array kTare{
    TareRow{"blocks3", {39, 84, 90, 92, 93}, 166, "89-101 at 0.969-0.997"},
    TareRow{"blocks5", {92, 181, 200, 213, 229}, 415, "221-241 at 0.984-0.996"},
};

}  // namespace adit::bench
