// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav::test {

/// A wall, a crate, a beam: its extent in the world, m.
struct Box {
  double x0, x1, y0, y1, z0{0.0}, z1{2.5};
};

/// An analytic world for closed-loop tests: boxes on a flat floor under a ceiling, a spinning lidar by
/// slab tests, and the true collision of a footprint.
struct BoxWorld {
  std::vector<Box> boxes{};
  double ceiling{2.5};
  double lowest{-15};        ///< Elevation of the lidar's lowest ring, degrees.
  std::vector<Box> panes{};  ///< Of glass: they return only rays within 8 degrees of the normal of a face.
  std::vector<Box> water{};  ///< Still, on the floor: a mirror, where z0 and z1 do not matter.

  /// Distance along `direction` (unit length) to what returns the ray, m, behind a mirror as the lidar sees
  /// it; 100 when nothing does.
  double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    double nearest = 100.0;
    if (direction.z() < 0) nearest = std::min(nearest, -from.z() / direction.z());
    if (direction.z() > 0) nearest = std::min(nearest, (ceiling - from.z()) / direction.z());
    const Eigen::Vector3d inverse = direction.cwiseInverse();
    const auto meet = [&](const Box& b) {
      const Eigen::Vector3d low(b.x0, b.y0, b.z0), high(b.x1, b.y1, b.z1);
      const Eigen::Vector3d t0 = (low - from).cwiseProduct(inverse), t1 = (high - from).cwiseProduct(inverse);
      const double enter = t0.cwiseMin(t1).maxCoeff(), leave = t0.cwiseMax(t1).minCoeff();
      if (enter > 0 && enter <= leave) nearest = std::min(nearest, enter);
    };
    for (const Box& b : boxes) meet(b);
    const double normal = std::cos(8.0 * M_PI / 180.0);
    if (std::max(std::abs(direction.x()), std::abs(direction.y())) > normal)
      for (const Box& b : panes) meet(b);
    const Eigen::Vector3d at = from + nearest * direction;
    const auto has = [&](const Box& b) {
      return at.x() > b.x0 && at.x() < b.x1 && at.y() > b.y0 && at.y() < b.y1;
    };
    if (direction.z() < 0 && at.z() < 1e-6 && std::any_of(water.begin(), water.end(), has))
      nearest += cast({at.x(), at.y(), 0.0}, {direction.x(), direction.y(), -direction.z()});
    return std::min(nearest, 100.0);
  }

  /// A scan of `rings` x `columns` from a lidar at `height` above `body`: points in base_link.
  /// Rings spread from `lowest` to 15 degrees; one ring alone is level. `noise`: of the range, m (standard
  /// deviation).
  std::vector<Eigen::Vector3f> scan(const Pose2& body, double height, int rings, int columns, double noise,
                                    std::mt19937& random) const {
    return scan(body, Eigen::Vector3d(0, 0, height), rings, columns, noise, random);
  }
  /// The same from a lidar at `lidar`, base_link, m.
  std::vector<Eigen::Vector3f> scan(const Pose2& body, const Eigen::Vector3d& lidar, int rings, int columns,
                                    double noise, std::mt19937& random) const {
    std::normal_distribution<double> error(0.0, 1.0);
    std::vector<Eigen::Vector3f> points;
    points.reserve(static_cast<std::size_t>(rings * columns));
    const Eigen::Matrix3d R(Eigen::AngleAxisd(body.yaw, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d from = Eigen::Vector3d(body.x, body.y, 0) + R * lidar;
    std::vector<Eigen::Vector2d> elevations;  // cosine, sine
    for (int ring = 0; ring < rings; ++ring) {
      const double elevation =
          rings == 1 ? 0.0 : (lowest + (15.0 - lowest) * ring / (rings - 1)) * M_PI / 180.0;
      elevations.emplace_back(std::cos(elevation), std::sin(elevation));
    }
    for (int column = 0; column < columns; ++column) {
      const double bearing = 2 * M_PI * column / columns;
      const double cosine = std::cos(bearing), sine = std::sin(bearing);
      for (const Eigen::Vector2d& up : elevations) {
        const Eigen::Vector3d local(up.x() * cosine, up.x() * sine, up.y());
        const Eigen::Vector3d direction = R * local;
        const double range = cast(from, direction);
        if (range >= 100.0) continue;
        const Eigen::Vector3d point = local * (range + noise * error(random));
        points.push_back((point + lidar).cast<float>());
      }
    }
    return points;
  }

  /// From the footprint of a platform at `pose` to the nearest box that it cannot step on or pass under, m;
  /// zero or less when they touch. Boxes are sampled every 2 cm along their outline.
  double clearance(const Platform& platform, const Pose2& pose) const {
    double least = 10.0;
    const Pose2 inverse = pose.inverse();
    const auto look = [&](double x, double y) {
      const Eigen::Vector2d p = inverse * Eigen::Vector2d(x, y);
      const double ox = std::fabs(p.x()) - platform.length / 2, oy = std::fabs(p.y()) - platform.width / 2;
      const double outside = std::hypot(std::max(0.0, ox), std::max(0.0, oy));
      least = std::min(least, outside > 0 ? outside : std::max(ox, oy));
    };
    for (const Box& b : boxes) {
      if (b.z1 <= platform.step || b.z0 >= platform.height) continue;
      for (double x = b.x0; x < b.x1 + 0.02; x += 0.02) {
        look(std::min(x, b.x1), b.y0);
        look(std::min(x, b.x1), b.y1);
      }
      for (double y = b.y0; y < b.y1 + 0.02; y += 0.02) {
        look(b.x0, std::min(y, b.y1));
        look(b.x1, std::min(y, b.y1));
      }
    }
    return least;
  }
};

inline Platform wheeled() {
  return {.name = "wheeled",
          .length = 0.60,
          .width = 0.50,
          .max_speed = 2.0,
          .max_turn = 1.5,
          .max_acceleration = 1.5,
          .step = 0.08,
          .lidar_height = 0.50,
          .router = "graph"};
}
inline Platform tracked() {
  return {.name = "tracked",
          .drive = Drive::tracked,
          .length = 0.80,
          .width = 0.60,
          .max_speed = 1.0,
          .max_turn = 1.0,
          .max_acceleration = 1.0,
          .turn_slip = 0.15,
          .step = 0.15,
          .max_slope = 0.5,
          .lidar_height = 0.55,
          .router = "graph"};
}
inline Platform legged() {
  return {.name = "legged",
          .drive = Drive::holonomic,
          .length = 0.90,
          .width = 0.45,
          .max_speed = 1.2,
          .max_turn = 1.2,
          .max_acceleration = 1.5,
          .step = 0.22,
          .max_slope = 0.6,
          .lidar_height = 0.65,
          .stairs = true,
          .router = "graph"};
}

inline Platform car() {
  return {.name = "car",
          .drive = Drive::car,
          .length = 1.0,
          .width = 0.6,
          .height = 0.6,
          .max_speed = 2.0,
          .max_turn = 1.5,
          .max_acceleration = 1.5,
          .wheelbase = 0.65,
          .max_steering = 0.58,
          .steering_rate = 1.2,
          .step = 0.08,
          .lidar_height = 0.6,
          .planner = "lattice"};
}
inline Platform aerial() {
  return {.name = "aerial",
          .drive = Drive::aerial,
          .length = 0.6,
          .width = 0.6,
          .height = 0.3,
          .max_speed = 1.5,
          .max_turn = 1.5,
          .max_acceleration = 1.5,
          .step = 0.0,
          .lidar_height = 0.15};
}

}  // namespace adit::nav::test
