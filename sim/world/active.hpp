// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

namespace adit::sim {

/// Begins or ends one of several faults of a kind, which overlap freely: the end of one leaves the others as
/// they are. `active`: in the order in which they began.
template <class Fault>
void change_active(std::vector<Fault>& active, const Fault& fault, bool begins) {
  if (begins) return active.push_back(fault);
  const auto found = std::find(active.begin(), active.end(), fault);
  if (found != active.end()) active.erase(found);
}

}  // namespace adit::sim
