// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/prediction.hpp"

#include <algorithm>
#include <cmath>

#include "nav/geometry/footprint.hpp"

namespace adit::nav {
namespace {

constexpr double kPredictionStep = 0.1;  // Time between the predicted places of one mover, s.
// Margin around the footprint, m: the robot cannot drive around what comes there.
constexpr float kOwn = 0.1f;
constexpr float kUnsure = 0.6f;    // Cost of a place that the mover may occupy.
constexpr float kLeft = 0.4f;      // Cost of the side that is left to an oncoming mover.
constexpr float kSpacing = 0.15f;  // Distance between the points on that side, m.
constexpr double kSlower = 0.5;    // Fraction of its speed that is assumed as the robot's minimum.
constexpr double kHeadOn = 0.8;    // A mover that passes at a greater distance is not oncoming, m.
constexpr float kAhead = 0.7f;     // Cosine of the half angle of the sector in which a mover can be oncoming.
constexpr double kClosing = 0.3;   // Minimum approach speed of an oncoming mover, m/s.

/// Distances that the robot can have travelled after a time, m.
struct Reach {
  double least, most;
};

Reach reach(const Platform& platform, double speed, double t) {
  const double rise = (platform.max_speed - speed) / platform.max_acceleration;
  const double fast = t < rise ? speed * t + platform.max_acceleration * t * t / 2
                               : platform.max_speed * t - platform.max_acceleration * rise * rise / 2;
  return {kSlower * speed * t, std::max(fast, speed * t)};
}

/// Whether a mover approaches the robot about along the line between them. Robot's frame.
bool head_on(const Eigen::Vector2f& at, const Eigen::Vector2f& velocity) {
  const float range = at.norm(), speed = velocity.norm();
  if (range < 0.1f || at.x() < kAhead * range) return false;
  const float closing = -at.dot(velocity) / range;
  const float aside = std::fabs(at.x() * velocity.y() - at.y() * velocity.x()) / std::max(0.1f, speed);
  return closing > kClosing && aside < kHeadOn;
}

}  // namespace

void predict(std::span<const Mover> movers, double age, const Pose2& pose, double speed,
             const Platform& platform, std::vector<ObstaclePoint>& out, const PredictionParams& params) {
  const Footprint body = Footprint(platform).grown(kOwn, kOwn);
  const double around = body.radius() + params.slack;
  const auto local = [into = IntoPose(pose)](const Eigen::Vector2f& d) { return into.turn(d.x(), d.y()); };
  const auto add = [&](const Eigen::Vector2f& at, float cost) {
    if (out.size() < out.capacity() && body.depth(at.x(), at.y()) <= 0) out.push_back({at.x(), at.y(), cost});
  };
  const Eigen::Vector2f origin = pose.position().cast<float>();
  for (const Mover& mover : movers) {
    if (!mover.moves) continue;  // The terrain map holds it as an obstacle.
    const Eigen::Vector2f velocity = local(mover.velocity);
    const Eigen::Vector2f middle = local(mover.position - origin) + static_cast<float>(age) * velocity;
    const bool gives_way = head_on(middle, velocity);
    for (double t = kPredictionStep; t <= params.horizon; t += kPredictionStep) {
      const Reach way = reach(platform, speed, t);
      const Eigen::Vector2f moved = static_cast<float>(age + t) * velocity;
      const float cost = t <= params.sure ? 1.0f : kUnsure;
      const auto meets = [&](const Eigen::Vector2f& at) {
        return at.norm() <= way.most + around && at.norm() >= way.least - around;
      };
      for (const Eigen::Vector2f& p : mover.surface()) {
        const Eigen::Vector2f seen = local(p - origin), at = seen + moved;
        if (!meets(at)) continue;
        add(at, cost);
        add(at + static_cast<float>(params.thickness) * seen.normalized(), cost);
      }
      const Eigen::Vector2f then = middle + static_cast<float>(t) * velocity;
      if (!gives_way || !meets(then) || then.x() < 0) continue;
      const Eigen::Vector2f left = Eigen::Vector2f(-then.y(), then.x()).normalized();
      for (float off = kSpacing; off <= static_cast<float>(params.aside); off += kSpacing)
        add(then + off * left, kLeft);
    }
  }
}

double speed_beside(std::span<const Mover> movers, double age, const Plan& plan, const Platform& platform,
                    const PredictionParams& params) {
  constexpr std::size_t kStride = 4;  // Every fourth pose of the path is checked.
  double top = platform.max_speed;
  const auto path = plan.path();
  if (path.size() < 2) return top;
  const Footprint body(platform);
  const double braking = params.braking_share * platform.max_acceleration;
  const double spacing = plan.length / static_cast<double>(path.size() - 1);
  // The highest speed at which the robot's stopping distance and the mover's travel meanwhile fit in `apart`.
  const auto safe = [&](double apart, double closing) {
    const double left = std::max(0.0, apart - closing * params.reaction);
    const double linear = params.reaction + closing / braking;
    return braking * (std::sqrt(linear * linear + 2 * left / braking) - linear);
  };
  for (std::size_t i = 0; i < path.size(); i += kStride) {
    const double before = 2 * braking * spacing * static_cast<double>(i);
    if (top * top <= before) break;
    const Pose2& at = path[i];
    const IntoPose into(at);
    double own = top;
    const auto later = static_cast<float>(age + spacing * static_cast<double>(i) / platform.max_speed);
    for (const Mover& mover : movers) {
      float apart = 1e9f;
      Eigen::Vector2f nearest(1, 0);
      for (const Eigen::Vector2f& p : mover.surface()) {
        const Eigen::Vector2f d = p + later * mover.velocity - at.position().cast<float>();
        const float off = -body.depth(into.turn(d.x(), d.y()));
        if (off >= apart) continue;
        apart = off;
        nearest = d;
      }
      const double closing = -nearest.normalized().dot(mover.velocity) + params.swerve;
      own = std::min(own, safe(std::max(0.0f, apart), std::max(params.stepping, closing)));
    }
    own = std::max(params.creep, own);
    top = std::min(top, std::sqrt(own * own + before));
  }
  return top;
}

}  // namespace adit::nav
