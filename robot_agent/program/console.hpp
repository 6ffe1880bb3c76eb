// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/result/result.hpp"

namespace adit::agent {

/// Passes a line to the agent, which calls `answer` from any thread, or never.
using ConsoleHandler =
    std::function<void(const std::string& line, std::function<void(const std::string&)> answer)>;

/// The robot's own console: a Unix socket that only its user (and root) may open,
/// $XDG_RUNTIME_DIR/adit/robot-NAME.sock or /tmp/adit-UID/robot-NAME.sock. One line in, one answer out.
class Console {
 public:
  /// Errors: in_use when an agent of that name runs here, cannot_write.
  static Result<std::unique_ptr<Console>> open(const std::string& robot, ConsoleHandler handler);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

 private:
  Console();
  struct Server;
  std::unique_ptr<Server> server_;
};

/// Sends a line to the robot's console and returns the answer. Errors: no_answer when no agent of that name
/// runs here or it does not answer, cannot_write, not_supported with the agent's words when it refuses.
Result<std::string> ask_console(const std::string& robot, const std::string& line);

}  // namespace adit::agent
