// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/detection_messages.hpp"

#include <cmath>
#include <optional>

#include "core/findings/finding.hpp"
#include "core/findings/stairs_data.hpp"
#include "perception/input/frame_tree.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace adit::agent {
namespace {

using vision_msgs::msg::Detection3D;
using vision_msgs::msg::ObjectHypothesisWithPose;

Eigen::Vector3d origin_of(const geometry_msgs::msg::Pose& pose) {
  return {pose.position().x(), pose.position().y(), pose.position().z()};
}

/// The hypothesis of the highest score. Errors: malformed.
Result<const ObjectHypothesisWithPose*> best_of(const Detection3D& object) {
  if (object.results().empty() || object.results().size() > kMaxHypotheses)
    return Error{Reason::malformed, "an object has " + std::to_string(object.results().size()) +
                                        " hypotheses, expected 1 to " + std::to_string(kMaxHypotheses)};
  const ObjectHypothesisWithPose* best = nullptr;
  for (const ObjectHypothesisWithPose& each : object.results()) {
    const double score = each.hypothesis().score();
    if (!(score >= 0.0 && score <= 1.0))
      return Error{Reason::malformed,
                   "an object's score " + std::to_string(score).substr(0, 12) + " is not in [0, 1]"};
    if (!best || score > best->hypothesis().score()) best = &each;
  }
  return best;
}

/// Nothing: the object is ignored.
Result<std::optional<Detection>> detection_of(const Detection3D& object, const std_msgs::msg::Header& all,
                                              const std::string& source, const DetectionParams& params) {
  const auto best = best_of(object);
  if (!best) return best.error();
  Detection out{.source = source, .id = object.id(), .score = (*best)->hypothesis().score()};
  if (out.score < params.min_score) return std::optional<Detection>{};
  const std::string& class_id = (*best)->hypothesis().class_id();
  if (class_id.empty()) return Error{Reason::malformed, "an object has no class_id"};
  if (class_id.size() > kMaxNameBytes || out.id.size() > kMaxNameBytes)
    return Error{Reason::malformed, "a class_id or id has more than " + std::to_string(kMaxNameBytes) +
                                        " bytes: '" + shown(class_id) + "'"};
  out.kind = kind_of(class_id);
  if (params.importance_of(out.kind) == 0) return std::optional<Detection>{};
  out.frame = object.header().frame_id().empty() ? all.frame_id() : object.header().frame_id();
  if (out.frame.empty() || out.frame.size() > kMaxNameBytes)
    return Error{Reason::frame_unknown, out.frame.empty()
                                            ? "an object has no frame_id, and neither has its message"
                                            : "a frame_id is too long: '" + shown(out.frame) + "'"};
  out.frame = perception::frame_name(out.frame);
  out.stamp = nanoseconds_of(object.header());
  if (out.stamp == 0) out.stamp = nanoseconds_of(all);
  out.position = origin_of((*best)->pose().pose());
  if (out.position.isZero(0.0)) out.position = origin_of(object.bbox().center());
  if (const auto good = check_place(out, class_id); !good) return good.error();
  if (out.position.isZero(0.0))
    return Error{
        Reason::malformed,
        "'" + shown(class_id) + "' has no place: the poses of the result and of bbox.center are 0 0 0"};
  return std::optional<Detection>(std::move(out));
}

}  // namespace

std::string kind_of(const std::string& class_id) {
  std::string kind = class_id.substr(0, findings::Finding::kKind);
  for (char& c : kind) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-' && c != '.') c = '_';
  }
  return kind == findings::kStairs ? "staircase" : kind;
}

Result<void> check_place(const Detection& object, const std::string& name) {
  const bool still = object.frame == "map" || object.frame == "odom";
  if (object.position.allFinite() && object.position.norm() <= (still ? kFarthestInMap : kFarthestObject))
    return {};
  return {Reason::malformed, "the place of '" + shown(name) + "' in '" + shown(object.frame) +
                                 "' is no number, or too far away"};
}

std::string shown(const std::string& text) {
  constexpr std::size_t kShown = 40;
  std::string out = text.substr(0, kShown);
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out + (text.size() > kShown ? "..." : "");
}

Result<std::vector<Detection>> detections_of(const vision_msgs::msg::Detection3DArray& message,
                                             const std::string& source, const DetectionParams& params,
                                             const std::function<void(const Error&)>& refuse) {
  if (message.detections().size() > kMaxObjects)
    return Error{Reason::out_of_range, "a message has " + std::to_string(message.detections().size()) +
                                           " objects, at most " + std::to_string(kMaxObjects) + " are read"};
  std::vector<Detection> out;
  for (const Detection3D& object : message.detections()) {
    auto detection = detection_of(object, message.header(), source, params);
    if (!detection)
      refuse(detection.error());
    else if (*detection)
      out.push_back(std::move(**detection));
  }
  return out;
}

}  // namespace adit::agent
