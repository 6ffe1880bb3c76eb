// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/pcl_file.hpp"

#include <fmt/format.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>

#include "perception/input/point_layout.hpp"
#include "sim/cloud/pcd_header.hpp"

namespace adit::sim {
namespace {

constexpr int kLongestPlyHeader = 200;  // lines

/// Checks what the header of a .ply promises before the library believes it.
Result<void> check_ply(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) return {Reason::cannot_read, file.string() + ": cannot be read"};
  const auto wrong = [&](int line, const std::string& what) {
    return Error{Reason::syntax, fmt::format("{}:{}: {}", file.string(), line, what)};
  };
  std::string line;
  for (int number = 1; number <= kLongestPlyHeader && std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1 && line != "ply") return wrong(1, "a .ply file begins with the line ply");
    if (line == "end_header") return {};
    if (!line.starts_with("element ")) continue;
    const std::string_view digits = std::string_view(line).substr(line.rfind(' ') + 1);
    std::uint64_t count = 0;
    const auto [end, bad] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
    if (bad != std::errc{} || end != digits.data() + digits.size()) return wrong(number, "expected a count");
    if (count > kMaxCloudPoints)
      return Error{Reason::not_supported,
                   fmt::format("{}: more than {} points", file.string(), kMaxCloudPoints)};
    if (count > size) return wrong(number, "the elements do not fit into the file");
  }
  return wrong(1, "the header has no end");
}

std::size_t size_of(std::uint8_t datatype) {
  switch (datatype) {
    case pcl::PCLPointField::INT8:
    case pcl::PCLPointField::UINT8:
      return 1;
    case pcl::PCLPointField::INT16:
    case pcl::PCLPointField::UINT16:
      return 2;
    case pcl::PCLPointField::FLOAT64:
      return 8;
    default:
      return 4;
  }
}

/// PointLayout reads places of 4 byte floats.
Result<void> narrow(pcl::PCLPointCloud2& cloud, const std::string& name) {
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  if (cloud.data.size() < count * cloud.point_step)
    return Error{Reason::syntax, name + ": there is less data than points"};
  for (pcl::PCLPointField& field : cloud.fields) {
    if (field.offset + size_of(field.datatype) > cloud.point_step)
      return Error{Reason::syntax, name + ": field " + field.name + " lies outside of the point"};
    const bool place = field.name == "x" || field.name == "y" || field.name == "z";
    if (!place || field.datatype != pcl::PCLPointField::FLOAT64) continue;
    field.datatype = pcl::PCLPointField::FLOAT32;
    for (std::size_t n = 0; n < count; ++n) {
      std::uint8_t* at = cloud.data.data() + n * cloud.point_step + field.offset;
      double wide = 0.0;
      std::memcpy(&wide, at, sizeof wide);
      const auto value = static_cast<float>(wide);
      std::memcpy(at, &value, sizeof value);
    }
  }
  return {};
}

Result<perception::Sweep> sweep_of(pcl::PCLPointCloud2& cloud, const std::string& name, double period) {
  if (const Result<void> good = narrow(cloud, name); !good) return good.error();
  std::vector<perception::PointField> fields;
  for (const pcl::PCLPointField& field : cloud.fields)
    fields.push_back({field.name, field.offset, field.datatype});
  const auto layout = perception::PointLayout::of(fields, cloud.point_step);
  if (!layout) return Error{Reason::syntax, name + ": " + layout.error().text};
  auto sweep = layout->unpack(cloud.data, std::uint64_t{cloud.width} * cloud.height, 0, period);
  if (!sweep) return Error{sweep.error().reason, name + ": " + sweep.error().text};
  return sweep;
}

}  // namespace

Result<CloudFile> read_with_pcl(const std::filesystem::path& file, double period) {
  const bool pcd = file.extension() == ".pcd";
  if (const Result<void> good = pcd ? check_pcd(file) : check_ply(file); !good) return good.error();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // Errors are ours to report.
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  // The library throws what its parsers throw.
  try {
    int version = 0;
    const int read = pcd ? pcl::PCDReader().read(file.string(), cloud, origin, orientation, version)
                         : pcl::PLYReader().read(file.string(), cloud, origin, orientation, version);
    if (read < 0) return {Reason::syntax, file.string() + ": the Point Cloud Library cannot read it"};
    auto sweep = sweep_of(cloud, file.string(), period);
    if (!sweep) return sweep.error();
    CloudFile out{std::move(*sweep), {}};
    const Eigen::Quaterniond q = orientation.cast<double>();
    if (pcd && origin.allFinite() && q.norm() > 0.5)
      out.viewpoint = {origin.head<3>().cast<double>(), q.normalized()};
    return out;
  } catch (const std::exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    return {Reason::syntax, fmt::format("{}: {}", file.string(), what)};
  }
}

}  // namespace adit::sim
