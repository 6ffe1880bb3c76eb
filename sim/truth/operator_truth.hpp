// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "core/wire/memory/simulated_network.hpp"

namespace adit::sim {

/// What an operator can lose of a robot that he holds.
enum class Loss : std::uint8_t {
  contact,  ///< Nothing of the robot reached the operator's machine for 2.5 s.
  stopped,  ///< Another station stopped it.
  motion,   ///< It says that it does not do what it was sent to do.
};

constexpr std::string_view to_string(Loss loss) {
  constexpr std::string_view kNames[]{"contact", "stopped", "motion"};
  return kNames[static_cast<std::size_t>(loss)];
}

/// What one operator's robots lost, whatever his station and his window believe: from the frames that robots
/// send, and those of them that arrive at his machine. Whether a robot does what it was sent to do is taken
/// from what it says; its true motion shows robots that drive although they deny it, or stand although they
/// do not.
///
/// Frames and motions come in the order of time. Memory is bounded by the number of robots.
class OperatorTruth {
 public:
  static constexpr Duration kSilence{2500ms};  ///< Without a frame for longer, contact is lost.
  static constexpr Duration kRecent{3s};       ///< Age of what an alert that appears now may be about.

  explicit OperatorTruth(std::string station) : station_(std::move(station)) {}

  /// A frame of the radio, sent or delivered; others are left out.
  void see(const wire::SampleEvent& frame);
  /// The operator's station begins again: what reached the one before does not count.
  void station_restarted();
  /// A robot moved there in truth (world frame, m). Called at 10 Hz or more.
  void moved(const std::string& robot, Duration at, const Eigen::Vector2d& position);

  /// How long this operator's machine has had the proof that his robot lost that; empty: it has none, or the
  /// robot is not his.
  std::optional<Duration> lasts(const std::string& robot, Loss loss, Duration now) const;
  /// Whether an alert of that robot that appears now is true: the loss is there or was within kRecent, and a
  /// robot that is said not to move was not driving.
  bool is_true(const std::string& robot, Loss loss, Duration now) const;
  /// How long the robot has stood within 0.1 m although it has a goal that it may drive to and is not lost;
  /// empty: it does not, or is not this operator's.
  std::optional<Duration> stands_with_goal(const std::string& robot, Duration now) const;

 private:
  /// A state of the robot, as last sent or as last arrived.
  struct View {
    bool held{};               ///< By this operator.
    bool stopped{}, stands{};  ///< By another station; as Loss::motion.
    bool drives{};             ///< It has a goal, and says that it may move.
    Duration held_since{}, stopped_since{}, stands_since{}, drives_since{};
    std::optional<Duration> stopped_until{}, stands_until{};  ///< Latest times with that.
  };
  struct Robot {
    View sent{}, arrived{};
    std::optional<Duration> heard{};                         ///< Its newest frame that arrived.
    Duration heard_since{};                                  ///< The first one after a silence.
    std::deque<std::pair<Duration, Eigen::Vector2d>> way{};  ///< Of the last two seconds.
    Eigen::Vector2d stood_at{Eigen::Vector2d::Zero()};
    Duration stood_since{};
  };
  void take(View& view, const wire::SampleEvent& frame) const;

  std::string station_;
  std::map<std::string, Robot> robots_{};
};

}  // namespace adit::sim
