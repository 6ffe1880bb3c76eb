// SPDX-License-Identifier: Apache-2.0
#include "core/wire/memory/disturbance.hpp"

#include <algorithm>

namespace adit::wire {
namespace {

bool names(const std::vector<std::string>& list, const std::string& machine) {
  return list.empty() || std::find(list.begin(), list.end(), machine) != list.end();
}

/// Index of the machine's group, or -1.
int group_of(const Disturbance& d, const std::string& machine) {
  for (std::size_t i = 0; i < d.groups.size(); ++i) {
    if (std::find(d.groups[i].begin(), d.groups[i].end(), machine) != d.groups[i].end())
      return static_cast<int>(i);
  }
  return -1;
}

bool concerns(const Disturbance& d, const std::string& from, const std::string& to) {
  if (!d.groups.empty()) {
    const int a = group_of(d, from), b = group_of(d, to);
    return a >= 0 && b >= 0 && a != b;
  }
  return (names(d.from, from) && names(d.to, to)) || (d.both_ways && names(d.to, from) && names(d.from, to));
}

double either(double a, double b) { return 1.0 - (1.0 - a) * (1.0 - b); }

}  // namespace

DisturbanceId Disturbances::add(Disturbance disturbance) {
  const DisturbanceId id = next_++;
  on_.emplace(id, std::move(disturbance));
  return id;
}

Disturbances::Effect Disturbances::on(const std::string& from, const std::string& to) const {
  Effect effect;
  for (const auto& [id, d] : on_) {
    if (!concerns(d, from, to)) continue;
    effect.cut |= d.cut;
    if (d.loss) effect.loss = std::max(effect.loss.value_or(0.0), *d.loss);
    effect.delay += d.delay;
    effect.reorder = either(effect.reorder, d.reorder);
    if (d.reorder > 0.0) effect.reorder_by = std::max(effect.reorder_by, d.reorder_by);
    effect.duplicate = either(effect.duplicate, d.duplicate);
    effect.slower *= std::max(1.0, d.slower);
  }
  return effect;
}

}  // namespace adit::wire
