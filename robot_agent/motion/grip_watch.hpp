// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/time/time.hpp"

namespace adit::agent {

/// Watches whether the body follows its wheels, as the robot's own odometry sees it.
class GripWatch {
 public:
  static constexpr Duration kTold = 1s;    ///< A shorter slip, as over a stone, is not worth a message.
  static constexpr Duration kStands = 5s;  ///< The body stands when it did not move by kWay for so long.
  /// The slowest planner drives 0.1 m/s: half of its way in kStands, m.
  static constexpr double kWay = 0.25;
  static constexpr Duration kApart = 3s;  ///< What follows sooner is the same slip.

  enum class Event {
    none,
    slips,  ///< The wheels have been slipping for a second.
    stuck,  ///< They turn, and the body has stood for kStands; again after each further kStands.
  };

  /// To be called with each pose of the odometry. `at`: of the body, m.
  Event note(bool slips, const Eigen::Vector3d& at, Time now) {
    if (!slips) {
      if (since_ && now - last_ >= kApart) since_.reset();
      return Event::none;
    }
    last_ = now;
    if (!since_) {
      since_ = now;
      told_ = false;
      stand_at(at, now);
    }
    if ((at - place_).norm() > kWay) stand_at(at, now);
    if (now - stands_since_ >= kStands) {
      stand_at(at, now);
      return Event::stuck;
    }
    if (told_ || now - *since_ < kTold) return Event::none;
    told_ = true;
    return Event::slips;
  }

 private:
  void stand_at(const Eigen::Vector3d& at, Time now) {
    place_ = at;
    stands_since_ = now;
  }

  std::optional<Time> since_{};
  Time last_{}, stands_since_{};
  Eigen::Vector3d place_{0, 0, 0};
  bool told_{false};
};

}  // namespace adit::agent
