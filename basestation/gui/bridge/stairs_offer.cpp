// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/stairs_offer.hpp"

#include <algorithm>

namespace adit::gui {

StairsOffer stairs_offer(const station::StairsItem* picked, const std::vector<std::string>& selected,
                         const std::vector<std::string>& ready, const std::string& refusal) {
  if (picked == nullptr) return {{}, "Tap a staircase to send a robot over it."};
  const std::string id = std::to_string(picked->number);
  if (picked->verdict == station::Verdict::rejected) return {{}, "staircase " + id + " is rejected"};
  if (selected.size() != 1) return {{}, "Select one robot to send it over staircase " + id + "."};
  const std::string& robot = selected.front();
  const auto climber = std::ranges::find(picked->fleet, robot, &station::Climber::robot);
  if (climber == picked->fleet.end()) return {{}, robot + " has not said what it climbs"};
  if (!climber->may) return {{}, robot + " " + climber->reason};
  if (ready.empty()) return {{}, refusal};
  return {robot, robot + " over staircase " + id};
}

}  // namespace adit::gui
