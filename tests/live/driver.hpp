// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cmath>

#include "core/wire/topics.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tests/live/crew.hpp"
#include "tests/point_cloud.hpp"

namespace adit::live {

/// A robot's driver that obeys exactly, on an empty plain; counts the velocities it receives.
class PlainDriver {
 public:
  /// `heard`: called for each velocity, m/s, on the driver's strand.
  explicit PlainDriver(Net& net, std::function<void(double velocity, const wire::SampleInfo&)> heard = {})
      : net_(net),
        heard_(std::move(heard)),
        strand_(net.machine("driver").strand("driver")),
        wire_(net.join_robot("driver")) {
    odom_ = wire::Writer<nav_msgs::msg::Odometry>::make(*wire_, wire::topics::kOdom).value();
    points_ = wire::Writer<sensor_msgs::msg::PointCloud2>::make(*wire_, wire::topics::kPoints).value();
    net_.on(*strand_, [this] {
      timers_.push_back(strand_->every(std::chrono::milliseconds(20), [this] { step(); }));
      timers_.push_back(strand_->every(std::chrono::milliseconds(100), [this] { scan(); }));
    });
    cmd_vel_ = wire::make_reader(*wire_, wire::topics::kCmdVel, *strand_,
                                 [this](const geometry_msgs::msg::Twist& t, const wire::SampleInfo& info) {
                                   velocity_ = t.linear().x();
                                   told_.use([this](Told& told) {
                                     ++told.count;
                                     if (velocity_ != 0.0) ++told.moving;
                                     told.last = velocity_;
                                   });
                                   if (heard_) heard_(velocity_, info);
                                 })
                   .value();
  }
  ~PlainDriver() {
    cmd_vel_.reset();
    net_.on(*strand_, [this] { timers_.clear(); });
  }

  struct Told {
    int count{}, moving{};
    double last{};
  };
  Told told() const { return told_.get(); }
  /// From now on each cloud has at least so many bytes of points.
  void enlarge_clouds(std::size_t bytes) { cloud_bytes_.store(bytes); }

 private:
  void step() {
    x_ += velocity_ * 0.02;
    nav_msgs::msg::Odometry o;
    stamp(o.header());
    o.pose().pose().position().x(x_);
    o.pose().pose().orientation().w(1.0);
    o.twist().twist().linear().x(velocity_);
    (void)odom_.write(o);
  }
  void scan() {
    std::vector<float> ground;
    for (int i = 0; i < 360; i += 2)
      for (const float r : {1.0F, 2.0F, 4.0F}) {
        const float a = static_cast<float>(i) * 0.0174533F;
        ground.insert(ground.end(), {r * std::cos(a), r * std::sin(a), 0.0F});
      }
    while (ground.size() * sizeof(float) < cloud_bytes_.load())
      ground.insert(ground.end(), {4.0F, 0.0F, 0.0F});
    sensor_msgs::msg::PointCloud2 c = cloud_of(ground);
    stamp(c.header());
    (void)points_.write(c);
  }
  void stamp(std_msgs::msg::Header& header) {
    const auto ns = strand_->now().time_since_epoch().count();
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }

  Net& net_;
  std::function<void(double, const wire::SampleInfo&)> heard_;
  Shared<Told> told_{};
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  wire::Writer<nav_msgs::msg::Odometry> odom_{};
  wire::Writer<sensor_msgs::msg::PointCloud2> points_{};
  std::unique_ptr<wire::RawReader> cmd_vel_{};
  std::vector<Timer> timers_{};
  std::atomic<std::size_t> cloud_bytes_{0};
  double velocity_{}, x_{};  // on the strand
};

}  // namespace adit::live
