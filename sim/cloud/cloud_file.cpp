// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/cloud_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>

#include "sim/cloud/pcl_file.hpp"

namespace adit::sim {
namespace {

constexpr std::size_t kPointBytes = 16;

static_assert(std::endian::native == std::endian::little, "KITTI's files are little-endian");

Result<CloudFile> read_kitti(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return {Reason::cannot_read, file.string() + ": cannot be read"};
  if (size % kPointBytes != 0)
    return {Reason::syntax,
            fmt::format("{}: {} bytes are not a whole number of points", file.string(), size)};
  if (size / kPointBytes > kMaxCloudPoints)
    return {Reason::not_supported, fmt::format("{}: more than {} points", file.string(), kMaxCloudPoints)};
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    return {Reason::cannot_read, file.string() + ": cannot be read"};
  CloudFile out;
  out.sweep.points.resize(size / kPointBytes);
  for (std::size_t n = 0; n < out.sweep.points.size(); ++n) {
    std::array<float, 4> v{};
    std::memcpy(v.data(), bytes.data() + n * kPointBytes, kPointBytes);
    out.sweep.points[n] = {{v[0], v[1], v[2]}, 0.0f, v[3], 0};
  }
  return out;
}

bool is_cloud(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  return extension == ".pcd" || extension == ".ply" || extension == ".bin";
}

}  // namespace

Result<CloudFile> read_cloud_file(const std::filesystem::path& file, double period) {
  if (file.extension() == ".bin") return read_kitti(file);
  if (!is_cloud(file)) return {Reason::not_supported, file.string() + ": expected a .pcd, .ply or .bin file"};
  return read_with_pcl(file, period);
}

Result<PointCloud> read_cloud(const std::filesystem::path& file) {
  const Result<CloudFile> cloud = read_cloud_file(file);
  if (!cloud) return cloud.error();
  return points_of(cloud->sweep);
}

PointCloud points_of(const perception::Sweep& sweep) {
  PointCloud out;
  out.reserve(sweep.points.size());
  for (const perception::TimedPoint& p : sweep.points) out.push_back(p.position);
  return out;
}

Result<std::vector<std::filesystem::path>> cloud_files(const std::filesystem::path& place) {
  std::error_code error;
  if (std::filesystem::is_regular_file(place, error)) return std::vector<std::filesystem::path>{place};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(place, error))
    if (is_cloud(entry.path()) && entry.is_regular_file(error)) files.push_back(entry.path());
  if (files.empty()) return {Reason::cannot_read, place.string() + ": no .pcd, .ply or .bin files there"};
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace adit::sim
