// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/model/robot.hpp"

namespace adit::station {

/// What a robot does when its holder releases it.
struct AfterRelease {
  bool rests{};        ///< It is stationary, and stays so: nothing that its holder has to decide.
  std::string text{};  ///< Follows the robot's name: "drives on to its goal 4.0 5.0, without a holder".
};

/// Predicts that by the robot's last messages. A mode that this version does not know counts as one that
/// moves the robot, and so does a robot that has not said what it does.
AfterRelease after_release(const Robot& robot);

}  // namespace adit::station
