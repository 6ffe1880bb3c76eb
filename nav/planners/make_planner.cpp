// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/make_planner.hpp"

#include <algorithm>

#include "nav/planners/combined_planner.hpp"
#include "nav/planners/vfh/vfh_planner.hpp"

namespace adit::nav {

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names{"trajectories", "vfh", "lattice"};
  return names;
}

Error no_planner(const std::string& name) {
  std::string all;
  for (const std::string& each : planner_names()) all += (all.empty() ? "" : " or ") + each;
  return {Reason::bad_argument, "no planner '" + name + "': " + all};
}

Result<void> fits(const Platform& platform) {
  if (std::ranges::find(planner_names(), platform.planner) == planner_names().end())
    return no_planner(platform.planner);
  if (!platform.turns_on_spot() && platform.planner != "lattice")
    return {Reason::bad_argument,
            "planner '" + platform.planner + "' turns on the spot, which a car cannot: lattice does without"};
  return {};
}

Result<std::unique_ptr<Planner>> make_planner(const Platform& platform,
                                              std::shared_ptr<const PlannerLibrary> library) {
  if (const auto checked = fits(platform); !checked) return checked.error();
  if (platform.planner == "trajectories" && platform.router != "none")
    return std::unique_ptr<Planner>(std::make_unique<CombinedPlanner>(platform, std::move(library)));
  if (platform.planner == "trajectories")
    return std::unique_ptr<Planner>(std::make_unique<FalcoPlanner>(platform, std::move(library)));
  if (platform.planner == "vfh") return std::unique_ptr<Planner>(std::make_unique<VfhPlanner>(platform));
  return std::unique_ptr<Planner>(std::make_unique<HybridAStarPlanner>(platform));
}

}  // namespace adit::nav
