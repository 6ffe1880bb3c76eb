// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::sim {

/// A line of a TUM file.
struct StampedPose {
  double stamp_s{};
  Pose3 pose{};
};

/// The poses of a TUM file: `stamp x y z qx qy qz qw`, one a line, # begins a comment. Errors name file and
/// line: Reason::cannot_read, syntax.
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& file);

/// One line with its end: stamps in ns, positions in um.
std::string tum_line(const StampedPose& pose);

/// Reason::cannot_write, with the file's name.
Result<void> write_tum(const std::filesystem::path& file, std::span<const StampedPose> poses);

}  // namespace adit::sim
