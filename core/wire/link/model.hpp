#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "core/time/random.hpp"
#include "core/time/time.hpp"
#include "core/wire/link.hpp"

/// The one link model: pure, seeded from outside, used by the rehearsal's radio and by the live transport.
namespace adit::wire {

/// m
double distance(const Position& a, const Position& b);

/// What lies between two machines.
struct Path {
  std::optional<double> distance{};  ///< m; none: not known, then neither range nor fading count
  double walls{};                    ///< attenuation by walls, dB
};

/// Mean received power, dBm: power - path_loss - 10 * fading * log10(distance) - walls, after the public SubT
/// simulator (osrf/subt, subt_rf_interface, log-normal range model). Nothing where the link does not fade or
/// the distance is not known; below -300 beyond the range.
std::optional<double> received_power(const LinkProfile& link, const Path& path);

/// Chance that a frame of that many bytes is lost at that received power, dBm, over that noise, dBm: QPSK's
/// bit errors, erfc(sqrt(signal / noise)), one of which loses the frame (osrf/subt,
/// subt_communication_model).
double fading_loss(double power, double noise, std::uint32_t bytes);

/// One direction between two machines: remembers whether it is in a burst of losses.
class LossModel {
 public:
  /// Whether a frame of that many bytes is lost. `loss`: instead of the link's own chance.
  bool lost(const LinkProfile& link, const Path& path, std::uint32_t bytes, std::optional<double> loss,
            Random& random);

 private:
  bool bad_{};  // Gilbert-Elliott: everything is lost in the bad state, nothing in the good one
};

/// Latency of one frame, with its jitter.
Duration transit(const LinkProfile& link, Random& random);

/// Bits of the last `window` seconds against capacity, as the SubT simulator counts them.
class Window {
 public:
  /// Whether that many bytes may still be sent now; counts them when they may.
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
