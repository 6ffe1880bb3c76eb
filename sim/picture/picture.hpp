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
  std::string label{};         ///< in the legend, e.g. its platform and what it drove
  std::vector<Pose2> poses{};  ///< world, in order of time; the body is drawn at the last one
  double length{0.6};          ///< footprint, m
  double width{0.5};
};

/// A place that a robot was sent to.
struct PictureGoal {
  std::string robot{};
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< world, m
};

/// Something that happened, numbered on the map and told in the legend.
struct PictureEvent {
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< world, m
  std::string text{};                                 ///< one line
};

/// What is drawn on the world. Colours follow the order of the trails; at most 40 events are shown.
struct PictureSpec {
  std::string title{};
  std::string subtitle{};
  std::vector<PictureTrail> trails{};
  std::vector<PictureGoal> goals{};
  std::vector<PictureEvent> events{};
  double headroom{0.5};  ///< what is open at this height above the floor is drawn as free, m, (0, 5]
  int width{1800};       ///< of the image, pixels, [400, 8000]; its height follows
};

/// Draws the world from above, cropped to what is known of it, and writes a PNG.
/// Reason::cannot_write names the file, Reason::bad_argument a value out of range.
Result<void> write_picture(const World& world, const PictureSpec& spec, const std::filesystem::path& file);

}  // namespace adit::sim
