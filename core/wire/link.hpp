#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace adit::wire {

/// Priorities on a link, 0 first: `urgent` 0, discovery and acknowledgements 1, `stream` 2, `state` and
/// `sensor` 3, `status` 4, `bulk` 5, `video` 6.
inline constexpr std::size_t kPriorities = 7;

/// Where a machine is, world or map coordinates, m.
struct Position {
  double x{}, y{}, z{};
};

/// What a radio link gives in one direction. The standard ones are config/links/*.yaml; docs/links.md says
/// where each key comes from. core/wire/link/ has the model, the same live and in rehearsal.
struct LinkProfile {
  std::string name{"lan"};
  double bandwidth{100e6};  ///< bit/s shared by all that a sender sends, (0, 1e10]
  double latency{0.001};    ///< one way, s, [0, 10]
  double loss{0.0};         ///< chance that a frame is lost, [0, 1]
  double range{0.0};        ///< m; frames beyond it are lost; 0: no limit
  double queue{0.25};       ///< what waits longer than this to be sent is dropped at the sender, s, (0, 10]
  double jitter{0.0};       ///< added to the latency, uniform in [0, jitter], s, [0, 10]
  double burst{1.0};        ///< mean number of frames lost in a row, [1, 1000]; 1: each on its own
  double window{0.0};       ///< 0: frames leave one after another. Else nothing waits, and what exceeds the
                            ///< bandwidth over this many seconds is dropped (SubT: 1), [0, 10]
  std::uint32_t frame{0};   ///< largest frame, headers included, B, [200, 65000]; 0: 500 below 250 kbit/s,
                            ///< else 1400
  double fading{0.0};       ///< path loss exponent, [0, 10]; 0: distance and walls do not matter
  double path_loss{40.0};   ///< over the first metre, dB, [0, 200]
  double shadowing{0.0};    ///< standard deviation of the received power from frame to frame, dB, [0, 40]
  double power{27.0};       ///< sent, dBm, [-50, 60]
  double noise{-90.0};      ///< dBm, [-150, 0]
  double wall{0.0};         ///< attenuation by a metre of what is solid, on links that fade, dB, [0, 1000]
  /// Largest frame that is sent, B.
  std::uint32_t frame_bytes() const {
    if (frame > 0) return frame;
    return bandwidth < 250e3 ? 500 : 1400;
  }
};

}  // namespace adit::wire
