// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "basestation/fleet/views.hpp"
#include "core/store/disk.hpp"

namespace adit::station {

/// Parameters of a station: identity and rates.
struct StationParams {
  std::string name{"op1"};  ///< Name of the operator: 1 to 32 characters of [A-Za-z0-9_-].
  Id id{};                  ///< 128 random bits stored on the station's disk.
  std::uint64_t seed{1};    ///< Seed of the phase of the periodic messages.
  std::string software{};   ///< Version that is announced to the peers.
  std::string link{};       ///< Name of the link profile; empty: the traffic is not limited.
  double bandwidth{0.0};    ///< Bandwidth of that link, bit/s; 0: unknown.
  std::optional<std::array<float, 3>> place{};  ///< Position of the station, map frame, m.
  std::shared_ptr<store::Disk> disk{};          ///< Stores findings; null: in memory only.
  bool content{true};                           ///< Takes findings and maps of robots.
  Duration presence{std::chrono::seconds(1)};   ///< Period of the heartbeats, [0.1 s, 1 s].
  /// Time after the start in which a robot may stay unknown.
  Duration discovery_grace{std::chrono::seconds(5)};
  /// After the start queries wait this long, and up to twice as long for missing messages.
  Duration settle{std::chrono::seconds(1)};
};

}  // namespace adit::station
