// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace adit::station::client {

/// The station that a front end uses, and how it is started if it does not run.
struct StationOptions {
  std::string name{"op1"};  ///< Name of the operator.
  /// Link profile that limits the traffic: one of config/links, or a .yaml file; empty: none.
  std::string link{};
  std::uint32_t domain{77};               ///< Radio domain, [0, 232].
  bool domain_given{false};               ///< A running station must be on `domain`.
  std::vector<std::string> interfaces{};  ///< IPv4 addresses of interfaces; empty: loopback.
  std::vector<std::string> peers{};       ///< Addresses of peers, for networks without multicast.
  std::vector<float> at{};                ///< Position X Y Z of the station, map frame, m; empty: unknown.
  std::string record{};   ///< Folder of recordings; empty: below the state folder; "none": no recording.
  std::string program{};  ///< Path of the program `basestation`, with which a station is started.
};

}  // namespace adit::station::client
