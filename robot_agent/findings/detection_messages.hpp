// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "robot_agent/findings/detection.hpp"

namespace vision_msgs::msg {
class Detection3DArray;
}

namespace adit::agent {

inline constexpr std::size_t kMaxObjects = 256;      ///< In one message.
inline constexpr std::size_t kMaxHypotheses = 128;   ///< Of one object.
inline constexpr std::size_t kMaxNameBytes = 256;    ///< Of a class, an id or a frame.
inline constexpr double kFarthestObject = 1000.0;    ///< From the origin of a frame of the robot, m.
inline constexpr double kFarthestInMap = 1'000'000;  ///< From the origin of `odom` or `map`, m.

/// The objects of a message, each in the class of its best hypothesis. Its place is the hypothesis's pose, or
/// the centre of the bounding box if that pose is at the origin.
///
/// @param refuse  Called with the reason for each object that cannot be used; the others are returned.
/// Errors: out_of_range for more than kMaxObjects; then nothing of the message is used.
Result<std::vector<Detection>> detections_of(const vision_msgs::msg::Detection3DArray& message,
                                             const std::string& source, const DetectionParams& params,
                                             const std::function<void(const Error&)>& refuse);

/// Whether an object's place is a number, and not too far from the origin of its frame. `name`: of the
/// object, for the error, which is malformed.
Result<void> check_place(const Detection& object, const std::string& name);

/// A text of a stranger for operators: printable, at most 40 bytes.
std::string shown(const std::string& text);

}  // namespace adit::agent
