// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/world.hpp"

namespace adit::gui {

/// Something that the operator can do beside a value.
struct DetailAction {
  std::string label{}, line{};
  bool hold{};  ///< Press and hold.
  bool operator==(const DetailAction&) const = default;
};

/// A value of the selected robots.
struct Detail {
  std::string label{};
  std::string value{};
  bool differs{};  ///< The robots have different values, which are all in `value`.
  DetailAction action{};
  bool operator==(const Detail&) const = default;
};

/// Everything that the station knows of the selected robots, or of all of them together if none is selected.
/// `silent`: time since the station's last snapshot, s.
std::vector<Detail> details_of(const station::World& world, const std::vector<std::string>& selection,
                               double silent);

}  // namespace adit::gui
