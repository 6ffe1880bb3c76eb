// SPDX-License-Identifier: Apache-2.0
#include "sim/world/surface_colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::sim {
namespace {

constexpr float kFloorTile = 0.5f, kCeilingPanel = 0.6f, kWallPanel = 1.0f;  // m
constexpr float kPaint = 2.0f;    // m: edge of the squares, seen from above, whose walls have one paint
constexpr float kOffset = 0.37f;  // m: of these squares, so that few walls are on a border of them
constexpr float kJoint = 0.015f;  // m: half the width of a joint between tiles or panels

/// The largest whole number that is not above `v`; faster than std::floor, for |v| < 2^31.
int whole(float v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero - (v < static_cast<float>(towards_zero) ? 1 : 0);
}

/// Mixes the bits of a number (lowbias32, C. Wellons).
std::uint32_t mix_bits(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

std::uint32_t cell_bits(int i, int j, std::uint32_t salt) {
  return mix_bits(static_cast<std::uint32_t>(i) * 0x9e3779b1U + static_cast<std::uint32_t>(j) * 0x85ebca77U +
                  salt);
}

/// In [0, 1).
float cell_value(int i, int j, std::uint32_t salt) {
  return static_cast<float>(cell_bits(i, j, salt) >> 8) * 0x1p-24f;
}

/// Value noise in [-1, 1): a value for each corner of square cells, between them smooth.
float value_noise(float u, float v, std::uint32_t salt) {
  const int i = whole(u), j = whole(v);
  float x = u - static_cast<float>(i), y = v - static_cast<float>(j);
  x *= x * (3.0f - 2.0f * x);
  y *= y * (3.0f - 2.0f * y);
  const float below = cell_value(i, j, salt) * (1.0f - x) + cell_value(i + 1, j, salt) * x;
  const float above = cell_value(i, j + 1, salt) * (1.0f - x) + cell_value(i + 1, j + 1, salt) * x;
  return 2.0f * (below * (1.0f - y) + above * y) - 1.0f;
}

/// How visible a detail of `size` metres is in pixels that see `footprint` metres, [0, 1].
float visibility(float size, float footprint) {
  return std::clamp(1.5f - 1.5f * footprint / size, 0.0f, 1.0f);
}

/// Brightness of a surface with a joint every `panel` metres along `u`: 1 beside the joint.
float joint(float u, float panel, float footprint) {
  const float at = u / panel;
  const float part = at - static_cast<float>(whole(at));
  const float distance = panel * std::min(part, 1.0f - part);
  if (distance >= kJoint) return 1.0f;
  return 1.0f - 0.45f * visibility(2.0f * kJoint, 0.5f * footprint);
}

/// Stains of 0.4 m and grain of 0.06 m, as a brightness around 1.
float patina(float u, float v, float footprint, std::uint32_t salt) {
  float out = 1.0f + 0.16f * value_noise(u * 2.5f, v * 2.5f, salt) * visibility(0.4f, footprint);
  if (footprint < 0.06f)
    out += 0.14f * value_noise(u * 16.0f, v * 16.0f, ~salt) * visibility(0.06f, footprint);
  return out;
}

SurfaceColour floor_colour(float x, float y, float footprint) {
  const int i = whole(x / kFloorTile), j = whole(y / kFloorTile);
  const float tile = 0.85f + 0.2f * cell_value(i, j, 11) + ((i + j) % 2 == 0 ? 0.12f : -0.12f);
  // Regions of 4 m tend to green, or to red.
  const float hue = value_noise(x * 0.25f, y * 0.25f, 12);
  const float light =
      tile * joint(x, kFloorTile, footprint) * joint(y, kFloorTile, footprint) * patina(x, y, footprint, 13);
  return SurfaceColour(0.44f + 0.07f * hue, 0.41f - 0.03f * hue, 0.36f - 0.05f * hue) * light;
}

SurfaceColour ceiling_colour(float x, float y, float footprint) {
  const float light = joint(x, kCeilingPanel, footprint) * joint(y, kCeilingPanel, footprint) *
                      (0.95f + 0.1f * cell_value(whole(x / kCeilingPanel), whole(y / kCeilingPanel), 21));
  return SurfaceColour(0.85f, 0.87f, 0.9f) * light * (0.5f + 0.5f * patina(x, y, footprint, 22));
}

/// Steps in a wall, as voxels make them, have the paint of the wall. `along`: the horizontal coordinate in
/// the wall.
SurfaceColour wall_colour(float x, float y, float z, float along, float footprint) {
  static const std::array<SurfaceColour, 8> paints{SurfaceColour(0.78f, 0.76f, 0.70f),
                                                   {0.70f, 0.58f, 0.38f},
                                                   {0.46f, 0.60f, 0.66f},
                                                   {0.52f, 0.66f, 0.48f},
                                                   SurfaceColour(0.70f, 0.46f, 0.40f),
                                                   {0.62f, 0.62f, 0.62f},
                                                   {0.74f, 0.70f, 0.50f},
                                                   {0.56f, 0.50f, 0.64f}};
  const std::uint32_t paint = cell_bits(whole((x + kOffset) / kPaint), whole((y + kOffset) / kPaint), 31);
  float light = 0.92f + 0.14f * cell_value(whole(along / kWallPanel), whole(z / kWallPanel), 32);
  light *= joint(along, kWallPanel, footprint) * joint(z, kWallPanel, footprint);
  light *= patina(along, z, footprint, 33);
  return paints[paint % paints.size()] * light;
}

}  // namespace

SurfaceColour surface_colour(SurfaceSide side, const Eigen::Vector3d& point, float footprint) {
  const Eigen::Vector3f at = point.cast<float>();
  switch (side) {
    case SurfaceSide::wall_x:
      return wall_colour(at.x(), at.y(), at.z(), at.y(), footprint);
    case SurfaceSide::wall_y:
      return wall_colour(at.x(), at.y(), at.z(), at.x(), footprint);
    case SurfaceSide::floor:
      return floor_colour(at.x(), at.y(), footprint);
    case SurfaceSide::ceiling:
      return ceiling_colour(at.x(), at.y(), footprint);
  }
  return SurfaceColour::Zero();
}

SurfaceColour body_colour(BodyKind kind, float height) {
  switch (kind) {
    case BodyKind::robot:
      return height < 0.3f ? SurfaceColour(0.07f, 0.07f, 0.08f) : SurfaceColour(1.0f, 0.48f, 0.05f);
    case BodyKind::person:
      if (height > 0.86f) return {0.95f, 0.74f, 0.58f};
      return height < 0.48f ? SurfaceColour(0.10f, 0.11f, 0.22f) : SurfaceColour(0.10f, 0.28f, 0.90f);
    case BodyKind::door:
      return {0.40f, 0.17f, 0.08f};
  }
  return SurfaceColour::Zero();
}

}  // namespace adit::sim
