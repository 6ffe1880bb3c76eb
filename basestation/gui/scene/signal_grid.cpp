// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/signal_grid.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {

SignalGrid::Step SignalGrid::Cell::step() const {
  if (signal) return *signal >= kGood ? Step::good : *signal >= kBad ? Step::weak : Step::bad;
  return lost <= kGoodLoss ? Step::good : lost <= kBadLoss ? Step::weak : Step::bad;
}

void SignalGrid::add(const station::World& world, const station::NetworkReport& report) {
  for (const station::LinkReport& link : report.links) {
    const station::Robot* robot = world.robot(link.agent);
    if (!robot || !robot->located || robot->lost || !(link.age < kSilent)) continue;
    add(Point{robot->x, robot->y}, {.signal = link.signal, .lost = link.lost_from});
  }
}

void SignalGrid::add(const Point& place, const Cell& measured) {
  if (!drawable(place.x, place.y)) return;
  Cell value = measured;
  if (value.signal && !std::isfinite(*value.signal)) value.signal.reset();
  if (!(value.lost >= 0.0 && value.lost <= 1.0)) {
    if (!value.signal) return;
    value.lost = 0.0;
  }
  const std::pair key{static_cast<int>(std::floor(place.x / kCell)),
                      static_cast<int>(std::floor(place.y / kCell))};
  knows_signal_ = knows_signal_ || value.signal.has_value();
  const auto [known, is_new] = cells_.try_emplace(key, value);
  if (!is_new) {
    Cell& cell = known->second;
    if (value.signal) cell.signal = std::min(cell.signal.value_or(*value.signal), *value.signal);
    cell.lost = std::max(cell.lost, value.lost);
    return;
  }
  order_.push_back(key);
  if (order_.size() <= kMaxCells) return;
  cells_.erase(order_.front());
  order_.pop_front();
}

}  // namespace adit::gui
