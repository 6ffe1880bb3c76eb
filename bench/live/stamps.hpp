// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <ctime>

namespace adit::bench {

/// Nanoseconds on the machine's monotonic clock, the same in every process of it.
inline std::int64_t monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

/// When sample k passed each place; shared by the processes of the benchmark. Zero: not seen.
struct Stamps {
  static constexpr std::size_t kSamples = 600;
  using Column = std::array<std::atomic<std::int64_t>, kSamples>;
  Column stick_written;   ///< Before the station writes the joystick sample.
  Column cmd_written;     ///< After the agent's write of rt/cmd_vel returned.
  Column driver_called;   ///< In the driver's callback.
  Column bare_written;    ///< Before a bare Fast DDS write of a payload of that size.
  Column bare_called;     ///< In the bare reader's callback in the agent's process.
  Column second_written;  ///< Before the second bare write, from there to the driver.
  Column relayed;         ///< After that second write returned.
  Column second_called;
  std::atomic<bool> agent_ready, driver_ready, stop;

  static void note(Column& column, std::size_t k) {
    std::int64_t none = 0;
    if (k < kSamples) column[k].compare_exchange_strong(none, monotonic_ns());
  }
};

}  // namespace adit::bench
