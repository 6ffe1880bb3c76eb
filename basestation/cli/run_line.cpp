// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/run_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include "basestation/cli/commands.hpp"
#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/script.hpp"
#include "basestation/client/launch.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/model/json.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station::cli {

using Clock = std::chrono::steady_clock;

Result<client::LineSocket> connect(const Options& options) {
  auto connected = client::connect_or_launch(options);
  if (!connected) return connected.error();
  if (!connected->remark.empty()) std::fprintf(stderr, "%s\n", connected->remark.c_str());
  return std::move(connected->socket);
}

int exit_without_station(const Error& error) {
  if (error.reason == Reason::no_answer) return kExitNoAnswer;
  return error.reason == Reason::bad_argument ? kExitUsage : kExitRefused;
}

int print_outcome(const Options& options, const CommandOutcome& outcome) {
  if (options.json) {
    std::printf("%s\n", outcome.json.c_str());
  } else {
    std::fputs(outcome.text.c_str(), stdout);
    std::fflush(stdout);
    std::fputs(outcome.error.c_str(), stderr);
  }
  return outcome.exit_code;
}

int fail(const Options& options, int exit_code, const Error& error) {
  if (options.json)
    std::printf(
        "%s\n",
        line_of({{"exit", exit_code}, {"ok", false}, {"reason", name(error.reason)}, {"error", error.text}})
            .c_str());
  else
    std::fprintf(stderr, "basestation: %s\n", error.text.c_str());
  return exit_code;
}

int run_line(client::Connection& client, const Options& options, const std::string& line) {
  std::optional<CommandOutcome> outcome;
  bool begun = false;
  client.on_begun = [&](std::int64_t) { begun = true; };
  client.on_outcome = [&](std::int64_t, const CommandOutcome& ended) { outcome = ended; };
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

int run_request(const Options& options, const command::Request& request, const std::string& line,
                client::Connection* shared) {
  using command::verb;
  if (request.verb == verb("stop")) return stop(options, request, line);
  if (request.verb == verb("run")) {
    auto script = read_script(request.word("FILE"));  // It is read before anything starts.
    if (!script) return fail(options, kExitUsage, script.error());
    return play(options, *script, request.has("--all"));
  }
  const bool terminal = request.info->runs == command::Runs::terminal;
  if (shared != nullptr && !terminal) return run_line(*shared, options, line);
  if (request.verb == verb("down")) {
    const auto path = client::socket_path(options.name);
    if (!path) return fail(options, kExitRefused, path.error());
    auto running = client::LineSocket::connect(*path);
    if (!running) {
      std::printf("%s", options.json ? "{\"command\":\"down\",\"exit\":0,\"ok\":true,\"results\":[]}\n"
                                     : ("no station of " + options.name + " is running\n").c_str());
      return kExitDone;
    }
    client::Connection client(std::move(*running), "shell");
    return run_line(client, options, line);
  }
  auto socket = connect(options);
  if (!socket) return fail(options, exit_without_station(socket.error()), socket.error());
  client::Connection client(std::move(*socket), terminal ? std::string(request.info->name) : "shell");
  if (request.verb == verb("watch")) return watch(client, options);
  if (request.verb == verb("teleop")) return teleop(client, options, request.robots.front());
  return run_line(client, options, line);
}

std::string command_of_another(const CommandEvent& event) {
  if (event.mine || event.query || !event.ended) return {};
  if (event.pid == ::getpid()) return {};  // A stop uses a connection of its own.
  std::string answer = event.text + event.error;
  while (answer.ends_with('\n')) answer.pop_back();
  std::replace(answer.begin(), answer.end(), '\n', ' ');
  return "in another " + (event.front_end.empty() ? "program" : event.front_end) + ": " + event.line +
         " -> " + answer;
}

}  // namespace adit::station::cli
