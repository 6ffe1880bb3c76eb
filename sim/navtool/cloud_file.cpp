// SPDX-License-Identifier: Apache-2.0
#include "sim/navtool/cloud_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <sstream>

#include "sim/navtool/pcd.hpp"

namespace adit::sim {
namespace {

constexpr std::uintmax_t kMaxPoints = 10'000'000;
constexpr std::size_t kPointBytes = 16;

static_assert(std::endian::native == std::endian::little, "KITTI's files are little-endian");

Result<PointCloud> read_kitti(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return {Reason::cannot_read, file.string() + ": cannot be read"};
  if (size % kPointBytes != 0)
    return {Reason::syntax,
            fmt::format("{}: {} bytes are not a whole number of points", file.string(), size)};
  if (size / kPointBytes > kMaxPoints)
    return {Reason::not_supported, fmt::format("{}: more than {} points", file.string(), kMaxPoints)};
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    return {Reason::cannot_read, file.string() + ": cannot be read"};
  PointCloud points(size / kPointBytes);
  for (std::size_t n = 0; n < points.size(); ++n)
    std::memcpy(points[n].data(), bytes.data() + n * kPointBytes, 3 * sizeof(float));
  return points;
}

}  // namespace

Result<PointCloud> read_cloud(const std::filesystem::path& file) {
  if (file.extension() == ".bin") return read_kitti(file);
  if (file.extension() != ".pcd")
    return {Reason::not_supported, file.string() + ": expected a .pcd or a .bin file"};
  auto cloud = read_pcd(file);
  if (!cloud) return cloud.error();
  return std::move(cloud->points);
}

Result<std::vector<std::filesystem::path>> cloud_files(const std::filesystem::path& place) {
  std::error_code error;
  if (std::filesystem::is_regular_file(place, error)) return std::vector<std::filesystem::path>{place};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(place, error)) {
    const auto extension = entry.path().extension();
    if ((extension == ".pcd" || extension == ".bin") && entry.is_regular_file(error))
      files.push_back(entry.path());
  }
  if (files.empty()) return {Reason::cannot_read, place.string() + ": no .pcd or .bin files there"};
  std::sort(files.begin(), files.end());
  return files;
}

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
    const bool whole = !words.fail() && (words >> std::ws).eof();
    if (!whole || !std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }) ||
        q.norm() < 0.5 || q.norm() > 2.0)
      return {Reason::syntax, fmt::format("{}:{}: expected stamp x y z qx qy qz qw", file.string(), number)};
    poses.push_back({v[0], {{v[1], v[2], v[3]}, q.normalized()}});
  }
  return poses;
}

}  // namespace adit::sim
