// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "core/result/reason.hpp"

namespace adit::agent {

/// What a robot does when nothing is left to explore.
enum class AfterExploring : std::uint8_t {
  report,  ///< It stays if its holder is heard, else it drives to where the holder was heard last.
  home,    ///< It drives back to where it started.
  wait,    ///< It stays.
};
/// Parses `report`, `home` or `wait`; anything else is `report`, the default.
constexpr AfterExploring after_exploring(std::string_view word) {
  return word == "home"   ? AfterExploring::home
         : word == "wait" ? AfterExploring::wait
                          : AfterExploring::report;
}

/// What an operator asks for with `explore`.
struct ExploreRequest {
  AfterExploring after{AfterExploring::report};
  double limit{std::numeric_limits<double>::infinity()};  ///< Time for exploring, s.
  std::string area{};                                     ///< What is to be explored; empty: everything.
};

/// A question to the router's explorer: where to drive next.
struct NextPlaceQuery {
  bool blocked{};      ///< The place of the last answer cannot be reached.
  bool begins{};       ///< The exploration begins: nothing counts as unreachable any more.
  std::string area{};  ///< As in ExploreRequest.
};

/// States of an exploration, in the order of their numbers in BehaviourState.
enum class ExplorationState : std::uint8_t {
  none,        ///< The robot did not explore yet, or was taken from it.
  starting,    ///< There was no goal yet.
  exploring,   ///< On the way to a place nearby.
  travelling,  ///< On the way to a place farther than ExploreMode::kFar.
  reporting,   ///< Nothing is left to explore: on the way home or to where the holder is heard.
  done,        ///< Everything that can be reached was seen.
  ended,       ///< It ended before that.
};
std::string_view name(ExplorationState state);

/// An exploration as it is reported.
struct ExplorationView {
  ExplorationState state{ExplorationState::none};
  Reason reason{Reason::none};  ///< Why it ended.
  float volume{};               ///< Volume that was seen, m3.
  float share{};                ///< Share of that volume in itself and what is expected to be left, [0, 1].
  std::uint16_t open{};         ///< Frontiers to which a route leads.
  std::uint16_t unreachable{};  ///< Frontiers to which none leads.
  bool operator==(const ExplorationView&) const = default;
};

}  // namespace adit::agent
