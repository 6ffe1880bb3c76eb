// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace adit::agent {

/// Finds the level of the ground around a robot that is stationary, in the returns of one lidar.
class GroundFit {
 public:
  /// The plane z = height + rise . (x, y), base_link.
  struct Plane {
    double height{};             ///< At base_link, m.
    Eigen::Vector2d rise{0, 0};  ///< Per metre ahead and to the left.
  };

  /// A return in base_link, m. Only those 0.8 to 5 m away are used, at most kCapacity.
  void add(const Eigen::Vector3f& point);
  /// The plane with the most returns near it; nothing when there are too few.
  std::optional<Plane> plane() const;

 private:
  static constexpr std::size_t kCapacity = 10'000;
  std::vector<Eigen::Vector3f> points_{};
};

}  // namespace adit::agent
