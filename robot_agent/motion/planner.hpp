#pragma once
#include <memory>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "nav/navigator.hpp"

namespace adit::agent {

/// A scan: points in the frame of base_link, m, and where base_link was.
struct Scan {
  PointCloud points{};
  Pose3 body{};  ///< odometry frame
};

/// One planning cycle: what to plan.
struct PlanJob {
  std::shared_ptr<Scan> scan{};
  nav::Target target{};        ///< kind none: the scan enters the map, nothing is planned
  bool last{true};             ///< `target` is the goal itself, no place on the way there
  Eigen::Vector2d goal{0, 0};  ///< where the goal was that `target` leads to, odometry frame, m
  Pose2 pose{};                ///< odometry frame
  std::uint32_t odom_epoch{};  ///< Of that frame; what was mapped in another one is forgotten.
  std::uint64_t generation{};  ///< of the goal, for whoever asked
  Time made{};
};
struct PlanAnswer {
  nav::Plan plan{};
  std::vector<Eigen::Vector2f> obstacles{};  ///< Not passable, odometry frame, m.
};
using PlanService = Service<std::shared_ptr<const PlanJob>, std::shared_ptr<const PlanAnswer>>;

struct PlannerParams {
  Platform platform{};
  Duration planning{20ms};  ///< what a cycle takes in rehearsal
  /// Makes the local planner; empty: the one that the platform names.
  nav::PlannerFactory local_planner{};
};

/// The planning work: terrain map and local planner, on a strand of its own, offered as a service. When it is
/// made anew its map is empty; the next scans fill it.
class Planner : public Component {
 public:
  /// `library`: from the planner before this one, so that it need not be made again; null: it is made here.
  Planner(PlannerParams params, Executor& strand, Log log, PlanService& service,
          std::shared_ptr<const nav::PlannerLibrary> library = nullptr);

 protected:
  Result<void> on_start() override;

 private:
  void plan(const std::shared_ptr<const PlanJob>& job, const Reply<std::shared_ptr<const PlanAnswer>>& reply);

  PlannerParams params_;
  PlanService& service_;
  struct Maps;
  std::shared_ptr<Maps> maps_;
};

}  // namespace adit::agent
