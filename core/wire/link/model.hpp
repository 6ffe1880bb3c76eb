// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "core/time/random.hpp"
#include "core/time/time.hpp"
#include "core/wire/link.hpp"

/// The link model, shared by the rehearsal's radio and the live transport. It has no state of its own; the
/// caller passes the random generator.
namespace adit::wire {

/// Distance between two positions, m.
double distance(const Position& a, const Position& b);

/// Propagation path between two machines.
struct Path {
  std::optional<double> distance{};  ///< Distance, m; none: unknown, then neither range nor fading apply.
  double walls{};                    ///< Attenuation by walls, dB.
};

/// Mean received power, dBm: power - path_loss - 10 * fading * log10(distance) - walls, after the public SubT
/// simulator (osrf/subt, subt_rf_interface, log-normal range model). Nothing when the link does not fade or
/// the distance is not known; below -300 beyond the range.
std::optional<double> received_power(const LinkProfile& link, const Path& path);

/// Probability that a frame of `bytes` bytes is lost at that received power, dBm, over that noise, dBm: the
/// bit error rate of QPSK, erfc(sqrt(signal / noise)), where one bit error loses the frame (osrf/subt,
/// subt_communication_model).
double fading_loss(double power, double noise, std::uint32_t bytes);

/// Loss process of one direction between two machines, with the state of the current burst (Gilbert-Elliott
/// model).
class LossModel {
 public:
  /// Whether a frame of `bytes` bytes is lost. `loss` replaces the link's own probability.
  bool lost(const LinkProfile& link, const Path& path, std::uint32_t bytes, std::optional<double> loss,
            Random& random);

 private:
  bool bad_{};  // Gilbert-Elliott: every frame is lost in the bad state, none in the good one.
};

/// Latency of one frame, jitter included.
Duration transit(const LinkProfile& link, Random& random);

/// Rate limit over the last `window` seconds, as the SubT simulator counts it.
class Window {
 public:
  /// Whether `bytes` bytes may be sent now; counts them if so.
  bool admit(const LinkProfile& link, std::uint32_t bytes, Duration now);

 private:
  struct Sent {
    Duration at{};
    std::uint32_t bytes{};
  };
  std::deque<Sent> sent_{};
  std::uint64_t total_{};
};

}  // namespace adit::wire
