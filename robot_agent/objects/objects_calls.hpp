// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/component/call.hpp"
#include "core/findings/photo.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/team_robot.hpp"

/// The call between the command component and the component `objects`, which run on different strands.
namespace adit::agent {

/// A scan, with which objects in pictures are placed.
struct ObjectsJob {
  std::shared_ptr<const Scan> scan{};
  std::vector<TeamRobot> team{};  ///< Robots in view, which are no objects.
  std::uint32_t odom_epoch{};     ///< Of the scan's odometry frame.
  std::uint64_t stamp{};          ///< By the driver's clock, ns; 0: none.
  Time received{};                ///< When the message with that stamp came.
};

/// An object that was seen in a picture and placed.
struct SeenObject {
  std::string camera{}, kind{};
  double score{};                                  ///< [0, 1].
  Eigen::Vector3d position{0, 0, 0};               ///< Odometry frame, m.
  double sigma{};                                  ///< Standard deviation, m.
  std::shared_ptr<const findings::Photo> photo{};  ///< Of the object; null: none could be made.
};

/// The objects of one picture.
struct ObjectsStep {
  std::vector<SeenObject> objects{};
  std::uint32_t odom_epoch{};
  std::uint64_t picture{};  ///< Number of the picture; 0: none was searched since the last answer.
};
using ObjectsService = Service<std::shared_ptr<const ObjectsJob>, ObjectsStep>;

}  // namespace adit::agent
