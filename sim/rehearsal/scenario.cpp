// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/scenario.hpp"

#include <algorithm>

namespace adit::sim {

const RobotSpec* Scenario::robot(const std::string& id) const {
  const auto it = std::find_if(robots.begin(), robots.end(), [&](const RobotSpec& r) { return r.id == id; });
  return it == robots.end() ? nullptr : &*it;
}

const StationSpec* Scenario::station(const std::string& id) const {
  const auto it =
      std::find_if(stations.begin(), stations.end(), [&](const StationSpec& s) { return s.id == id; });
  return it == stations.end() ? nullptr : &*it;
}

bool Scenario::explores() const {
  const auto judged = [](const Expectation& e) {
    return std::holds_alternative<ExploredExpectation>(e.what) ||
           std::holds_alternative<RepeatExpectation>(e.what);
  };
  return std::any_of(expectations.begin(), expectations.end(), judged);
}

bool Scenario::judges_maps() const {
  return std::any_of(expectations.begin(), expectations.end(),
                     [](const Expectation& e) { return std::holds_alternative<MapExpectation>(e.what); });
}

}  // namespace adit::sim
