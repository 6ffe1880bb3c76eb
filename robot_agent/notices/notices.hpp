// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "core/config/perception_level.hpp"
#include "core/log/log.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/motion/navigation.hpp"
#include "robot_agent/radio/notifier.hpp"
#include "robot_agent/state/restored.hpp"

namespace adit::agent {

/// Composes the notifications of the command component and sends them to operators. Runs on the command
/// strand.
class Notices {
 public:
  /// `holder`: name of the robot's holder, empty if there is none. `notifier` must outlive this.
  Notices(std::string robot, Notifier& notifier, Log log, std::function<std::string()> holder);

  /// Sends a notice to the operator it names, or to every operator if it names none.
  void send(const Notice& notice) const;
  void to_all(Severity severity, const std::string& code, Reason reason, const std::string& text) const {
    send({{}, severity, code, reason, text});
  }
  /// Sends a notice to the holder; nothing is sent if there is no holder.
  void to_holder(Severity severity, const std::string& code, Reason reason, const std::string& text) const;

  /// Reports what a restart restored or lost. `same_boot`: the computer was not restarted.
  void restored(const Restored& found, bool same_boot) const;
  /// Reports a refused behaviour tree. `why`: file, line and what is missing.
  void tree_refused(const std::string& why) const;
  /// Reports that another robot has this robot's name. `gives_way`: this robot gives way; otherwise it stays
  /// in service.
  void namesake(const wire::ParticipantId& other, bool gives_way) const;
  void rival(const wire::ParticipantId& writer) const;
  void announcement_refused(const std::string& name, const std::string& why) const;
  /// Reports a jump of the odometry. `guess`: the assumed pose of the robot, map frame.
  void odometry_jumped(const Pose2& guess) const;
  void not_localised_here(const Pose2& guess, const std::string& why) const;
  /// `sigma`: standard deviation of the position, m.
  void localisation(Localisation health, double sigma) const;
  /// The place of a lost robot is not searched for any more: it may be farther away than `radius`, m.
  void place_not_searched(double radius) const;
  void wheels_slip(bool flies) const;
  void stuck() const;
  void driver_lost() const;
  /// Reports a warning. `stops`: the collision monitor stops the robot in its present mode; otherwise it only
  /// slows the robot down.
  void warning(Warning warning, bool stops) const;

 private:
  std::string robot_;
  Notifier& notifier_;
  Log log_;
  std::function<std::string()> holder_;
};

}  // namespace adit::agent
