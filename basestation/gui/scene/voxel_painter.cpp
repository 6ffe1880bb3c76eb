// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/voxel_painter.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {
namespace {

constexpr float kFar = 1e9F;
constexpr int kColours = 256;
constexpr double kCover = 1.45;    // Width of a square in edges of a voxel: diagonal rows leave no gaps.
constexpr int kMaxSplat = 96;      // Pixels: a voxel that is nearer than half a metre.
constexpr float kLighting = 4.0F;  // Strength of the shading.
constexpr float kDarkest = 0.35F;  // No edge is darker than this share.

}  // namespace

void VoxelPainter::draw_brick(const VoxelScene::Brick& brick, int level, double edge) {
  const auto axes = camera_.axes();
  const Point3 eye = camera_.eye();
  const Point3 first = Point3{brick.x + edge / 2, brick.y + edge / 2, edge / 2} - eye;
  const float base_x = static_cast<float>(dot(first, axes[0])),
              base_y = static_cast<float>(dot(first, axes[1])),
              base_z = static_cast<float>(dot(first, axes[2]));
  const auto e = static_cast<float>(edge);
  const float xx = e * static_cast<float>(axes[0].x), xy = e * static_cast<float>(axes[0].y),
              xz = e * static_cast<float>(axes[0].z), yx = e * static_cast<float>(axes[1].x),
              yy = e * static_cast<float>(axes[1].y), yz = e * static_cast<float>(axes[1].z),
              zx = e * static_cast<float>(axes[2].x), zy = e * static_cast<float>(axes[2].y),
              zz = e * static_cast<float>(axes[2].z);
  const auto focal = static_cast<float>(camera_.focal());
  const float middle_x = static_cast<float>(width_) / 2, middle_y = static_cast<float>(height_) / 2;
  const int lowest = static_cast<int>(std::ceil(std::clamp(slice_.low / edge - 0.5, -40000.0, 40000.0)));
  const int highest = static_cast<int>(std::floor(std::clamp(slice_.high / edge - 0.5, -40000.0, 40000.0)));
  for (const VoxelScene::Voxel& voxel : brick.levels[static_cast<std::size_t>(level)]) {
    if (voxel.z < lowest || voxel.z > highest) continue;
    const float x = voxel.x, y = voxel.y, z = voxel.z;
    const float depth = base_z + x * zx + y * zy + z * zz;
    if (depth < static_cast<float>(OrbitCamera::kNear)) continue;
    const float scale = focal / depth;
    const float at_x = middle_x + (base_x + x * xx + y * xy + z * xz) * scale;
    const float at_y = middle_y + (base_y + x * yx + y * yy + z * yz) * scale;
    const float half = std::min(0.5F * static_cast<float>(kCover) * e * scale, kMaxSplat / 2.0F);
    if (!(at_x + half >= 0 && at_y + half >= 0 && at_x - half < static_cast<float>(width_) &&
          at_y - half < static_cast<float>(height_)))
      continue;
    const int left = std::max(0, static_cast<int>(at_x - half + 0.5F)),
              top = std::max(0, static_cast<int>(at_y - half + 0.5F));
    const int right = std::min(width_, std::max(left + 1, static_cast<int>(at_x + half + 0.5F))),
              bottom = std::min(height_, std::max(top + 1, static_cast<int>(at_y + half + 0.5F)));
    const int shade = static_cast<int>(((voxel.z + 0.5) * edge - lowest_) * per_metre_);
    const std::uint32_t colour = colours_[static_cast<std::size_t>(std::clamp(shade, 0, kColours - 1))];
    ++drawn_;
    for (int row = top; row < bottom; ++row) {
      const std::size_t line = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
      for (int column = left; column < right; ++column) {
        const std::size_t at = line + static_cast<std::size_t>(column);
        if (depth_[at] <= depth) continue;
        depth_[at] = depth;
        pixels_[at] = colour;
      }
    }
  }
}

/// Darkens what has something nearer beside it.
void VoxelPainter::light(Rgb ground) {
  const std::uint32_t empty = 0xFF000000U | ground;
  const auto width = static_cast<std::ptrdiff_t>(width_);
  for (int row = 0; row < height_; ++row)
    for (int column = 0; column < width_; ++column) {
      const std::ptrdiff_t at = row * width + column;
      const float depth = depth_[static_cast<std::size_t>(at)];
      std::uint32_t& pixel = pixels_[static_cast<std::size_t>(at)];
      if (depth == kFar) {
        pixel = empty;
        continue;
      }
      float nearer = 0.0F;
      const auto look = [&](std::ptrdiff_t other) {
        nearer += std::max(0.0F, depth - depth_[static_cast<std::size_t>(other)]);
      };
      if (column > 0) look(at - 1);
      if (column + 1 < width_) look(at + 1);
      if (row > 0) look(at - width);
      if (row + 1 < height_) look(at + width);
      const float share = std::max(kDarkest, 1.0F / (1.0F + kLighting * nearer / depth * 10.0F));
      if (share > 0.99F) continue;
      std::uint32_t out = 0xFF000000U;
      for (const int shift : {0, 8, 16})
        out |= static_cast<std::uint32_t>(static_cast<float>((pixel >> shift) & 0xFFU) * share) << shift;
      pixel = out;
    }
}

void VoxelPainter::paint(const VoxelScene& scene, const OrbitCamera& camera, const Slice& slice,
                         const Palette& palette, Detail3 detail) {
  camera_ = camera;
  slice_ = slice;
  width_ = static_cast<int>(std::clamp(std::ceil(camera.width), 1.0, double{kMaxSide}));
  height_ = static_cast<int>(std::clamp(std::ceil(camera.height), 1.0, double{kMaxSide}));
  const std::size_t size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  pixels_.assign(size, 0xFF000000U | palette.ground);
  depth_.assign(size, kFar);
  drawn_ = 0;
  if (scene.empty()) return;

  lowest_ = std::max(scene.low().z, slice.low);
  const double highest = std::min(scene.high().z, slice.high);
  per_metre_ = kColours / std::max(highest - lowest_, 0.5);
  colours_.resize(kColours);
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const double share = static_cast<double>(i) / (kColours - 1);
    colours_[i] = 0xFF000000U | (share < 0.5 ? mixed(palette.floor, palette.low, 2 * share)
                                             : mixed(palette.low, palette.high, 2 * share - 1));
  }

  struct Seen {
    const VoxelScene::Brick* brick{};
    double nearest{};
  };
  std::vector<Seen> seen;
  const auto axes = camera.axes();
  const Point3 eye = camera.eye();
  const double side = VoxelScene::kSide * scene.edge();
  const double tan_y = std::tan(OrbitCamera::kHalfView),
               tan_x = tan_y * camera.width / std::max(camera.height, 1.0);
  for (const VoxelScene::Brick* brick : scene.bricks()) {
    if (brick->high <= slice.low || brick->low >= slice.high) continue;
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
    while (level + 1 < VoxelScene::kLevels && 2 * edge * camera.focal() / next.nearest <= coarsest) {
      ++level;
      edge *= 2;
    }
    draw_brick(*next.brick, level, edge);
  }
  light(palette.ground);
}

std::optional<Point3> VoxelPainter::pick(double x, double y) const {
  constexpr int kReach = 3;  // A finger may also be beside it, pixels.
  std::optional<Point3> nearest;
  double best = 1e9;
  for (int row = static_cast<int>(y) - kReach; row <= static_cast<int>(y) + kReach; ++row)
    for (int column = static_cast<int>(x) - kReach; column <= static_cast<int>(x) + kReach; ++column) {
      if (row < 0 || column < 0 || row >= height_ || column >= width_) continue;
      const float depth = depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(column)];
      const double away = std::hypot(column + 0.5 - x, row + 0.5 - y);
      if (depth == kFar || away >= best) continue;
      best = away;
      nearest = camera_.to_map(x, y, depth);
    }
  return nearest;
}

}  // namespace adit::gui
