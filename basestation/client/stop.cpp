// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/stop.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <optional>

#include "basestation/client/connection.hpp"
#include "basestation/client/launch.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/model/outcome.hpp"
#include "core/command/words.hpp"

extern char** environ;

namespace adit::station::client {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kBegins = 300ms;  // Longer, and the station counts as silent.
constexpr auto kEnds = 20s;
constexpr std::size_t kMaxText = 64 << 10;

CommandOutcome failed(const std::string& text) { return {.exit_code = kExitNoAnswer, .error = text + "\n"}; }

CommandOutcome by_program(const StationOptions& options, const std::string& line) {
  const auto typed = command::split_words(line);
  if (!typed) return failed(typed.error().text);
  std::vector<std::string> words = program_words(options);
  words.push_back("--alone");
  words.insert(words.end(), typed->begin(), typed->end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return failed(std::string("no pipe: ") + std::strerror(errno));
  File reading(ends[0]), writing(ends[1]);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, writing.get(), 1);
  ::posix_spawn_file_actions_adddup2(&actions, writing.get(), 2);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  writing.reset();
  if (error != 0) return failed("cannot start " + options.program + ": " + std::strerror(error));
  std::string text;
  char buffer[1024];
  for (ssize_t size; (size = ::read(reading.get(), buffer, sizeof buffer)) != 0;) {
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) break;
    if (text.size() < kMaxText) text.append(buffer, static_cast<std::size_t>(size));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  CommandOutcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kExitNoAnswer;
  (outcome.exit_code == kExitDone ? outcome.text : outcome.error) = std::move(text);
  return outcome;
}

}  // namespace

std::optional<CommandOutcome> stop_by_station(const StationOptions& options, const std::string& front_end,
                                              const std::string& line) {
  const auto path = socket_path(options.name);
  if (!path) return std::nullopt;
  auto socket = LineSocket::connect(*path);
  if (!socket) return std::nullopt;
  Connection connection(std::move(*socket), front_end);
  bool begun = false;
  std::optional<CommandOutcome> outcome;
  connection.on_begun = [&](std::int64_t) { begun = true; };
  connection.on_outcome = [&](std::int64_t, const CommandOutcome& ended) { outcome = ended; };
  connection.execute(line);
  const auto started = Clock::now();
  while (!outcome) {
    const auto limit = begun ? Clock::duration(kEnds) : Clock::duration(kBegins);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(started + limit - Clock::now());
    if (left <= 0ms || !connection.wait(static_cast<int>(left.count()))) break;
  }
  // An outcome without a begin: the station refused the line, and sends no stop.
  return begun ? outcome : std::nullopt;
}

CommandOutcome run_stop(const StationOptions& options, const std::string& front_end,
                        const std::string& line) {
  if (auto outcome = stop_by_station(options, front_end, line)) return *outcome;
  return by_program(options, line);
}

}  // namespace adit::station::client
