// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/tum_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

namespace adit::sim {

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) return {Reason::cannot_read, file.string() + ": cannot be read"};
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    if ((words >> std::ws).eof()) continue;
    std::array<double, 8> v{};
    for (double& value : v) words >> value;
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    const bool complete = !words.fail() && (words >> std::ws).eof();
    if (!complete || !std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }) ||
        q.norm() < 0.5 || q.norm() > 2.0)
      return {Reason::syntax, fmt::format("{}:{}: expected stamp x y z qx qy qz qw", file.string(), number)};
    poses.push_back({v[0], {{v[1], v[2], v[3]}, q.normalized()}});
  }
  return poses;
}

std::string tum_line(const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.pose.position;
  const Eigen::Quaterniond& q = pose.pose.orientation;
  return fmt::format("{:.9f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", pose.stamp_s, p.x(), p.y(),
                     p.z(), q.x(), q.y(), q.z(), q.w());
}

Result<void> write_tum(const std::filesystem::path& file, std::span<const StampedPose> poses) {
  std::ofstream stream(file);
  for (const StampedPose& pose : poses) stream << tum_line(pose);
  stream.flush();
  if (!stream) return {Reason::cannot_write, file.string() + ": cannot be written"};
  return {};
}

}  // namespace adit::sim
