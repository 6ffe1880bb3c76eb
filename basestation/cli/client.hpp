// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"
#include "basestation/cli/process/line_socket.hpp"

namespace adit::station::cli {

/// A connection of one process to its station. Callbacks run within wait().
class Client {
 public:
  /// `front_end`: name under which the station's other clients see this client's commands.
  Client(LineSocket socket, const std::string& front_end) : socket_(std::move(socket)) {
    send({{"front_end", front_end}});
  }

  std::function<void(const nlohmann::json&)> on_snapshot{};
  std::function<void(const nlohmann::json&)> on_notice{};
  /// Called when a command of this or another client began or ended; server.hpp lists the keys.
  std::function<void(const nlohmann::json&)> on_command{};
  /// Called with the number of notices and command events that were lost because this client did not read.
  std::function<void(std::size_t)> on_missed{};
  std::function<void(std::int64_t id)> on_begun{};
  std::function<void(std::int64_t id, const nlohmann::json& outcome)> on_outcome{};

  /// Send a request; each returns the request's id.
  std::int64_t execute(const std::string& line);
  std::int64_t teleop(const std::string& robot);
  void stick(std::int64_t id, double vx, double vy, double wz);
  void cancel(std::int64_t id);
  void watch() { send({{"watch", true}}); }
  void notices() { send({{"notices", true}}); }

  /// Handles the messages that arrive within `timeout_ms`, or until `other_fd` (-1: none) has input. Returns
  /// false if the connection to the station is closed.
  bool wait(int timeout_ms, int other_fd = -1);
  bool connected() const { return connected_; }
  /// Why the connection to the station is closed.
  std::string gone() const;

 private:
  void send(const nlohmann::json& object);
  void handle(const std::string& line);

  LineSocket socket_;
  std::int64_t next_{1};
  bool connected_{true};
  bool can_send_{true};  ///< False after a failed send; wait() still reads what the station wrote before.
  std::string cut_off_{};
};

/// Runs one line at the station and prints its outcome; SIGINT ends it. Returns the exit code.
int run_line(Client& client, const Options& options, const std::string& line);
/// Prints an outcome: text on stdout, refusals on stderr, or with --json its object on stdout. Returns its
/// exit code.
int print_outcome(const Options& options, const nlohmann::json& outcome);
/// Prints "basestation: TEXT" on stderr, or with --json an object on stdout; returns `exit_code`.
int fail(const Options& options, int exit_code, const Error& error);
/// Describes an ended command of another front end, e.g. "watch: take r1: r1: taken"; empty for all other
/// events.
std::string command_of_another(const nlohmann::json& event);
/// Makes the path of a command's file absolute: the station, which opens it, runs in another folder. A line
/// without a file, or that is wrong, is returned unchanged.
std::string with_absolute_files(const std::string& line);
/// Joins words into one line that splits into the same words.
std::string quoted(const std::vector<std::string>& words);

}  // namespace adit::station::cli
