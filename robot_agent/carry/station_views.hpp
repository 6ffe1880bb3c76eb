// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <string>

#include "core/time/time.hpp"
#include "core/transfer/piece.hpp"

namespace adit::agent {

/// Decides whether a carrier should send a robot's map to a station, from what stations said of their maps.
class StationViews {
 public:
  static constexpr std::size_t kMaxStations = 16;
  /// A robot whose pieces a station acknowledged more recently sends its map itself.
  static constexpr Duration kDirect = 15s;
  /// A station that listed no digest of a map for this long has none of it.
  static constexpr Duration kDigestWait = 10s;

  void heard(const transfer::Ack& ack, Time now);
  /// Whether the station should get that robot's map from a carrier now.
  bool wants(const transfer::PeerId& station, const std::string& robot, Time now) const;

 private:
  struct View {
    std::uint32_t start{};
    Time joined{}, heard{};
    bool all_digests{false};
    std::set<std::string> digests{};       ///< Robots whose digest came.
    std::map<std::string, Time> direct{};  ///< When the station said that it receives a robot's own pieces.
  };
  std::map<transfer::PeerId, View> views_{};
};

}  // namespace adit::agent
