// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Cameras of robots as a station reports them to its front ends.
namespace adit::station {

/// A camera of a robot, and what of its live pictures arrives at this station.
struct CameraStatus {
  std::string name{};
  bool on{};                        ///< Someone at this station looks at it.
  bool kept_on{};                   ///< By `camera R on`, whether or not a front end shows it.
  std::uint32_t width{}, height{};  ///< Of the newest picture, pixels; 0: none came since it is on.
  double age{};                     ///< Of the newest picture, from its exposure, s.
  float rate{};                     ///< Pictures/s over the last seconds.
  float bytes{};                    ///< Bytes/s over the last seconds, without headers of the network.
  bool operator==(const CameraStatus&) const = default;
};

/// A live picture on its way to a front end.
struct CameraPicture {
  std::string robot{}, camera{};
  std::uint64_t number{};            ///< Rises with each picture of this station; 0: none.
  std::vector<std::uint8_t> jpeg{};  ///< Whole; stripes that never came are grey.
  std::uint32_t width{}, height{};   ///< Pixels.
  bool colour{};
  std::uint32_t span{};                 ///< Of a stripe, see perception::PictureFormat.
  std::vector<std::uint8_t> missing{};  ///< Bit i of byte b: stripe 8 b + i is not of this picture.
  std::vector<std::uint8_t> absent{};   ///< The same for stripes that never came in this size.
  double age{};                         ///< From the exposure, s, when it was sent to the front end.
  std::vector<float> pose{};  ///< Of the camera, x y z and quaternion x y z w, map frame; empty: unknown.
};

/// What a front end asks for: the next picture of a camera after a number.
struct CameraRequest {
  std::string robot{}, camera{};
  std::uint16_t width{640};  ///< Largest width that it shows, pixels.
  float rate{15.0F};         ///< Most pictures/s that it shows.
  std::uint64_t after{};     ///< Number of the picture that it has; 0: none.
};

/// The names of the cameras among a robot's sensors.
std::vector<std::string> cameras_of(const std::vector<std::string>& sensors);

}  // namespace adit::station
