// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <utility>

#include "basestation/gui/bridge/map_follow.hpp"

namespace adit::gui {

/// The view of a map before a robot was driven by hand, to which it returns. `View`: its camera.
template <class View>
class BeforeDrive {
 public:
  struct State {
    bool fitting{};
    View camera{};
  };
  /// Driving began. The stick may go from one robot to another: the first view stays.
  void begin(bool fitting, const View& camera) {
    if (!state_) state_ = {fitting, camera};
  }
  /// Driving ended. Nothing: there is no such view, or the operator moved the map meanwhile.
  std::optional<State> end(const MapFollow& follow) {
    const auto state = std::exchange(state_, {});
    return follow.followed_to_the_end() ? state : std::nullopt;
  }

 private:
  std::optional<State> state_{};
};

}  // namespace adit::gui
