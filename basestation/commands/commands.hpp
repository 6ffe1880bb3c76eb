// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "basestation/commands/camera_commands.hpp"
#include "basestation/commands/finding_commands.hpp"
#include "basestation/commands/gather.hpp"
#include "basestation/commands/map_commands.hpp"
#include "basestation/content/content.hpp"
#include "basestation/flow/flows.hpp"
#include "basestation/send/sender.hpp"
#include "basestation/send/stick.hpp"

namespace adit::station {

/// Runs the command lines of a station: queues those that must wait, sends them to robots, gathers the
/// answers, and answers queries.
class Commands {
 public:
  using Done = std::function<void(const Outcome&)>;

  /// `random`: draws the ids of convoys.
  Commands(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
           Presence& presence, Content& content, Cameras& cameras, Random& random);

  /// Runs a parsed command line, at once or later, and calls `done` once. Returns a handle for cancel() and
  /// stick(). Wrong lines, and those that need a terminal, are refused with wrong usage.
  std::uint64_t execute(const Result<command::Request>& request, const Done& done);
  /// Starts manual control of a robot by a live stick.
  std::uint64_t teleop(const std::string& robot, Done done) {
    return begin(command::Request(command::verb("teleop"), {robot}), std::move(done));
  }
  void cancel(std::uint64_t handle);
  void stick(std::uint64_t handle, const StickVelocity& velocity) { flows_.set_velocity(handle, velocity); }
  /// Processes a robot's answer to a command or to a joystick sample.
  void hear(const radio::Acknowledgement& sample, const wire::SampleInfo& info);
  /// Opens what commands to a new robot need.
  void prepare(const std::string& robot) { sender_.prepare(robot); }
  /// Runs what has waited long enough. Call it every 100 ms.
  void tick();

  const Counts& counts() const { return sender_.counts(); }
  /// The newest answer to this operator, from a robot or from the station itself.
  const std::optional<Answer>& last_answer() const { return last_answer_; }

  /// Observers. Set them before the first command.
  std::function<void()> on_answer{}, on_down{};

 private:
  /// A command line that waits, e.g. for its robots to be discovered.
  struct Waiting {
    std::uint64_t handle{};
    command::Request request{};
    Done done{};
  };
  std::uint64_t begin(const command::Request& request, Done done);
  std::uint64_t refuse(const Error& error, const Done& done);
  void refuse(const command::Request& request, Reason reason, const std::string& text, const Done& done);
  /// Refuses what is queued for the robots of a later stop and could undo it.
  void drop_waiting(std::uint64_t handle, const command::Request& stop);
  bool must_wait(std::uint64_t handle, const command::Request& request) const;
  bool known(const command::Request& request) const;
  /// Whether a peer was heard, and of each peer all messages that `list` shows.
  bool complete() const;
  bool fresh(Duration span) const { return strand_.now() - started_ < span; }
  void run_waiting();
  void run(std::uint64_t handle, const command::Request& request, Done done);
  void answer_query(const command::Request& request, const Done& done);
  /// Sends `request` to the robots of `answered`, the typed command, and reports their answers.
  void command_robots(std::uint64_t handle, const command::Request& request, const command::Request& answered,
                      Gather::Done done);
  void command_robot(std::uint64_t handle, const std::string& robot, const command::Request& request,
                     const std::shared_ptr<Gather>& gather);
  /// Gives each robot its place; if one refuses, the others leave again.
  void start_convoy(std::uint64_t handle, const command::Request& request, Done done);
  void stop_convoy(std::uint64_t handle, command::Request request, const Done& done);
  /// Sends a robot over a staircase; answered when it accepts the first goal.
  void go_over_stairs(std::uint64_t handle, const command::Request& request, const Done& done);
  void stop_all(const command::Request& request, const Done& done);
  /// Stops the robots that are heard and were not asked yet.
  void ask_stop(std::shared_ptr<Gather> all);
  void close_stop_alls();
  /// Releases all robots and ends; refuses while one would go on without a holder, unless `--leave` is given.
  void down(const command::Request& request, const Done& done);
  Gather::Done reported_to(Done done) const;
  void note(const Answer& answer);
  /// Notifies the operator of the end of a stop that was reported as not acknowledged.
  void late_stop(const Answer& answer);

  const StationParams& params_;
  Executor& strand_;
  Fleet& fleet_;
  Presence& presence_;
  Content& content_;
  Random& random_;
  Time started_;
  Sender sender_;
  Stick stick_;
  MapCommands maps_;
  FindingCommands findings_;
  Cameras& cameras_;
  CameraCommands camera_commands_;
  std::deque<Waiting> waiting_{};  ///< In the order in which they were given.
  Flows flows_{};
  /// Each a `stop all` of a station that was just started and has not heard all robots yet.
  std::vector<std::shared_ptr<Gather>> stop_alls_{};
  std::uint64_t next_handle_{1};
  std::optional<Answer> last_answer_{};
  std::map<std::string, std::uint64_t> commanded_{};  ///< Commands of this station to each robot.
  std::optional<Time> accepted_{};                    ///< When a robot last accepted a command.
};

}  // namespace adit::station
