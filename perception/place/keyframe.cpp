// SPDX-License-Identifier: Apache-2.0
#include "perception/place/keyframe.hpp"

#include <cmath>

#include "core/store/pack.hpp"
#include "perception/voxel/thin.hpp"

namespace adit::perception {
namespace {

constexpr float kMillimetre = 0.001f;  // m

std::int64_t packed(float metres) { return std::lround(metres / kMillimetre); }
float unpacked(std::int64_t value) { return static_cast<float>(value) * kMillimetre; }

}  // namespace

Keyframe make_keyframe(std::span<const Eigen::Vector3f> points, const Pose3& T_odom_base,
                       std::uint32_t odom_epoch, bool planar) {
  Keyframe keyframe{T_odom_base, odom_epoch, planar, {}};
  Thinner thinner({.wanted = Keyframe::kMaxPoints * 3 / 4,
                   .min_edge = 0.05f,
                   .min_range = 0.3f,
                   .max_range = Keyframe::kReach});
  for (const Eigen::Vector3f& p : thinner.thin(points)) {
    if (keyframe.points.size() == Keyframe::kMaxPoints) break;
    if (p.cwiseAbs().maxCoeff() < Keyframe::kReach) keyframe.points.push_back(p);
  }
  return keyframe;
}

std::vector<std::uint8_t> encode(const Keyframe& keyframe) {
  store::Packer out;
  out.put(keyframe.odom_epoch).flag(keyframe.planar);
  const Pose3& pose = keyframe.T_odom_base;
  for (int axis = 0; axis < 3; ++axis) out.put(pose.position[axis]);
  for (int part = 0; part < 4; ++part) out.put(pose.orientation.coeffs()[part]);
  out.varint(keyframe.points.size());
  for (const Eigen::Vector3f& p : keyframe.points)
    for (int axis = 0; axis < 3; ++axis) out.zigzag(packed(p[axis]));
  return out.bytes();
}

Result<Keyframe> decode_keyframe(std::span<const std::uint8_t> bytes, std::uint16_t version) {
  store::Unpacker in(bytes);
  Keyframe keyframe;
  keyframe.odom_epoch = in.get<std::uint32_t>();
  if (version >= 2) keyframe.planar = in.flag();
  for (int axis = 0; axis < 3; ++axis) keyframe.T_odom_base.position[axis] = in.number();
  for (int part = 0; part < 4; ++part) keyframe.T_odom_base.orientation.coeffs()[part] = in.number();
  const std::uint64_t count = in.varint();
  if (count > Keyframe::kMaxPoints) return Error{Reason::malformed, "a keyframe has fewer points"};
  for (std::uint64_t left = count; left > 0 && in.good(); --left) {
    Eigen::Vector3f point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = unpacked(in.zigzag());
    if (!(point.cwiseAbs().maxCoeff() <= Keyframe::kReach))
      return Error{Reason::malformed, "a point of a keyframe is too far away"};
    keyframe.points.push_back(point);
  }
  const Pose3& pose = keyframe.T_odom_base;
  constexpr double kFarthest = 1e5;  // m
  if (!in.done() || !(pose.position.norm() < kFarthest) || !(std::fabs(pose.orientation.norm() - 1.0) < 1e-3))
    return Error{Reason::malformed, "it is no keyframe"};
  return keyframe;
}

}  // namespace adit::perception
