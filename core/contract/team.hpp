// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/contract/common.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"

namespace adit::radio {
class TeamBeacon;
}

namespace adit::contract {

inline constexpr double kBeaconUnitsPerMetre = 100.0;  ///< Points are sent as offsets in cm.

/// A robot's part in a convoy. Lengths are measured along the path that the leader drove, m.
struct ConvoyPart {
  static constexpr std::size_t kPoints = 8;  ///< Points of the path in one beacon.

  std::uint64_t convoy{};                 ///< Drawn by the station at each start of a convoy.
  std::uint32_t order_hash{};             ///< Of the names in their order.
  std::uint8_t index{};                   ///< Place in the order; 0: the leader.
  bool left{};                            ///< It left the convoy: its successors follow the one before it.
  bool placed{};                          ///< `along` is known.
  double along{};                         ///< Position on the path; negative: before its beginning.
  double gap{-1.0};                       ///< To the one before it, outline to outline; negative: unknown.
  std::uint32_t wanted{};                 ///< Number of the first point of the path that it lacks.
  std::uint32_t first{};                  ///< Number of the first of `points`.
  std::vector<Eigen::Vector3d> points{};  ///< Consecutive points of the path, map frame, m.
  bool operator==(const ConvoyPart&) const = default;
};

/// A robot asks others to make way. Map frame, m.
struct YieldAsk {
  static constexpr std::size_t kRobots = 4, kPoints = 12;

  std::vector<std::string> to{};  ///< The robots that are asked, at most kRobots.
  /// The robot that wants to pass: the sender, or one for which the sender makes way itself.
  std::string root{};
  double width{};                        ///< Of the corridor that must be free, m.
  std::vector<Eigen::Vector2d> route{};  ///< The way ahead, at most kPoints corners.
  bool operator==(const YieldAsk&) const = default;

  bool names(const std::string& robot) const { return std::find(to.begin(), to.end(), robot) != to.end(); }
};

/// A robot's answer to one that asked it to make way.
struct YieldAnswer {
  std::string root{};               ///< For which it makes way, or cannot.
  bool clears{};                    ///< False: it cannot.
  Reason reason{Reason::none};      ///< Why it cannot.
  Eigen::Vector2d place{0.0, 0.0};  ///< To which it drives, map frame, m.
  bool operator==(const YieldAnswer&) const = default;
};

/// The state of a robot as it sends it to the other robots.
struct TeamBeacon {
  std::string robot{};
  std::uint64_t start{};  ///< Random number of the start of its agent.
  std::uint32_t seq{};    ///< From 1 at each start.
  Pose2 pose{};           ///< Map frame.
  double z{};             ///< m
  Twist2 twist{};         ///< Body frame.
  std::string mode{};
  bool stopped{};
  std::string holder{};  ///< Empty: no holder.
  std::optional<ConvoyPart> convoy{};
  /// Its right of way, or that of the robot for which it makes way; the higher one passes.
  std::uint8_t rank{};
  bool yields{};  ///< Its holder allowed it to make way, and it could now.
  std::optional<YieldAsk> ask{};
  std::optional<YieldAnswer> answer{};
  bool operator==(const TeamBeacon&) const = default;
};

radio::TeamBeacon encode(const TeamBeacon& beacon);
/// Returns nothing if the beacon is malformed: a number that is not finite or that no robot can have, an
/// invalid name, too many entries.
std::optional<TeamBeacon> decode(const radio::TeamBeacon& sample);

}  // namespace adit::contract
