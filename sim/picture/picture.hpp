// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// Where a robot went.
struct PictureTrail {
  std::string id{};
  std::string label{};         ///< Text in the legend, e.g. its platform and distance.
  std::vector<Pose2> poses{};  ///< World, by time; the body is drawn at the last one.
  double length{0.6};          ///< Length of the footprint, m.
  double width{0.5};
};

/// The path of a person.
struct PicturePerson {
  std::vector<Pose2> poses{};  ///< World frame, by time; the body is drawn at the last one.
  double size{0.45};           ///< Diameter of the body, m.
};

/// A place that a robot was sent to.
struct PictureGoal {
  std::string robot{};
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< World frame, m.
};

/// An event, numbered on the map and described in the legend.
struct PictureEvent {
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< World frame, m.
  std::string text{};                                 ///< One line.
};

/// What is drawn on the world. Colours follow the order of the trails; at most 40 events are shown.
struct PictureSpec {
  std::string title{};
  std::string subtitle{};
  std::vector<PictureTrail> trails{};
  std::vector<PicturePerson> people{};  ///< Drawn in grey, with one line for all in the legend.
  std::vector<PictureGoal> goals{};
  std::vector<PictureEvent> events{};
  double headroom{0.5};  ///< Open space at this height above the floor is drawn as free, m, (0, 5].
  int width{1800};       ///< Width of the image, pixels, [400, 8000]; its height follows.
};

/// Draws the world from above, cropped to what is known of it, and writes a PNG.
/// Reason::cannot_write names the file, Reason::bad_argument a value out of range.
Result<void> write_picture(const World& world, const PictureSpec& spec, const std::filesystem::path& file);

}  // namespace adit::sim
