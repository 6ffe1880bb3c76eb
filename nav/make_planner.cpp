#include "nav/make_planner.hpp"

#include "nav/vfh_planner.hpp"

namespace adit::nav {

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names{"trajectories", "vfh"};
  return names;
}

Error no_planner(const std::string& name) {
  std::string all;
  for (const std::string& each : planner_names()) all += (all.empty() ? "" : " or ") + each;
  return {Reason::bad_argument, "no planner '" + name + "': " + all};
}

Result<std::unique_ptr<Planner>> make_planner(const Platform& platform, const LocalPlannerParams& params,
                                              std::shared_ptr<const PlannerLibrary> library) {
  if (platform.planner == "trajectories")
    return std::unique_ptr<Planner>(std::make_unique<LocalPlanner>(platform, params, std::move(library)));
  if (platform.planner == "vfh") return std::unique_ptr<Planner>(std::make_unique<VfhPlanner>(platform));
  return no_planner(platform.planner);
}

}  // namespace adit::nav
