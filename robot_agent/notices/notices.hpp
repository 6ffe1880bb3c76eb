#pragma once
#include <functional>
#include <string>

#include "core/log/log.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/motion/navigation.hpp"
#include "robot_agent/radio/notifier.hpp"
#include "robot_agent/state/restored.hpp"

namespace adit::agent {

/// Words the notices of the command component, and sends them to operators. Runs on the command strand.
class Notices {
 public:
  /// `holder`: name of the robot's holder, empty while nobody holds it. `notifier` must outlive this.
  Notices(std::string robot, Notifier& notifier, Log log, std::function<std::string()> holder);

  /// Sends it to the operator it names, to every operator if it names none.
  void send(const Notice& notice) const;
  /// Sends it to the holder; nothing is sent while nobody holds the robot.
  void send_to_holder(Notice notice) const;

  /// Says what a restart restored or lost. `same_boot`: the computer was not restarted.
  void restored(const Restored& found, bool same_boot) const;
  /// `why`: file, line and what is missing.
  void tree_refused(const std::string& why) const;
  /// Another robot has this robot's name. `gives_way`: this one does, else it stays in service.
  void namesake(const wire::ParticipantId& other, bool gives_way) const;
  void rival(const wire::ParticipantId& writer) const;
  /// `guess`: where the robot takes itself to be, map frame.
  void odometry_jumped(const Pose2& guess) const;
  void driver_lost() const;
  /// `stops`: the collision monitor stops the robot in its present mode; otherwise it only slows it down.
  void warning(Warning warning, bool stops) const;

 private:
  std::string robot_;
  Notifier& notifier_;
  Log log_;
  std::function<std::string()> holder_;
};

}  // namespace adit::agent
