// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <utility>

#include "core/time/time.hpp"

namespace adit::agent {

/// Watches whether the body follows its wheels, as the robot's own odometry sees it. Only time in which it
/// slips counts: between two calls that both slip, kLongestGap at most.
class GripWatch {
 public:
  static constexpr Duration kTold = 1s;    ///< A shorter slip, as over a stone, is not worth a message.
  static constexpr Duration kStands = 5s;  ///< The body stands when it did not move by kWay for so long.
  /// The slowest planner drives 0.1 m/s: half of its way in kStands, m.
  static constexpr double kWay = 0.25;
  static constexpr Duration kApart = 3s;          ///< What follows later is another slip.
  static constexpr Duration kLongestGap = 300ms;  ///< Three scans of 10 Hz.

  enum class Event {
    none,
    slips,  ///< The wheels have been slipping for a second.
    stuck,  ///< They turn, and the body has stood for kStands; again after each further kStands.
  };

  /// To be called with each pose of the odometry. `at`: of the body, m.
  Event note(bool slips, const Eigen::Vector3d& at, Time now) {
    const bool goes_on = std::exchange(slips_, slips) && slips;
    if (!slips) return Event::none;
    const auto before = std::exchange(last_, now);
    if (!before || now - *before >= kApart) {
      slipped_ = {};
      told_ = false;
      stand_at(at);
    } else if (goes_on) {
      const Duration gap = std::clamp(now - *before, Duration{}, kLongestGap);
      slipped_ += gap;
      stood_ += gap;
    }
    if ((at - place_).norm() > kWay) stand_at(at);
    if (stood_ >= kStands) {
      stand_at(at);
      return Event::stuck;
    }
    if (told_ || slipped_ < kTold) return Event::none;
    told_ = true;
    return Event::slips;
  }
  /// What slipped before does not count against the mode that begins.
  void begin_mode() { stood_ = {}; }

 private:
  void stand_at(const Eigen::Vector3d& at) {
    place_ = at;
    stood_ = {};
  }

  bool slips_{}, told_{};
  std::optional<Time> last_{};  ///< When it slipped last.
  Duration slipped_{};          ///< In this slip.
  Duration stood_{};            ///< Of it, since the body came to `place_`.
  Eigen::Vector3d place_{0, 0, 0};
};

}  // namespace adit::agent
