// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

#include "core/config/node.hpp"

namespace adit::agent {

/// Finds the keys of a platform's sensors, as "file:line", for reports that name the line to change.
class ConfigLines {
 public:
  /// Reads the platform's file of a robot's file. Errors: those of the files.
  static Result<ConfigLines> load(const std::string& robot_file);
  /// `platform`: root of a platform's file.
  explicit ConfigLines(const config::Node& platform) : root_(platform) {}

  /// The line of `key` of lidar `n`, or of the mapping that has no such key.
  std::string lidar(std::size_t n, const std::string& key) const;
  std::string imu(const std::string& key) const;

 private:
  config::Node root_;
};

}  // namespace adit::agent
