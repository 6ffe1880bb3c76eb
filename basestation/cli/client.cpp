// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/client.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "basestation/cli/interrupt.hpp"
#include "core/command/parse.hpp"
#include "core/command/words.hpp"

namespace adit::station::cli {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

void Client::send(const json& object) {
  if (connected_ && can_send_) can_send_ = socket_.send(object);
}

std::int64_t Client::execute(const std::string& line) {
  send({{"id", next_}, {"do", with_absolute_files(line)}});
  return next_++;
}

std::int64_t Client::teleop(const std::string& robot) {
  send({{"id", next_}, {"teleop", robot}});
  return next_++;
}

void Client::stick(std::int64_t id, double vx, double vy, double wz) {
  send({{"id", id}, {"stick", {vx, vy, wz}}});
}

void Client::cancel(std::int64_t id) { send({{"cancel", id}}); }

void Client::handle(const std::string& line) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object()) return;  // A message of a station of another version is ignored.
  if (object.contains("snapshot") && on_snapshot) on_snapshot(object["snapshot"]);
  if (object.contains("notice") && on_notice) on_notice(object["notice"]);
  if (object.contains("missed") && on_missed) on_missed(object.value("missed", std::size_t{0}));
  if (object.contains("cut_off")) cut_off_ = object.value("cut_off", std::string());
  if (object.contains("event")) {
    if (object["event"] == "command" && on_command) on_command(object);
    return;
  }
  if (!object.contains("id")) return;
  const auto id = object.value("id", std::int64_t{0});
  if (object.contains("begun") && on_begun) on_begun(id);
  if (object.contains("outcome") && on_outcome) on_outcome(id, object["outcome"]);
}

std::string Client::gone() const {
  return cut_off_.empty() ? "the station ended before it answered"
                          : "the station ended the connection: " + cut_off_;
}

bool Client::wait(int timeout_ms, int other_fd) {
  if (!connected_) return false;
  pollfd fds[2] = {{socket_.fd(), static_cast<short>(POLLIN | (socket_.has_backlog() ? POLLOUT : 0)), 0},
                   {other_fd, POLLIN, 0}};
  const bool ready =
      ::poll(fds, other_fd >= 0 ? 2 : 1, can_send_ ? timeout_ms : 0) > 0 && fds[0].revents != 0;
  if (can_send_ && !ready) return true;
  can_send_ = can_send_ && socket_.flush();
  // Reads after the last send: if that failed, the station may have written the reason.
  const bool open = socket_.pump() && can_send_;
  for (auto line = socket_.line(); line; line = socket_.line()) handle(*line);
  connected_ = connected_ && open;
  return connected_;
}

int print_outcome(const Options& options, const json& outcome) {
  if (options.json) {
    std::printf("%s\n", outcome.value("json", json::object()).dump().c_str());
  } else {
    std::fputs(outcome.value("text", std::string()).c_str(), stdout);
    std::fflush(stdout);
    std::fputs(outcome.value("error", std::string()).c_str(), stderr);
  }
  return outcome.value("exit", kExitRefused);
}

int fail(const Options& options, int exit_code, const Error& error) {
  if (options.json)
    std::printf(
        "%s\n",
        json{{"exit", exit_code}, {"ok", false}, {"reason", name(error.reason)}, {"error", error.text}}
            .dump(-1, ' ', true, json::error_handler_t::replace)
            .c_str());
  else
    std::fprintf(stderr, "basestation: %s\n", error.text.c_str());
  return exit_code;
}

int run_line(Client& client, const Options& options, const std::string& line) {
  std::optional<json> outcome;
  bool begun = false;
  client.on_begun = [&](std::int64_t) { begun = true; };
  client.on_outcome = [&](std::int64_t, const json& object) { outcome = object; };
  const std::int64_t id = client.execute(line);
  const auto started = Clock::now();
  std::optional<Clock::time_point> cancelled;
  while (!outcome) {
    if (!client.wait(200) && !outcome)
      return fail(options, kExitNoAnswer, {Reason::no_answer, client.gone()});
    const auto now = Clock::now();
    if (!begun && !outcome && now - started > std::chrono::seconds(5))
      return fail(
          options, kExitNoAnswer,
          {Reason::no_answer, "the station of " + options.name + " does not answer; end its process"});
    if (interrupted()) {
      if (cancelled) return 130;
      cancelled = now;
      client.cancel(id);
    }
    // A command that cannot be cancelled any more is left to the station.
    if (cancelled && now - *cancelled > std::chrono::milliseconds(800)) return 130;
  }
  const int code = print_outcome(options, *outcome);
  return cancelled ? 130 : code;
}

std::string command_of_another(const json& event) {
  if (event.value("mine", true) || event.value("query", true) ||
      event.value("phase", std::string()) != "ended")
    return {};
  const json by = event.value("by", json::object());
  if (by.value("pid", 0) == ::getpid()) return {};  // A stop uses a connection of its own.
  std::string answer = event.value("text", std::string()) + event.value("error", std::string());
  while (answer.ends_with('\n')) answer.pop_back();
  std::replace(answer.begin(), answer.end(), '\n', ' ');
  return "in another " + by.value("front_end", std::string("program")) + ": " +
         event.value("line", std::string()) + " -> " + answer;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
             std::string_view("_-+./:").find(c) != std::string_view::npos;
    });
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::string with_absolute_files(const std::string& line) {
  const auto request = command::parse(line);
  auto words = command::split_words(line);
  if (!request || !words || request->word("FILE").empty()) return line;
  const auto file = std::find(words->begin() + 1, words->end(), request->word("FILE"));
  std::error_code failed;
  const auto absolute = std::filesystem::absolute(*file, failed).lexically_normal();
  if (failed) return line;
  *file = absolute.string();
  return quoted(*words);
}

}  // namespace adit::station::cli
