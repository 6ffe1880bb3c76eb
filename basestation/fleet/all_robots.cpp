// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/all_robots.hpp"

namespace adit::station {

using command::AllRobots;

Result<command::Request> with_robots_named(command::Request request, const Fleet& fleet) {
  const AllRobots all = request.info->arguments[0].all;
  for (const auto& [name, robot] : fleet.robots())
    if (all == AllRobots::heard || (all == AllRobots::held && robot.mine) ||
        (all == AllRobots::unheld && robot.owned && robot.holder.empty() && !robot.lost))
      request.robots.push_back(name);
  if (!request.robots.empty()) return request;
  if (all == AllRobots::held) return {Reason::not_holder, "you hold no robot"};
  return {Reason::unknown_robot,
          fleet.robots().empty() ? "no robot has been heard"
                                 : "every robot has a holder; to take one from another operator, name it"};
}

}  // namespace adit::station
