// SPDX-License-Identifier: Apache-2.0
#include "perception/map/export/points_file.hpp"

#include <bit>
#include <cstring>
#include <ostream>
#include <string>
#include <vector>

namespace adit::perception {
namespace {

std::vector<Eigen::Vector3f> occupied_centres(const VoxelImage& image) {
  std::vector<Eigen::Vector3f> out;
  for (const VoxelIndex& v : image.occupied()) out.push_back(image.centre(v).cast<float>());
  return out;
}

std::string little_endian(std::span<const Eigen::Vector3f> points) {
  std::string out;
  out.reserve(points.size() * 12);
  for (const Eigen::Vector3f& p : points)
    for (const float value : p) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(bits >> 8 * i & 0xff));
    }
  return out;
}

Result<void> write_points(const std::string& header, std::span<const Eigen::Vector3f> points,
                          std::ostream& to) {
  if (points.empty()) return {Reason::map_empty, "there is no map yet"};
  const std::string data = little_endian(points);
  to << header;
  to.write(data.data(), static_cast<std::streamsize>(data.size()));
  if (!to) return {Reason::cannot_write, "the points cannot be written"};
  return {};
}

}  // namespace

Result<void> write_pcd(std::span<const Eigen::Vector3f> points, std::ostream& to) {
  const std::string count = std::to_string(points.size());
  return write_points(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT "
      "1 1 1\n"
      "WIDTH " +
          count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n",
      points, to);
}

Result<void> write_ply(std::span<const Eigen::Vector3f> points, std::ostream& to) {
  return write_points("ply\nformat binary_little_endian 1.0\nelement vertex " +
                          std::to_string(points.size()) +
                          "\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
                      points, to);
}

Result<void> write_pcd(const VoxelImage& image, std::ostream& to) {
  return write_pcd(occupied_centres(image), to);
}
Result<void> write_ply(const VoxelImage& image, std::ostream& to) {
  return write_ply(occupied_centres(image), to);
}

}  // namespace adit::perception
