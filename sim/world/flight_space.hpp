// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "sim/world/rectangle.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// What a flying body meets: the world's solid cells between its underside and its top.
class FlightSpace {
 public:
  explicit FlightSpace(std::shared_ptr<const World> world) : world_(std::move(world)) {}

  /// Whether the body with that footprint, from `low` to `high` (m, world), touches anything solid.
  bool touches(const Rectangle& footprint, double low, double high) const;
  /// Distance in the plane from its footprint to the nearest thing at its height, m; `most` or more: `most`.
  double clearance(const Rectangle& footprint, double low, double high, double max_distance) const;
  /// Height of the lowest underside above `from` anywhere over the footprint, m; infinite: none.
  double ceiling(const Rectangle& footprint, double from) const;

 private:
  bool solid(int i, int j, double low, double high) const;
  template <class Use>
  void each_column(const Rectangle& footprint, double reach, const Use& use) const;

  std::shared_ptr<const World> world_;
};

}  // namespace adit::sim
