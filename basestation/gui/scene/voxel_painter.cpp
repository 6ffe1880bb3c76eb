// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/voxel_painter.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/gui/scene/mark_list.hpp"

namespace adit::gui {
namespace {

constexpr double kCover = 1.45;     // Width of a square in edges of a voxel: diagonal rows leave no gaps.
constexpr float kSidesFrom = 3.5F;  // Voxels that are larger, pixels, are drawn side by side.
constexpr std::array kShades{0.72, 0.52, 1.0};  // Brightness of sides across x, y and z.

/// The corners of the side across each axis at 0, in edges, around it.
constexpr std::array<std::array<std::array<float, 3>, 4>, 3> kSquares{
    {{{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}},
     {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}},
     {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}};

std::array<float, 3> floats(const Point3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

}  // namespace

double grid_step(const OrbitCamera& camera) {
  return bar_length(camera.focal() / camera.distance, VoxelPainter::kGridPixels);
}

void VoxelPainter::draw_brick(const VoxelScene::Brick& brick, int level, double edge) {
  using Axes = std::array<float, kAxes>;
  const auto axes = camera_.axes();
  const Axes right = floats(axes[0]), down = floats(axes[1]), ahead = floats(axes[2]);
  const Axes corner = floats(Point3{brick.x, brick.y, 0.0} - camera_.eye());
  const auto e = static_cast<float>(edge), focal = static_cast<float>(camera_.focal());
  const float middle_x = static_cast<float>(camera_.width / 2),
              middle_y = static_cast<float>(camera_.height / 2);
  const auto along = [](const Axes& a, const Axes& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const int lowest = static_cast<int>(std::ceil(std::clamp(slice_.low / edge - 0.5, -40000.0, 40000.0)));
  const int highest = static_cast<int>(std::floor(std::clamp(slice_.high / edge - 0.5, -40000.0, 40000.0)));
  const float per_metre = HeightColours::kColours / static_cast<float>(colours_.high() - colours_.low());
  const float first_shade = (0.5F * e - static_cast<float>(colours_.low())) * per_metre;
  for (const VoxelScene::Voxel& voxel : brick.levels[static_cast<std::size_t>(level)]) {
    if (voxel.z < lowest || voxel.z > highest) continue;
    unsigned sides = voxel.sides;
    if (voxel.z == lowest) sides |= VoxelScene::bottom;  // The slice opens it.
    if (voxel.z == highest) sides |= VoxelScene::top;
    // From the eye to its low corner, and the plane of the side that faces the eye across each axis, m.
    const Axes low{corner[0] + static_cast<float>(voxel.x) * e, corner[1] + static_cast<float>(voxel.y) * e,
                   corner[2] + static_cast<float>(voxel.z) * e};
    Axes plane{};
    std::array<bool, kAxes> seen{};
    bool any = false;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const bool from_low = low[i] > 0.0F, from_high = low[i] + e < 0.0F;
      plane[i] = from_low ? low[i] : low[i] + e;
      seen[i] = (from_low && (sides & (1U << (2 * i)))) || (from_high && (sides & (2U << (2 * i))));
      any = any || seen[i];
    }
    if (!any) continue;
    const Axes centre{low[0] + e / 2, low[1] + e / 2, low[2] + e / 2};
    const float depth = along(centre, ahead);
    if (depth < static_cast<float>(OrbitCamera::kNear) + e) continue;
    const float inverse = 1.0F / depth, scale = focal * inverse;
    const float x = middle_x + along(centre, right) * scale, y = middle_y + along(centre, down) * scale;
    const float half = 0.5F * static_cast<float>(kCover) * e * scale;
    if (!(x + half >= 0 && y + half >= 0 && x - half < static_cast<float>(width()) &&
          y - half < static_cast<float>(height())))
      continue;
    ++drawn_;
    const int shade = static_cast<int>(first_shade + static_cast<float>(voxel.z) * e * per_metre);
    const auto colour = static_cast<std::size_t>(std::clamp(shade, 0, HeightColours::kColours - 1));
    if (e * scale < kSidesFrom) {
      // The largest side stands for the voxel.
      std::size_t widest = 0;
      for (std::size_t i = 1; i < kAxes; ++i)
        if (seen[i] && (!seen[widest] || std::abs(centre[i]) > std::abs(centre[widest]))) widest = i;
      const float reach = 1.5F * e * inverse * inverse;
      picture_.square(x, y, half, planes_[widest].times(1.0F / plane[widest]), inverse - reach,
                      inverse + reach, shades_[widest][colour]);
      continue;
    }
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!seen[i]) continue;
      std::array<std::array<float, 2>, 4> corners{};
      for (std::size_t k = 0; k < corners.size(); ++k) {
        Axes at{low[0] + kSquares[i][k][0] * e, low[1] + kSquares[i][k][1] * e,
                low[2] + kSquares[i][k][2] * e};
        at[i] = plane[i];
        const float to_screen = focal / along(at, ahead);
        corners[k] = {middle_x + along(at, right) * to_screen, middle_y + along(at, down) * to_screen};
      }
      picture_.quadrangle(corners, planes_[i].times(1.0F / plane[i]), shades_[i][colour]);
    }
  }
}

void VoxelPainter::draw_bricks(const VoxelScene& scene, Detail3 detail) {
  struct Seen {
    const VoxelScene::Brick* brick{};
    double nearest{};
  };
  std::vector<Seen> seen;
  const auto axes = camera_.axes();
  const Point3 eye = camera_.eye();
  const double side = VoxelScene::kSide * scene.edge();
  const double tan_y = std::tan(OrbitCamera::kHalfView),
               tan_x = tan_y * camera_.width / std::max(camera_.height, 1.0);
  for (const VoxelScene::Brick* brick : scene.bricks()) {
    if (brick->high <= slice_.low || brick->low >= slice_.high) continue;
    const Point3 centre =
        Point3{brick->x + side / 2, brick->y + side / 2, (brick->low + brick->high) / 2} - eye;
    const double radius = std::hypot(side / 2, side / 2, (brick->high - brick->low) / 2);
    const double ahead = dot(centre, axes[2]);
    if (ahead < -radius) continue;
    // Outside of the cone around the view: a little more than what is seen.
    if (std::abs(dot(centre, axes[0])) > std::max(ahead, 0.0) * tan_x + radius * std::hypot(1.0, tan_x))
      continue;
    if (std::abs(dot(centre, axes[1])) > std::max(ahead, 0.0) * tan_y + radius * std::hypot(1.0, tan_y))
      continue;
    seen.push_back({brick, std::max(ahead - radius, OrbitCamera::kNear)});
  }
  // What is near hides what is behind it, which then costs less.
  std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest
                                  : std::pair(a.brick->x, a.brick->y) < std::pair(b.brick->x, b.brick->y);
  });
  const double coarsest = detail == Detail3::fine ? 1.5 : 3.0;  // Pixels of a voxel.
  for (const Seen& next : seen) {
    int level = 0;
    double edge = scene.edge();
    while (level + 1 < VoxelScene::kLevels && 2 * edge * camera_.focal() / next.nearest <= coarsest) {
      ++level;
      edge *= 2;
    }
    draw_brick(*next.brick, level, edge);
  }
}

void VoxelPainter::draw_grid(const VoxelScene& scene, const Palette& palette) {
  constexpr double kMostLines = 200.0, kShare = 0.55;
  const double step = grid_step(camera_), z = std::max(scene.low().z, colours_.low());
  const auto down_to = [step](double v) { return std::floor(v / step - 1e-9) * step; };
  const auto up_to = [step](double v) { return std::ceil(v / step + 1e-9) * step; };
  const Point low{down_to(scene.low().x), down_to(scene.low().y)},
      high{up_to(scene.high().x), up_to(scene.high().y)};
  if ((high.x - low.x + high.y - low.y) / step > kMostLines) return;
  const Point3 ahead = camera_.axes()[2], eye = camera_.eye();
  const auto draw = [&](Point3 from, Point3 to) {
    // What is behind the camera is cut off.
    const double near = 2 * OrbitCamera::kNear, a = dot(from - eye, ahead), b = dot(to - eye, ahead);
    if (a < near && b < near) return;
    if (a < near) from = from + ((near - a) / (b - a)) * (to - from);
    if (b < near) to = from + ((near - a) / (b - a)) * (to - from);
    const auto one = camera_.project(from), two = camera_.project(to);
    if (one && two)
      picture_.line({one->at.x, one->at.y, 1.0 / one->depth}, {two->at.x, two->at.y, 1.0 / two->depth},
                    palette.edge, kShare);
  };
  for (double x = low.x; x < high.x + step / 2; x += step) draw({x, low.y, z}, {x, high.y, z});
  for (double y = low.y; y < high.y + step / 2; y += step) draw({low.x, y, z}, {high.x, y, z});
}

void VoxelPainter::paint(const VoxelScene& scene, const OrbitCamera& camera, const Slice& slice,
                         const Palette& palette, Detail3 detail) {
  camera_ = camera;
  slice_ = slice;
  picture_.clear(camera.width, camera.height, palette.ground);
  drawn_ = 0;
  colours_ = HeightColours(scene, slice);
  if (scene.empty()) return;
  for (std::size_t i = 0; i < HeightColours::kColours; ++i) {
    const Rgb plain = colours_.at(colours_.low() + (static_cast<double>(i) + 0.5) / HeightColours::kColours *
                                                       (colours_.high() - colours_.low()));
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      shades_[axis][i] = 0xFF000000U | mixed(0, plain, kShades[axis]);
  }
  // The line of sight through a pixel's centre, of depth 1 m: how far it goes along each axis.
  const auto axes = camera.axes();
  const auto focal = static_cast<float>(camera.focal());
  const auto right = floats(axes[0]), down = floats(axes[1]), ahead = floats(axes[2]);
  const float x = (0.5F - static_cast<float>(camera.width / 2)) / focal,
              y = (0.5F - static_cast<float>(camera.height / 2)) / focal;
  for (std::size_t i = 0; i < kAxes; ++i)
    planes_[i] = {ahead[i] + x * right[i] + y * down[i], right[i] / focal, down[i] / focal};
  draw_bricks(scene, detail);
  picture_.light();
  draw_grid(scene, palette);
}

std::optional<Point3> VoxelPainter::pick(double x, double y) const {
  constexpr int kReach = 3;  // A finger may also be beside it, pixels.
  std::optional<Point3> nearest;
  double best = 1e9;
  for (int row = static_cast<int>(y) - kReach; row <= static_cast<int>(y) + kReach; ++row)
    for (int column = static_cast<int>(x) - kReach; column <= static_cast<int>(x) + kReach; ++column) {
      if (row < 0 || column < 0 || row >= height() || column >= width()) continue;
      const float inverse = picture_.inverse_depth(column, row);
      const double away = std::hypot(column + 0.5 - x, row + 0.5 - y);
      if (inverse <= 0.0F || away >= best) continue;
      best = away;
      nearest = camera_.to_map(x, y, 1.0 / static_cast<double>(inverse));
    }
  return nearest;
}

}  // namespace adit::gui
