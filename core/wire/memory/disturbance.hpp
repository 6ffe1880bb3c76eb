// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/wire/link/model.hpp"

namespace adit::wire {

/// Attenuation by obstacles between two positions, dB.
using Attenuation = std::function<double(const Position& a, const Position& b)>;

/// A temporary fault between machines. Several may be active at once, also of the same kind between the same
/// machines: each ends separately. The highest loss applies, delays add up, probabilities combine.
struct Disturbance {
  /// Affects frames from a machine of `from` to one of `to`; empty: all machines.
  std::vector<std::string> from{}, to{};
  bool both_ways{true};  ///< Affects also frames from `to` to `from`.
  /// If not empty, replaces `from` and `to`: affects machines of different groups; a machine without a group
  /// is not affected.
  std::vector<std::vector<std::string>> groups{};

  bool cut{};                    ///< Nothing passes.
  std::optional<double> loss{};  ///< Probability that a frame is lost, instead of the link's, [0, 1].
  Duration delay{};              ///< Added to the latency.
  double reorder{};              ///< Probability that a message is delayed by up to `reorder_by`, [0, 1].
  Duration reorder_by{200ms};
  double duplicate{};  ///< Probability that a message arrives twice, [0, 1].
  double slower{1.0};  ///< Divisor of the bandwidth, [1, 1e6].
};

using DisturbanceId = std::uint64_t;

/// The active disturbances.
class Disturbances {
 public:
  /// Combined effect of all disturbances on one direction.
  struct Effect {
    bool cut{};
    std::optional<double> loss{};
    Duration delay{};
    double reorder{};
    Duration reorder_by{};
    double duplicate{};
    double slower{1.0};
  };

  DisturbanceId add(Disturbance disturbance);
  void end(DisturbanceId id) { on_.erase(id); }
  Effect on(const std::string& from, const std::string& to) const;
  bool none() const { return on_.empty(); }

 private:
  std::map<DisturbanceId, Disturbance> on_{};
  DisturbanceId next_{1};
};

}  // namespace adit::wire
