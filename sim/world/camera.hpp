// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/pose.hpp"
#include "sim/world/lidar.hpp"
#include "sim/world/surface_colour.hpp"

namespace adit::sim {

/// A picture of a simulated camera.
struct CameraImage {
  int width{}, height{};            ///< Pixels.
  std::vector<std::uint8_t> rgb{};  ///< Row by row from the top left, three bytes a pixel.
};

/// A body that a camera sees.
struct VisibleBody {
  BodyKind kind{};
  BodyBox box{};
};

/// All that one picture of a camera depends on, by value: render() may run on another thread, later.
///
/// A pinhole camera without distortion: its optical axis is the x axis of its frame, z points up in the
/// picture. The scene is lit by a lamp on the camera: what is 8 m away has half the light of what is near.
/// Where there is nothing within kMaxRange the picture is black.
struct PictureJob {
  std::shared_ptr<const World> world{};
  Pose3 T_world_camera{};
  std::vector<VisibleBody> bodies{};
  double field_of_view{1.2};  ///< Horizontal, rad, (0, 3).
  int width{640}, height{480};
  double grain{2.0};  ///< Standard deviation of a pixel's noise, of 255, [0, 50].
  std::uint64_t seed{};

  static constexpr double kMaxRange = 80.0;  ///< m
  /// Pictures of more than this many pixels have one ray for 2 x 2 pixels; their surfaces are as sharp,
  /// their edges are not.
  static constexpr int kMaxRays = 320 * 240;
  CameraImage render() const;
};

}  // namespace adit::sim
