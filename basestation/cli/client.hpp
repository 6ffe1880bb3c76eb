#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"
#include "basestation/cli/process/line_socket.hpp"

namespace adit::station::cli {

/// One process's talk with its station. Calls back from wait().
class Client {
 public:
  /// `front_end`: what the station's other clients read of who began a command.
  Client(LineSocket socket, const std::string& front_end) : socket_(std::move(socket)) {
    send({{"front_end", front_end}});
  }

  std::function<void(const nlohmann::json&)> on_snapshot{};
  std::function<void(const nlohmann::json&)> on_notice{};
  /// A command that was begun or has ended, of this client and of others; server.hpp has its keys.
  std::function<void(const nlohmann::json&)> on_command{};
  /// So many notices and commands were lost because this client did not read.
  std::function<void(std::size_t)> on_missed{};
  std::function<void(std::int64_t id)> on_begun{};
  std::function<void(std::int64_t id, const nlohmann::json& outcome)> on_outcome{};

  /// Each returns the request's id.
  std::int64_t execute(const std::string& line);
  std::int64_t teleop(const std::string& robot);
  void stick(std::int64_t id, double vx, double vy, double wz);
  void cancel(std::int64_t id);
  void watch() { send({{"watch", true}}); }
  void notices() { send({{"notices", true}}); }

  /// Handles what comes within `timeout_ms`, or until `other_fd` (-1: none) has input. False when the station
  /// is gone.
  bool wait(int timeout_ms, int other_fd = -1);
  bool connected() const { return connected_; }
  /// Why the station is gone.
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

/// Runs one line at the station and prints its outcome; SIGINT ends it. The exit code.
int run_line(Client& client, const Options& options, const std::string& line);
/// Prints an outcome: text on stdout, refusals on stderr, or with --json its object on stdout. Its exit code.
int print_outcome(const Options& options, const nlohmann::json& outcome);
/// "basestation: TEXT" on stderr, with --json an object on stdout; returns `exit_code`.
int fail(const Options& options, int exit_code, const Error& error);
/// "watch: take r1: r1: yours" of a command of another front end that has ended; empty for all other events.
std::string command_of_another(const nlohmann::json& event);
/// Words as one line that splits into the same words.
std::string quoted(const std::vector<std::string>& words);

}  // namespace adit::station::cli
