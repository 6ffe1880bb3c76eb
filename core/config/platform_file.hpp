// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/config/node.hpp"
#include "core/config/platform.hpp"
#include "core/result/result.hpp"

namespace adit::config {

/// Reads the lidars, the IMU and the cameras of `sensors:` into a platform, in place of those that it has;
/// nothing when the node is not present. Keys that are missing have the values of its first lidar.
void read_platform_sensors(const Node& sensors, Platform& platform);
/// Reads a platform's file, with every key of docs/configuration.md.
Result<Platform> load_platform_file(const std::string& path);
/// Loads the platform of that name (config/platforms/NAME.yaml on the search path), or the file when `name`
/// ends in .yaml. `referring_file`: the file that names it; its folder is searched first.
Result<Platform> load_platform(const std::string& name, const std::string& referring_file = "");

}  // namespace adit::config
