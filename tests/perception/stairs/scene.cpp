// SPDX-License-Identifier: Apache-2.0
#include "tests/perception/stairs/scene.hpp"

#include <cmath>

namespace adit::perception::scenes {
namespace {

constexpr double kRadians = M_PI / 180.0;

double gaussian(Random& random) {
  const double u = 1.0 - random.uniform(), v = random.uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
}

/// Boxes with what their rays need, computed once.
struct Turned {
  Eigen::Matrix3d R_box_world;
  Eigen::Vector3d centre, half;
  double passes;
  bool mirror;
};

std::vector<Turned> turned(const std::vector<Solid>& solids) {
  std::vector<Turned> out;
  for (const Solid& s : solids) {
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(s.yaw, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(s.pitch, Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix();
    out.push_back({R.transpose(), s.centre, s.half, s.passes, s.mirror});
  }
  return out;
}

/// `axis`: of the box, across the face that is hit.
double range(const Turned& box, const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, int* axis = nullptr) {
  const Eigen::Vector3d from = box.R_box_world * (eye - box.centre), along = box.R_box_world * ray;
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double step = std::abs(along[i]) < 1e-12 ? 1e-12 : along[i];
    double a = (-box.half[i] - from[i]) / step, b = (box.half[i] - from[i]) / step;
    if (a > b) std::swap(a, b);
    if (a > near && axis != nullptr) *axis = i;
    near = std::max(near, a);
    far = std::min(far, b);
  }
  return near <= far && near > 0.0 ? near : std::numeric_limits<double>::infinity();
}

/// Distance at which a beam ends, m; infinity: nowhere.
double ends(const std::vector<Turned>& solids, double floor, const Eigen::Vector3d& eye,
            const Eigen::Vector3d& ray, Random& random, bool mirrored = false) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  double hit = ray.z() < -1e-9 ? (floor - eye.z()) / ray.z() : nowhere;
  if (!(hit > 0.0)) hit = nowhere;
  const Turned* nearest = nullptr;
  for (const Turned& solid : solids) {
    if (mirrored && solid.mirror) continue;
    const double at = range(solid, eye, ray);
    if (at >= hit || (solid.passes > 0.0 && random.chance(solid.passes))) continue;
    hit = at;
    nearest = &solid;
  }
  if (nearest == nullptr || !nearest->mirror) return hit;
  int axis = 0;
  (void)range(*nearest, eye, ray, &axis);
  const Eigen::Vector3d normal = nearest->R_box_world.row(axis).transpose();
  const Eigen::Vector3d on = ray - 2.0 * ray.dot(normal) * normal;
  return hit + ends(solids, floor, eye + hit * ray, on, random, true);
}

Solid turned_box(double x, double y, double z0, double length, double width, double height, double yaw) {
  return {.centre = {x, y, z0 + height / 2}, .half = {length / 2, width / 2, height / 2}, .yaw = yaw};
}

/// A plane that rises by `slope` (rad) over `length`, from x = 0.
void add_ramp(Scene& scene, double slope, double length, double width, double lateral) {
  constexpr double thick = 0.2;
  const Eigen::Vector3d along(std::cos(slope), 0.0, std::sin(slope)),
      up(-std::sin(slope), 0.0, std::cos(slope));
  scene.solids.push_back(
      {.centre = along * (length / 2) - up * (thick / 2) + Eigen::Vector3d(0.0, lateral, 0.0),
       .half = {length / 2, width / 2, thick / 2},
       .pitch = -slope});
  const double top = length * std::sin(slope), end = length * std::cos(slope);
  add_box(scene, end, end + 3.0, lateral - width / 2, lateral + width / 2, 0.0, top);
}

/// What stands on steps: boxes, people, a pallet, stones.
void add_clutter(Scene& scene, const Staircase& stairs, Random& random) {
  const int things = 2 + static_cast<int>(random.below(4));
  for (int n = 0; n < things; ++n) {
    const int step = static_cast<int>(random.below(static_cast<std::uint64_t>(stairs.steps)));
    const double x = (step + 0.5) * stairs.run, z = (step + 1) * stairs.rise;
    const double y = random.uniform(-0.45, 0.45) * stairs.width, yaw = random.uniform(-0.6, 0.6);
    switch (random.below(4)) {
      case 0:
        scene.solids.push_back(turned_box(x, y, z, 0.3, 0.4, random.uniform(0.2, 0.4), yaw));
        break;
      case 1:
        scene.solids.push_back(turned_box(x, y, z, 0.3, 0.5, random.uniform(1.5, 1.9), yaw));
        break;
      case 2:  // Leans on the steps.
        scene.solids.push_back({.centre = {x, y, z + 0.1},
                                .half = {0.6, 0.2, 0.07},
                                .pitch = -std::atan2(stairs.rise, stairs.run)});
        break;
      default:
        for (int k = 0; k < 4; ++k) {
          const double edge = random.uniform(0.05, 0.15);
          scene.solids.push_back(turned_box(x + random.uniform(-0.3, 0.3), y + random.uniform(-0.3, 0.3),
                                            z - 0.05, edge, edge, edge + 0.05, yaw + k));
        }
    }
  }
}

/// Steps that turn, from the end of a straight flight: each is a box that later ones cover.
void add_winding(Scene& scene, const Staircase& stairs, Random& random) {
  const double turn = random.uniform(0.25, 0.5) * (random.chance(0.5) ? 1.0 : -1.0);
  Eigen::Vector2d at(stairs.steps * stairs.run, 0.0);
  double yaw = turn, height = stairs.steps * stairs.rise;
  for (int k = 0; k < 4; ++k, yaw += turn) {
    height += stairs.rise;
    const Eigen::Vector2d ahead(std::cos(yaw), std::sin(yaw));
    const Eigen::Vector2d middle = at + ahead * 0.75;
    scene.solids.push_back(turned_box(middle.x(), middle.y(), 0.0, 1.5, stairs.width, height, yaw));
    at += stairs.run * ahead;
  }
}

}  // namespace

void add_box(Scene& scene, double x0, double x1, double y0, double y1, double z0, double z1) {
  scene.solids.push_back({.centre = {(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2},
                          .half = {(x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2}});
}

Cloud sense(const Scene& scene, const Sensing& sensing, Random& random) {
  const std::vector<Turned> solids = turned(scene.solids);
  const Lidar& lidar = sensing.lidar;
  const Pose2 last = scene.start;
  const double axis = random.uniform(0.0, 2.0 * M_PI);
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(sensing.tilt, Eigen::Vector3d(std::cos(axis), std::sin(axis), 0.0))
          .toRotationMatrix();
  const Eigen::Matrix3d R_base_world =
      Eigen::AngleAxisd(-last.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d base(last.x, last.y, scene.ground);
  Cloud cloud;
  cloud.eye = (tilt * Eigen::Vector3d(0.0, 0.0, lidar.height)).cast<float>();
  for (int n = 0; n < sensing.sweeps; ++n) {
    const double back = 0.1 * sensing.speed * (sensing.sweeps - 1 - n);
    const Eigen::Vector3d eye(last.x - back * std::cos(last.yaw), last.y - back * std::sin(last.yaw),
                              scene.ground + lidar.height);
    // The body pitches and rolls as it walks: known to the odometry.
    const Eigen::Matrix3d gait =
        (Eigen::AngleAxisd(last.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(1.0 * kRadians * gaussian(random), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(1.0 * kRadians * gaussian(random), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    for (int column = 0; column < lidar.columns; ++column)
      for (int ring = 0; ring < lidar.rings; ++ring) {
        const double azimuth = 2.0 * M_PI * column / lidar.columns;
        const double elevation =
            kRadians * (lidar.lowest + (lidar.highest - lidar.lowest) * ring / std::max(1, lidar.rings - 1));
        const Eigen::Vector3d ray =
            gait * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double hit = ends(solids, scene.floor, eye, ray, random);
        if (!(hit >= lidar.min_range && hit <= lidar.max_range)) continue;
        const Eigen::Vector3d world = eye + ray * (hit + lidar.noise * gaussian(random));
        const Eigen::Vector3f point = (tilt * (R_base_world * (world - base))).cast<float>();
        cloud.points.push_back(point);
        if (n + 1 == sensing.sweeps) cloud.last.push_back(point);
      }
  }
  return cloud;
}

Staircase seen_from(const Scene& scene, const Staircase& stairs) {
  Staircase out = stairs;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(-scene.start.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  out.foot = R * (stairs.foot - Eigen::Vector3d(scene.start.x, scene.start.y, scene.ground));
  out.heading = wrap_angle(stairs.heading - scene.start.yaw);
  return out;
}

Scene staircase(Row row, Random& random) {
  Scene scene;
  const double rise = random.uniform(0.13, 0.21), run = random.uniform(0.23, 0.34);
  const double width = random.uniform(0.8, 2.0);
  const int steps = 4 + static_cast<int>(random.below(9));
  const double end = (steps - 1) * run, top = steps * rise;
  const double landing = row == Row::winding ? run : 4.0;
  for (int k = 0; k < steps; ++k) {
    const double low = row == Row::grating && k + 1 < steps ? (k + 1) * rise - 0.03 : 0.0;
    add_box(scene, k * run, k + 1 == steps ? end + landing : (k + 1) * run, -width / 2, width / 2, low,
            (k + 1) * rise);
    if (row == Row::grating && k + 1 < steps) scene.solids.back().passes = 0.5;
  }
  scene.truth = Staircase{
      .foot = {0.0, 0.0, rise / 2}, .heading = 0.0, .rise = rise, .run = run, .width = width, .steps = steps};
  const double lateral = random.uniform(-0.3, 0.3) * width;
  if (row == Row::down) {
    const double distance = random.uniform(0.3, 0.9);
    scene.start = {end + distance, lateral, wrap_angle(M_PI + random.uniform(-0.4, 0.4))};
    scene.ground = top;
    return scene;
  }
  const double distance = random.uniform(1.0, 3.0);
  scene.start = {-distance, lateral, random.uniform(-0.5, 0.5)};
  if (row == Row::clutter) add_clutter(scene, *scene.truth, random);
  if (row == Row::winding) add_winding(scene, *scene.truth, random);
  if (row == Row::half) add_box(scene, -0.6, -0.4, 0.0, 4.0, 0.0, 2.5);
  if (row == Row::door) {
    add_box(scene, -0.8, -0.7, 0.45, 5.0, 0.0, 2.6);
    add_box(scene, -0.8, -0.7, -5.0, -0.45, 0.0, 2.6);
    add_box(scene, -0.8, -0.7, -0.45, 0.45, 2.1, 2.6);
  }
  if (row == Row::mirror) {
    const double side = (width / 2 + random.uniform(0.05, 0.5)) * (random.chance(0.5) ? 1.0 : -1.0);
    add_box(scene, -4.0, end + 2.0, std::min(side, side + std::copysign(0.02, side)),
            std::max(side, side + std::copysign(0.02, side)), 0.0, 3.0);
    scene.solids.back().mirror = true;
  }
  if (row != Row::walled) return scene;
  const double begin = -random.uniform(0.0, 4.0), high = top + 2.6;
  add_box(scene, begin, end + 4.0, -width / 2 - 0.2, -width / 2, 0.0, high);
  add_box(scene, begin, end + 4.0, width / 2, width / 2 + 0.2, 0.0, high);
  add_box(scene, end + 3.8, end + 4.0, -width / 2, width / 2, 0.0, high);
  add_box(scene, begin - 3.0, end + 4.0, -width / 2 - 3.0, width / 2 + 3.0, high, high + 0.2);
  return scene;
}

Scene not_stairs(std::size_t n, Random& random) {
  Scene scene;
  const std::string kind = kNotStairs[n % kNotStairs.size()];
  scene.start = {-random.uniform(1.0, 3.0), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
  const double width = random.uniform(0.8, 2.5);
  if (kind == "ramp") add_ramp(scene, random.uniform(0.15, 0.7), random.uniform(1.5, 4.0), width, 0.0);
  if (kind == "slope") add_ramp(scene, random.uniform(0.5, 1.0), random.uniform(1.5, 4.0), 8.0, 0.0);
  if (kind == "kerb") add_box(scene, 0.0, 5.0, -5.0, 5.0, 0.0, random.uniform(0.1, 0.3));
  if (kind == "two_kerbs") {
    const double rise = random.uniform(0.1, 0.25), run = random.uniform(0.25, 0.5);
    add_box(scene, 0.0, run, -5.0, 5.0, 0.0, rise);
    add_box(scene, run, 5.0, -5.0, 5.0, 0.0, 2 * rise);
  }
  if (kind == "shelf") {
    const double gap = random.uniform(0.2, 0.4), deep = random.uniform(0.25, 0.5);
    add_box(scene, deep, deep + 0.02, -width / 2, width / 2, 0.0, 6 * gap);
    for (int k = 0; k < 6; ++k) {
      // Boards that get deeper towards the floor are the worst kind.
      const double front = random.uniform(0.0, 0.1);
      add_box(scene, front, deep, -width / 2, width / 2, k * gap, k * gap + 0.03);
    }
  }
  if (kind == "pallets") {
    double x = 0.0, height = 0.0;
    for (int k = 0; k < 4; ++k) {
      height += random.uniform(0.1, 0.3);
      const double y = random.uniform(-0.3, 0.3), yaw = random.uniform(-0.3, 0.3);
      scene.solids.push_back(turned_box(x + 0.6, y, 0.0, 1.2, 0.8, height, yaw));
      x += random.uniform(0.1, 0.7);
    }
  }
  if (kind == "stripes") {  // Steps of an escalator that lie flat, and grooves in a ramp.
    add_ramp(scene, random.uniform(0.3, 0.6), 3.0, width, 0.0);
    const double slope = -scene.solids.front().pitch;
    for (int k = 0; k < 10; ++k) {
      const double s = 0.3 * k + 0.15;
      scene.solids.push_back({.centre = {s * std::cos(slope), 0.0, s * std::sin(slope)},
                              .half = {0.05, width / 2, 0.02},
                              .pitch = -slope});
    }
  }
  if (kind == "rubble")
    for (int k = 0; k < 60; ++k) {
      const double high = random.uniform(0.05, 0.5), near = std::abs(random.uniform(-1.0, 1.0));
      scene.solids.push_back(turned_box(3.0 * near, random.uniform(-2.0, 2.0), 0.0, random.uniform(0.15, 0.7),
                                        random.uniform(0.15, 0.7), high + 0.5 * near,
                                        random.uniform(-1.5, 1.5)));
      scene.solids.back().pitch = random.uniform(-0.4, 0.4);
    }
  if (kind == "person")
    for (int k = 0; k < 4; ++k)
      scene.solids.push_back(turned_box(random.uniform(-0.5, 1.5), random.uniform(-1.5, 1.5), 0.0, 0.3, 0.5,
                                        random.uniform(1.2, 1.9), random.uniform(-1.5, 1.5)));
  if (kind == "table") {
    add_box(scene, 0.0, 1.2, -0.6, 0.6, 0.7, 0.74);
    add_box(scene, -0.5, 0.0, -0.25, 0.25, 0.4, 0.45);
    add_box(scene, 0.0, 0.05, -0.25, 0.25, 0.45, 0.95);
  }
  if (kind == "room") {
    add_box(scene, 2.0, 2.2, -4.0, 4.0, 0.0, 2.6);
    add_box(scene, -4.0, 2.0, 2.0, 2.2, 0.0, 2.6);
    add_box(scene, -4.0, 2.0, -2.2, -2.0, 0.0, 2.6);
    double x = -1.0;
    for (int k = 0; k < 3; ++k, x += 0.8)
      add_box(scene, x, x + random.uniform(0.3, 0.8), 1.0 + random.uniform(0.0, 0.5), 2.0, 0.0,
              random.uniform(0.3, 1.0));
  }
  return scene;
}

}  // namespace adit::perception::scenes
