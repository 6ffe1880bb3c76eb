// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>

namespace adit {

using Duration = std::chrono::nanoseconds;
using namespace std::chrono_literals;

/// The monotonic clock of one machine, with an arbitrary start. Times of different machines are never
/// compared.
struct MachineClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
};
using Time = std::chrono::time_point<MachineClock, Duration>;

/// Converts a duration to seconds.
inline double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
inline Duration from_seconds(double s) { return Duration(static_cast<std::int64_t>(s * 1e9)); }
/// Nanoseconds since the clock's start, the format of stamps on the wire.
inline std::uint64_t to_stamp(Time t) { return static_cast<std::uint64_t>(t.time_since_epoch().count()); }
inline Time from_stamp(std::uint64_t ns) { return Time(Duration(static_cast<std::int64_t>(ns))); }

}  // namespace adit
