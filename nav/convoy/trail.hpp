// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

namespace adit::nav {

/// The path that the leader of a convoy drove: points at equal distances along it, with consecutive numbers.
/// The position of a robot on the path is a length along it, m; that of point `n` is n * kSpacing. The leader
/// records the path, and the other members receive pieces of it. Bounded: the oldest points are dropped.
class Trail {
 public:
  static constexpr double kSpacing = 0.5;        ///< Between two points, m.
  static constexpr std::size_t kCapacity = 800;  ///< Points, 400 m of path.

  /// The nearest point of the path to a place.
  struct Projection {
    double along{};   ///< m
    double offset{};  ///< Distance of the place from the path, m.
  };

  bool empty() const { return points_.empty(); }
  std::uint32_t first() const { return first_; }  ///< Number of the oldest point.
  std::uint32_t end() const { return first_ + static_cast<std::uint32_t>(points_.size()); }
  double start() const { return kSpacing * first_; }  ///< Position of the oldest point, m.
  /// Position of the newest point, m; the path must not be empty.
  double length() const { return kSpacing * (end() - 1); }
  const Eigen::Vector3d& point(std::uint32_t number) const { return points_[number - first_]; }

  /// Gives the first point of an empty path a number.
  void begin(std::uint32_t first) { first_ = first; }
  /// Extends the path to the leader's place. A leader that drives back along the path adds nothing.
  void record(const Eigen::Vector3d& place);
  /// The position of the leader, which falls when it drives back along its path.
  double leader_at(const Eigen::Vector3d& place) const;
  /// Adds received points; those that are known, or not adjacent to the known ones, are ignored. Returns
  /// false if the points are no path: their distances do not fit.
  bool add(std::uint32_t first, std::span<const Eigen::Vector3d> points);

  /// The place at a position, which is limited to the known path; the path must not be empty.
  Eigen::Vector3d at(double along) const;
  /// The nearest point between two positions; nothing if the path is empty there. A place before the
  /// beginning of the whole path has a negative position, its distance from there.
  std::optional<Projection> project(const Eigen::Vector3d& place, double from, double to) const;

 private:
  void trim();

  std::deque<Eigen::Vector3d> points_{};
  std::uint32_t first_{};
};

}  // namespace adit::nav
