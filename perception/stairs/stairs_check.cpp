// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/stairs_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace adit::perception {
namespace {

constexpr float kBehind = 0.2f;    // Beyond the inner edges of the steps, m: range noise is 8 cm at most.
constexpr float kOn = 0.1f;        // Beyond the edges, m.
constexpr float kBeside = 0.1f;    // Of the width, at each side, m: place and heading are not exact.
constexpr float kOfTread = 0.2f;   // At each end of a tread, where the next riser's points may lie.
constexpr float kBelowEye = 0.1f;  // m: ground that is no lower is not seen, but mixed returns at its edge.
constexpr std::size_t kLeastHere = 8;  // Points that determine a height.

/// Riser number k of a flight is at k runs from its foot, between the heights k rise and (k + 1) rise.
struct Frame {
  explicit Frame(const Staircase& s)
      : foot(s.foot.cast<float>() - Eigen::Vector3f(0, 0, static_cast<float>(s.rise) / 2)),
        ahead(s.direction().cast<float>()),
        run(static_cast<float>(s.run)),
        rise(static_cast<float>(s.rise)),
        half(static_cast<float>(s.width) / 2 - kBeside),
        length(static_cast<float>(s.steps - 1) * run),
        cosine(run / std::hypot(run, rise)) {}
  /// Along and across the flight, and above its lower floor, m.
  Eigen::Vector3f operator()(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f d = p - foot;
    return {d.head<2>().dot(ahead), ahead.x() * d.y() - ahead.y() * d.x(), d.z()};
  }
  /// Above the plane through the middle of the steps, m.
  float above(const Eigen::Vector3f& p) const { return (p.z() - p.x() * rise / run - rise / 2) * cosine; }
  float edge() const { return rise / 2 * cosine; }  ///< Of the steps from that plane, m.

  Eigen::Vector3f foot;
  Eigen::Vector2f ahead;
  float run, rise, half, length, cosine;
};

/// Heights before and behind a riser.
struct Heights {
  int riser{};
  std::vector<float> before{}, behind{};

  void add(const Frame& frame, const Eigen::Vector3f& p) {
    const float part = p.x() / frame.run - static_cast<float>(riser);
    const float off = p.z() / frame.rise - (static_cast<float>(riser) + 0.5f);
    if (std::abs(off) > 1.2f || std::abs(part) > 1.0f - kOfTread || std::abs(part) < kOfTread) return;
    (part < 0 ? before : behind).push_back(p.z());
  }
  StairsCheck::Riser judge(float rise) {
    if (before.size() < kLeastHere || behind.size() < kLeastHere) return StairsCheck::Riser::unseen;
    const auto median = [](std::vector<float>& heights) {
      const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
      std::nth_element(heights.begin(), middle, heights.end());
      return *middle;
    };
    const float steps = (median(behind) - median(before)) / rise;
    // Halfway, a body may stand there.
    if (steps > 0.7f) return StairsCheck::Riser::there;
    return steps < 0.3f ? StairsCheck::Riser::level : StairsCheck::Riser::unseen;
  }
};

}  // namespace

StairsCheck check_stairs(const Staircase& stairs, std::span<const StairsRays> scans) {
  const Frame frame(stairs);
  std::array<Heights, 4> ends{{{-1}, {0}, {stairs.steps - 1}, {stairs.steps}}};
  StairsCheck out;
  for (const StairsRays& scan : scans) {
    const Eigen::Vector3f eye = frame(scan.eye);
    const float eye_above = frame.above(eye);
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3f p = frame(point);
      const float above = frame.above(p);
      if (std::abs(p.y()) < frame.half)
        for (Heights& end : ends)
          if (static_cast<float>(end.riser + 1) * frame.rise < eye.z() - kBelowEye) end.add(frame, p);
      if (std::abs(above) <= frame.edge() + kOn) {
        if (std::abs(p.y()) < frame.half && p.x() > 0 && p.x() < frame.length) ++out.on;
        continue;
      }
      if (above > -(frame.edge() + kBehind) || eye_above < frame.edge() + kOn) continue;
      const Eigen::Vector3f cross = eye + (p - eye) * (eye_above / (eye_above - above));
      if (std::abs(cross.y()) < frame.half && cross.x() > 0 && cross.x() < frame.length) ++out.through;
    }
  }
  out.below = ends[0].judge(frame.rise);
  out.foot = ends[1].judge(frame.rise);
  out.top = ends[2].judge(frame.rise);
  out.above = ends[3].judge(frame.rise);
  return out;
}

}  // namespace adit::perception
