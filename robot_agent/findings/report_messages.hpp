// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/result/result.hpp"
#include "core/store/disk.hpp"
#include "robot_agent/findings/detection.hpp"

namespace visualization_msgs::msg {
class Marker;
}

namespace adit::agent {

/// What a program on the robot reports: a finding with a text, and perhaps with a photo.
struct Report {
  Detection object{};     ///< Its kind, text, place, frame and stamp.
  std::uint64_t id{};     ///< Of the finding: the same for the same namespace and number.
  bool withdraws{false};  ///< Takes the finding back.
  std::shared_ptr<const store::Bytes> jpeg{};  ///< As it came, unchecked; null: none.
  std::optional<Error> no_photo{};             ///< Why the message's photo cannot be used.
};

/// Reads a report. Errors: malformed (no namespace, no place, an unknown action), frame_unknown.
Result<Report> report_of(const visualization_msgs::msg::Marker& message);

/// The id of the finding that a program reports with that namespace and number.
std::uint64_t report_id(const std::string& ns, std::int32_t number);

}  // namespace adit::agent
