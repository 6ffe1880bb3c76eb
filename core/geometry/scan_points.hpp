// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <span>

namespace adit {

/// The points of a scan that one lidar measured; see ScanPoints.
struct ScanPart {
  Eigen::Vector3d origin{0, 0, 0};  ///< Where the rays begin: the lidar at the scan's instant, base_link, m.
  std::size_t count{};              ///< Of the scan's points, in their order.
};

/// A scan as maps and monitors read it: points in base_link, m, and where the rays to them began. Rays of a
/// second lidar do not begin at the first one: along a line that was not measured anything may stand. A view;
/// it owns nothing.
class ScanPoints {
 public:
  /// `parts`: together all points, the first lidar's first. Empty: the platform's first lidar measured all.
  template <std::convertible_to<std::span<const Eigen::Vector3f>> Points>
  ScanPoints(const Points& all, std::span<const ScanPart> parts = {}) : all_(all), parts_(parts) {}

  std::span<const Eigen::Vector3f> all() const { return all_; }
  /// Those of the first lidar. What needs one viewpoint uses their rays, and takes the others as points.
  std::span<const Eigen::Vector3f> first() const {
    return parts_.empty() ? all_ : all_.first(parts_.front().count);
  }
  /// Where the first lidar's rays begin; `usual`: by the platform.
  Eigen::Vector3d origin(const Eigen::Vector3d& usual) const {
    return parts_.empty() ? usual : parts_.front().origin;
  }
  /// Calls `use(points, origin)` for each lidar.
  template <class Use>
  void each_part(const Eigen::Vector3d& usual, Use&& use) const {
    if (parts_.empty()) return use(all_, usual);
    std::size_t begin = 0;
    for (const ScanPart& part : parts_) {
      use(all_.subspan(begin, part.count), part.origin);
      begin += part.count;
    }
  }

 private:
  std::span<const Eigen::Vector3f> all_;
  std::span<const ScanPart> parts_;
};

}  // namespace adit
