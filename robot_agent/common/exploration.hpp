// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

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

}  // namespace adit::agent
