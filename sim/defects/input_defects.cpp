// SPDX-License-Identifier: Apache-2.0
// Defects of the sensor input of the agent.
#include <cmath>
#include <optional>
#include <string_view>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sim/defects/decorations.hpp"

namespace adit::sim {
namespace {

namespace topics = wire::topics;

bool is(const Arrival& arrival, const wire::TopicInfo& topic) {
  return arrival.topic->name == std::string_view(topic.name);
}

/// Scans wait, and are stamped when they are handed over.
class AgeAtHandling final : public Interceptor {
 public:
  std::vector<Arrival> received(Arrival arrival) override {
    constexpr Duration kWaits = 300ms;
    if (is(arrival, topics::kPoints)) {
      arrival.delay = kWaits;
      arrival.info.received += kWaits;
    }
    return Interceptor::received(std::move(arrival));
  }
};

/// Goes on from the last pose when the odometry jumps.
class SmoothsJumps final : public Interceptor {
 public:
  std::vector<Arrival> received(Arrival arrival) override {
    nav_msgs::msg::Odometry odometry;
    if (is(arrival, topics::kOdom) && wire::decode(arrival.cdr, odometry)) {
      smooth(odometry.pose().pose());
      wire::encode(odometry, arrival.cdr);
    }
    return Interceptor::received(std::move(arrival));
  }

 private:
  void smooth(geometry_msgs::msg::Pose& pose) {
    constexpr double kJump = 0.5;  // m, rad: between two samples
    const Pose2 reported{pose.position().x(), pose.position().y(),
                         2 * std::atan2(pose.orientation().z(), pose.orientation().w())};
    if (last_reported_ && ((reported.position() - last_reported_->position()).norm() > kJump ||
                           std::fabs(wrap_angle(reported.yaw - last_reported_->yaw)) > kJump))
      offset_ = last_given_ * reported.inverse();
    last_reported_ = reported;
    last_given_ = offset_ * reported;
    pose.position().x(last_given_.x);
    pose.position().y(last_given_.y);
    pose.orientation().z(std::sin(last_given_.yaw / 2));
    pose.orientation().w(std::cos(last_given_.yaw / 2));
  }

  std::optional<Pose2> last_reported_{};
  Pose2 last_given_{}, offset_{};
};

template <class T>
Decoration on_wires() {
  Decoration decoration;
  decoration.wires = std::make_unique<T>();
  return decoration;
}

}  // namespace

namespace decorations {

Decoration age_at_handling(const Subject&) { return on_wires<AgeAtHandling>(); }
Decoration odometry_jump_accepted(const Subject&) { return on_wires<SmoothsJumps>(); }
Decoration return_forgotten(const Subject&) {
  Decoration decoration;
  decoration.parameters = [](agent::AgentParams& params) { params.safeguards.return_retry = 24h; };
  return decoration;
}

}  // namespace decorations
}  // namespace adit::sim
