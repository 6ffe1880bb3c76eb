// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config/node.hpp"
#include "core/config/sensors.hpp"
#include "core/result/result.hpp"

namespace adit::config {

/// Reads the value of `sensors:`. Keys of a lidar that are missing have the values of `usual`. Sensors of a
/// robot that does not fly (`flies` false) must be above the ground. Errors are recorded in the node's
/// document.
Sensors read_sensors(const Node& sensors, const LidarConfig& usual, bool flies);

/// Reads `camera:`, a mapping or a list of mappings, at most Sensors::kMaxCameras. `usual`: the mounting of a
/// camera that does not say its own, key by key; nothing: x, y and z are required.
std::vector<CameraConfig> read_cameras(const Node& cameras, bool flies,
                                       const std::optional<Mounting>& usual = std::nullopt);

/// Reads a file with the `sensors:` part of a platform's file, with or without that outer key. Errors: those
/// of the file, with the line; missing_key when it names no lidar.
Result<Sensors> load_sensors_file(const std::string& path);

}  // namespace adit::config
