// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/prompt.hpp"

#include <editline/readline.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>

#include "basestation/cli/completion.hpp"
#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/run_line.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/report/table.hpp"
#include "core/command/parse.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::station::cli {
namespace {

using command::Request;
using command::verb;

class Prompt {
 public:
  explicit Prompt(const Options& options) : options_(options) {}

  Result<void> connect() {
    auto socket = cli::connect(options_);
    if (!socket) return socket.error();
    client_.emplace(std::move(*socket), "prompt");
    listen();
    return {};
  }

  /// Runs a line; returns false if it ends the prompt.
  bool execute(const std::string& line) {
    auto words = command::split_words(line);
    if (words && words->empty()) return true;
    if (words && (words->front() == "quit" || words->front() == "exit")) return false;
    if (words && words->front() == "help") {
      std::string text;
      if (words->size() > 1)
        for (const command::CommandInfo* row : command::find_commands((*words)[1]))
          text += command::help(*row);
      if (text.empty()) text = command::help_all() + "  quit, Ctrl-D                leave the prompt\n";
      std::fputs(text.c_str(), stdout);
      return true;
    }
    auto request = words ? command::parse(*words) : Result<Request>(words.error());
    const int code = request ? run(*request, line) : fail(options_, kExitUsage, request.error());
    if (code != kExitDone) code_ = code;
    return !request || request->verb != verb("down") || code != kExitDone;
  }

  /// Prints received notices; returns whether something was printed.
  bool poll_notices(int timeout_ms, int other_fd) {
    printed_ = false;
    if (connected() && !client_->wait(timeout_ms, other_fd)) {
      std::printf("%sthe station has ended; the next command starts one\n", clear_);
      printed_ = true;
    } else if (!connected()) {
      pollfd input{other_fd, POLLIN, 0};
      ::poll(&input, 1, timeout_ms);
    }
    return printed_;
  }

  const std::vector<std::string>& robots() const { return robots_; }
  int code() const { return code_; }

 private:
  void listen() {
    client_->on_notice = [this](const Notice& notice) {
      if (!notice.mine) return;
      const bool named = notice.robot.empty() || notice.text.find(notice.robot) != std::string::npos;
      const std::string when = ago(notice.age);
      std::printf("%s* %s%s%s\n", clear_, named ? "" : (notice.robot + ": ").c_str(), notice.text.c_str(),
                  when.empty() ? "" : (" (" + when + ")").c_str());
      printed_ = true;
    };
    client_->on_world = [this](const World& world) {
      robots_.clear();
      for (const Robot& robot : world.robots) robots_.push_back(robot.name);
    };
    client_->on_command = [this](const CommandEvent& event) {
      if (const std::string text = command_of_another(event); !text.empty()) {
        std::printf("%s* %s\n", clear_, text.c_str());
        printed_ = true;
      }
    };
    client_->on_missed = [this](std::size_t count) {
      std::printf("%s* %zu notifications were not shown\n", clear_, count);
      printed_ = true;
    };
    client_->notices();
    client_->follow();
  }

  bool connected() const { return client_ && client_->connected(); }

  int run(const Request& request, const std::string& line) {
    const bool needs_station =
        request.verb != verb("stop") && request.verb != verb("run") && request.verb != verb("down");
    if (needs_station && !connected())
      if (auto good = connect(); !good)
        return fail(options_, exit_without_station(good.error()), good.error());
    return run_request(options_, request, line, connected() ? &*client_ : nullptr);
  }

  Options options_;
  const char* clear_{::isatty(STDOUT_FILENO) != 0 ? "\r\x1b[K" : ""};  ///< Erases the typed line.
  std::optional<client::Connection> client_{};
  std::vector<std::string> robots_{};
  int code_{kExitDone};
  bool printed_{false};
};

// The callbacks of libedit have no context argument.
Prompt* current = nullptr;
std::optional<std::string> typed;
bool at_end = false;
std::vector<std::string> matches;

char* next_match(const char*, int state) {
  const auto index = static_cast<std::size_t>(state);
  return index < matches.size() ? ::strdup(matches[index].c_str()) : nullptr;
}

char** complete(const char* text, int start, int) {
  const std::string before(rl_line_buffer, static_cast<std::size_t>(start));
  auto words = command::split_words(before);
  rl_attempted_completion_over = 1;
  matches.clear();
  if (!words) return nullptr;
  words->push_back(text);
  for (const std::string& word : candidates(*words, current->robots()))
    if (word.starts_with(text) && (words->size() > 1 || !word.starts_with("--"))) matches.push_back(word);
  return matches.empty() ? nullptr : rl_completion_matches(text, next_match);
}

void on_line(char* line) {
  if (line == nullptr) {
    at_end = true;
    return;
  }
  typed = line;
  std::free(line);
}

int read_terminal(Prompt& prompt, const Options& options) {
  const std::string sign = options.name + "> ";
  current = &prompt;
  rl_readline_name = "basestation";
  rl_attempted_completion_function = complete;
  using_history();
  stifle_history(500);
  auto state = client::state_folder();
  const std::string history = state ? *state + "/" + options.name + ".history" : "";
  if (!history.empty()) read_history(history.c_str());
  std::printf("commands: help; leave: Ctrl-D (the station stays, down ends it)\n");
  bool going = true;
  while (going && !at_end) {
    typed.reset();
    rl_callback_handler_install(sign.c_str(), on_line);
    while (!typed && !at_end) {
      if (prompt.poll_notices(500, STDIN_FILENO)) rl_forced_update_display();
      std::fflush(stdout);
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (::poll(&input, 1, 0) > 0) rl_callback_read_char();
      if (interrupted() && !typed) {
        std::printf("\n");
        typed = "";
      }
    }
    rl_callback_handler_remove();
    if (!typed || typed->empty()) continue;
    add_history(typed->c_str());
    going = prompt.execute(*typed);
    catch_interrupts();  // libedit installs its own handlers.
  }
  if (!history.empty()) write_history(history.c_str());
  if (at_end) std::printf("\n");
  return kExitDone;
}

}  // namespace

int prompt(const Options& options) {
  Prompt prompt(options);
  if (auto connected = prompt.connect(); !connected)
    return fail(options, exit_without_station(connected.error()), connected.error());
  if (::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0) return read_terminal(prompt, options);
  std::string line;
  while (!interrupted() && std::getline(std::cin, line))
    if (!prompt.execute(line)) break;
  return prompt.code();
}

}  // namespace adit::station::cli
