#pragma once
#include <string>

#include "core/config/node.hpp"
#include "core/config/sensors.hpp"
#include "core/result/result.hpp"

namespace adit::config {

/// Reads the value of `sensors:`. What is missing of a lidar is taken from `usual`. The sensors of what does
/// not fly
/// (`flies` false) are above the ground. Errors are noted in the node's document.
Sensors read_sensors(const Node& sensors, const LidarConfig& usual, bool flies);

/// Reads a file that holds the `sensors:` part of a platform's file, with or without that outer key.
/// Errors: of the file, with the line; missing_key when it names no lidar.
Result<Sensors> load_sensors_file(const std::string& path);

}  // namespace adit::config
