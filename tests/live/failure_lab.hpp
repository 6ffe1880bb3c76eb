// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/live/driver.hpp"
#include "tests/live/process.hpp"

namespace adit::live {

/// robot_agent under its parent as processes, a driver, a holder, and somebody who writes down what is said
/// and when: for measuring how a robot fails and comes back.
class FailureLab {
 public:
  /// All times in ms from the failure; nothing when it did not come about.
  struct Killed {
    std::optional<double> zero{};  ///< The driver receives zero.
    std::optional<double> back{};  ///< A station hears the new agent's authority with its holder.
    /// Velocities that were not zero between the two; in a mode that goes on by itself, of who wrote before
    /// the death.
    int moved{};
  };
  struct Failed {
    std::optional<double> told{};  ///< component_failed or component_hung is heard
    std::optional<double> back{};  ///< component_back, or the new agent's authority, is heard
  };

  FailureLab();
  ~FailureLab();
  /// The agent is there and held by op1.
  bool ready();
  /// Enters `hold`, `manual`, `smart_joystick` or `waypoint`; in all but `hold` the robot moves on return.
  bool enter(const std::string& mode);
  /// Sends SIGKILL to the agent.
  Killed kill_agent();
  /// Through the robot's console.
  Failed crash(const std::string& component);
  Failed hang(const std::string& component);
  /// A component hangs that only the operator may replace, while the driver's clouds have `cloud_bytes` and
  /// come ten times a second for `time`. Nothing when it did not come about.
  struct Hung {
    double megabytes{};  ///< Resident memory of the agent at its largest, sampled ten times a second.
    double growth{};     ///< Of it, since the first tenth of the time, MB.
    int clouds{};        ///< That another reader on the robot's inner network received.
  };
  std::optional<Hung> stay_hung(const std::string& component, std::size_t cloud_bytes, Duration time);
  /// Moves nothing, and is in hold.
  bool calm();
  /// A line at the robot's own console.
  std::string console(const std::string& line);
  /// A new process of the agent, with all threads.
  bool fresh_agent();
  /// SIGTERM to the parent; its exit code.
  int end();
  const std::string& err() const { return parent_->err(); }
  const Folder& folder() const { return folder_; }
  pid_t agent() const;

 private:
  struct Velocity {
    Time at{};
    bool moves{};
    wire::ParticipantId sender{};
  };
  struct Heard {
    std::vector<std::pair<Time, std::string>> notices{};
    std::vector<std::pair<Time, radio::AuthorityStatus>> authorities{};
    std::vector<Velocity> velocities{};
  };
  Time now() const;
  std::optional<Time> notice(const std::string& code, Time since);
  std::optional<Time> new_authority(const radio::Epoch& before, Time since);
  radio::Epoch epoch();
  Failed fault(const std::string& kind, const std::string& component, const char* told);

  Folder folder_{};
  std::unique_ptr<Net> net_{make_live_net()};
  Shared<Heard> heard_{};
  PlainDriver driver_;
  std::shared_ptr<Executor> ear_strand_;
  std::unique_ptr<wire::Participant> ear_;
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::unique_ptr<Operator> op_{};
  std::unique_ptr<Process> parent_{};
  bool goes_on_{};  ///< A restarted agent continues in the mode entered.
};

}  // namespace adit::live
