// SPDX-License-Identifier: Apache-2.0
#include "sim/world/camera.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/box_target.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

constexpr double kLampReach = 8.0;  // m: half the light of the lamp arrives there
constexpr float kAmbient = 0.12f;   // share of the light that comes from elsewhere
constexpr float kGrazing = 0.5f;    // light on a surface that is parallel to the view
constexpr float kOutline = 0.55f;   // brightness of the outline of what is before something else
constexpr double kDepthJump = 0.3;  // m, with a tenth of the distance: where such an outline is
constexpr float kExposure = 1.25f;  // of 1: the brightness of a white surface at the lamp

/// What a ray met: nothing, a plane across an axis of the world, or a body.
struct Hit {
  enum class What : std::uint8_t { nothing, surface, body };
  What what{What::nothing};
  SurfaceSide side{};
  bool outline{};
  std::uint16_t body{};
  double depth{};  ///< Along the optical axis, m.
  double plane{};  ///< The coordinate that all points of the plane share, m.
};

int axis_of(SurfaceSide side) {
  return side == SurfaceSide::wall_x ? 0 : side == SurfaceSide::wall_y ? 1 : 2;
}

/// Renders one picture: first a ray for each `step` x `step` pixels, then the colour of each pixel.
class Rendering {
 public:
  explicit Rendering(const PictureJob& job)
      : job_(job),
        step_(job.width * job.height > PictureJob::kMaxRays ? 2 : 1),
        columns_((job.width + step_ - 1) / step_),
        rows_((job.height + step_ - 1) / step_),
        focal_(0.5 * job.width / std::tan(0.5 * job.field_of_view)),
        rotation_(job.T_world_camera.orientation.toRotationMatrix()),
        origin_(job.T_world_camera.position),
        hits_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (const VisibleBody& body : job.bodies) targets_.push_back(make_target(body.box, origin_));
  }

  CameraImage run() {
    cast();
    find_outlines();
    return draw();
  }

 private:
  Hit& hit(int column, int row) {
    return hits_[static_cast<std::size_t>(column) * static_cast<std::size_t>(rows_) +
                 static_cast<std::size_t>(row)];
  }
  /// The way of a ray (world) for which the depth grows by 1; of a place in the picture, pixels.
  Eigen::Vector3d way(double x, double y) const {
    return rotation_.col(0) + rotation_.col(1) * ((0.5 * job_.width - x) / focal_) +
           rotation_.col(2) * ((0.5 * job_.height - y) / focal_);
  }

  void cast() {
    const auto rows = static_cast<std::size_t>(rows_);
    const VoxelGrid::Start start = job_.world->grid().locate(origin_);
    std::vector<Eigen::Vector3d> directions(rows);
    std::vector<double> ranges(rows), lengths(rows);
    for (int column = 0; column < columns_; ++column) {
      for (int row = 0; row < rows_; ++row) {
        const auto at = static_cast<std::size_t>(row);
        const Eigen::Vector3d ray = way((column + 0.5) * step_, (row + 0.5) * step_);
        lengths[at] = ray.norm();
        directions[at] = ray / lengths[at];
      }
      job_.world->grid().cast(start, directions, PictureJob::kMaxRange, ranges);
      for (int row = 0; row < rows_; ++row) {
        const auto at = static_cast<std::size_t>(row);
        hit(column, row) = met(directions[at], ranges[at], lengths[at]);
      }
    }
  }

  Hit met(const Eigen::Vector3d& direction, double range, double length) const {
    Hit out;
    for (std::size_t n = 0; n < targets_.size(); ++n) {
      const double box = cast_box(targets_[n], direction);
      if (!(box < range) || box > PictureJob::kMaxRange) continue;
      range = box;
      out.what = Hit::What::body;
      out.body = static_cast<std::uint16_t>(n);
    }
    if (!(range > 0.0) || range > PictureJob::kMaxRange) return {};  // Inside something solid, or far.
    out.depth = range / length;
    if (out.what != Hit::What::body) meet_surface(origin_ + range * direction, direction.z(), out);
    return out;
  }

  /// Cells have sides in the planes of the grid: the point is in one of them.
  void meet_surface(const Eigen::Vector3d& point, double up, Hit& out) const {
    constexpr double kExact = 1e-6;  // Columns.
    const VoxelGrid& grid = job_.world->grid();
    const auto off = [&](int axis) {
      const double at = (point[axis] - grid.origin()[axis]) / grid.resolution();
      return std::abs(at - std::round(at));
    };
    out.what = Hit::What::surface;
    out.side = off(0) < kExact   ? SurfaceSide::wall_x
               : off(1) < kExact ? SurfaceSide::wall_y
               : up < 0.0        ? SurfaceSide::floor
                                 : SurfaceSide::ceiling;
    out.plane = point[axis_of(out.side)];
  }

  /// Outlines show the edge of what is before a surface of the same colour.
  void find_outlines() {
    const auto apart = [](const Hit& a, const Hit& b) {
      if (a.what == Hit::What::nothing || b.what == Hit::What::nothing) return false;
      return a.depth < b.depth - kDepthJump - 0.1 * b.depth;
    };
    for (int column = 1; column + 1 < columns_; ++column)
      for (int row = 1; row + 1 < rows_; ++row) {
        Hit& own = hit(column, row);
        own.outline = apart(own, hit(column - 1, row)) || apart(own, hit(column + 1, row)) ||
                      apart(own, hit(column, row - 1)) || apart(own, hit(column, row + 1));
      }
  }

  CameraImage draw() {
    CameraImage out{job_.width, job_.height, {}};
    out.rgb.resize(3 * static_cast<std::size_t>(job_.width) * static_cast<std::size_t>(job_.height));
    std::uint8_t* pixel = out.rgb.data();
    Random random(job_.seed);
    for (int y = 0; y < job_.height; ++y)
      for (int x = 0; x < job_.width; ++x, pixel += 3) {
        const Hit& own = hit(x / step_, y / step_);
        const SurfaceColour light =
            own.what == Hit::What::nothing ? SurfaceColour::Zero() : shade(own, way(x + 0.5, y + 0.5));
        const float grain = job_.grain > 0.0 ? static_cast<float>(job_.grain * gaussian(random)) : 0.0f;
        for (int n = 0; n < 3; ++n)
          pixel[n] = static_cast<std::uint8_t>(std::clamp(255.0f * light[n] + grain + 0.5f, 0.0f, 255.0f));
      }
    return out;
  }

  SurfaceColour shade(const Hit& own, const Eigen::Vector3d& ray) const {
    const double length = ray.norm();
    if (own.what == Hit::What::body) return shade_body(own, ray, length);
    const int axis = axis_of(own.side);
    // The ray of the pixel meets the same plane a little beside the one that was cast.
    double depth = (own.plane - origin_[axis]) / ray[axis];
    if (!(depth > 0.8 * own.depth && depth < 1.25 * own.depth)) depth = own.depth;
    const double facing = std::abs(ray[axis]) / length;
    const double footprint = depth / focal_ / std::max(facing, 0.2);
    return surface_colour(own.side, origin_ + depth * ray, static_cast<float>(footprint)) *
           lamp(own, depth * length, facing);
  }

  SurfaceColour shade_body(const Hit& own, const Eigen::Vector3d& ray, double length) const {
    const BoxTarget& target = targets_[own.body];
    const Eigen::Vector3d away = origin_ + own.depth * ray - target.centre;
    const Eigen::Vector3d at(target.axis.x() * away.x() + target.axis.y() * away.y(),
                             target.axis.x() * away.y() - target.axis.y() * away.x(), away.z());
    // The side on which the point is, relative to the size of the box.
    int side = 0;
    at.cwiseAbs().cwiseQuotient(target.half).maxCoeff(&side);
    const double ahead = target.axis.x() * ray.x() + target.axis.y() * ray.y();
    const double left = target.axis.x() * ray.y() - target.axis.y() * ray.x();
    const double facing = std::abs(side == 0 ? ahead : side == 1 ? left : ray.z()) / length;
    const auto height = static_cast<float>(0.5 + 0.5 * at.z() / target.half.z());
    return body_colour(job_.bodies[own.body].kind, height) * lamp(own, own.depth * length, facing);
  }

  /// Light that comes back from a white surface; `facing`: cosine of the angle of incidence.
  static float lamp(const Hit& own, double range, double facing) {
    const double reach = range / kLampReach;
    const auto near = static_cast<float>(1.0 / (1.0 + reach * reach));
    const float angle = kGrazing + (1.0f - kGrazing) * static_cast<float>(facing);
    return kExposure * (kAmbient + (1.0f - kAmbient) * near) * angle * (own.outline ? kOutline : 1.0f);
  }

  const PictureJob& job_;
  int step_, columns_, rows_;
  double focal_;  ///< Pixels.
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d origin_;
  std::vector<Hit> hits_;  ///< Column by column.
  std::vector<BoxTarget> targets_{};
};

}  // namespace

CameraImage PictureJob::render() const { return Rendering(*this).run(); }

}  // namespace adit::sim
