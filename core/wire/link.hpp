// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace adit::wire {

/// Priorities on a link, 0 first: `urgent` 0, discovery and acknowledgements 1, `stream` 2, `state` and
/// `sensor` 3, `status` 4, `bulk` 5, `video` 6.
inline constexpr std::size_t kPriorities = 7;

/// Position of a machine, world or map coordinates, m.
struct Position {
  double x{}, y{}, z{};
};

/// Properties of a radio link in one direction. The standard profiles are config/links/*.yaml; docs/links.md
/// gives the source of each key. core/wire/link/ has the model, which is the same live and in rehearsal.
struct LinkProfile {
  std::string name{"lan"};
  double bandwidth{100e6};  ///< Shared by all datagrams of a sender, bit/s, (0, 1e10].
  double latency{0.001};    ///< One-way latency, s, [0, 10].
  double loss{0.0};         ///< Probability that a frame is lost, [0, 1].
  double range{0.0};        ///< Range, m; frames beyond it are lost; 0: no limit.
  double queue{0.25};       ///< A message queued for longer is dropped at the sender, s, (0, 10].
  double jitter{0.0};       ///< Jitter added to the latency, uniform in [0, jitter], s, [0, 10].
  double burst{1.0};        ///< Mean number of consecutive frames lost, [1, 1000]; 1: losses are independent.
  /// 0: frames leave one after another. Otherwise nothing is queued, and what exceeds the bandwidth over this
  /// many seconds is dropped (SubT: 1), [0, 10].
  double window{0.0};
  /// Largest frame, headers included, bytes, [200, 65000]; 0: 500 below 250 kbit/s, else 1400. Live, a frame
  /// has room for at least 540, an endpoint's announcement.
  std::uint32_t frame{0};
  double fading{0.0};      ///< Path loss exponent, [0, 10]; 0: distance and walls have no effect.
  double path_loss{40.0};  ///< Path loss over the first metre, dB, [0, 200].
  double shadowing{0.0};   ///< Standard deviation of the received power from frame to frame, dB, [0, 40].
  double power{27.0};      ///< Transmit power, dBm, [-50, 60].
  double noise{-90.0};     ///< Noise power, dBm, [-150, 0].
  double wall{0.0};        ///< Attenuation per metre of solid material, on links that fade, dB, [0, 1000].
  /// Largest frame, bytes.
  std::uint32_t frame_bytes() const {
    if (frame > 0) return frame;
    return bandwidth < 250e3 ? 500 : 1400;
  }
};

}  // namespace adit::wire
