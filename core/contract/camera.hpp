// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/contract/common.hpp"

namespace adit::radio {
class CameraPiece;
class CameraViews;
}  // namespace adit::radio

namespace adit::contract {

/// What stands before the name of a camera in Capabilities::sensors.
inline constexpr std::string_view kCameraSensor = "camera:";

/// A piece of a picture of a robot's camera; `data` is that of perception/camera.
struct CameraPiece {
  static constexpr std::size_t kMaxBytes = 1200;  ///< Of `data`.

  std::string robot{}, camera{};
  std::vector<std::uint8_t> data{};
  bool operator==(const CameraPiece&) const = default;
};

radio::CameraPiece encode(const CameraPiece& piece);
/// Returns nothing if a name is not valid.
std::optional<CameraPiece> decode(const radio::CameraPiece& sample);

/// A camera that the operators of a station look at, and what arrived of its pictures.
struct CameraView {
  static constexpr std::uint16_t kMaxWidth = 1920;
  static constexpr float kMaxRate = 30.0F;
  static constexpr std::size_t kMaxMissing = 64;

  std::string robot{}, camera{};
  std::uint16_t width{};                ///< Largest width that is wanted, pixels; 0: no live picture is.
  float rate{};                         ///< Largest rate that is wanted, 1/s, [0, kMaxRate].
  std::uint32_t shot{};                 ///< Number of a single good picture that is wanted; 0: none is.
  std::uint32_t run{};                  ///< Of the robot's pictures; 0: nothing arrived.
  std::uint32_t frame{};                ///< The newest picture of which a piece arrived.
  std::uint32_t arrived{};              ///< Pieces of this run that arrived.
  std::vector<std::uint8_t> missing{};  ///< Bit i of byte b: stripe 8 b + i of `frame` is not there.
  bool operator==(const CameraView&) const = default;
};

/// What the operators of a station look at.
struct CameraViews {
  static constexpr std::size_t kMaxViews = 16;

  std::string station{};
  Id station_id{};
  std::vector<CameraView> views{};
  bool operator==(const CameraViews&) const = default;
};

radio::CameraViews encode(const CameraViews& views);
/// Returns nothing if the station has no valid name. Views with an invalid name or rate are left out.
std::optional<CameraViews> decode(const radio::CameraViews& sample);

}  // namespace adit::contract
