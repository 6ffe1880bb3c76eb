// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/stop.hpp"

#include <chrono>
#include <cstdio>
#include <optional>

#include "basestation/cli/client.hpp"
#include "basestation/cli/process/launch.hpp"
#include "basestation/cli/process/live_station.hpp"

namespace adit::station::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Returns the outcome if the station accepted the stop in time. The outcome of a command that was not begun
/// does not count: the station refused the line and sends no stop.
std::optional<nlohmann::json> ask_station(const Options& options, const std::string& line) {
  auto path = socket_path(options);
  if (!path) return std::nullopt;
  auto socket = LineSocket::connect(*path);
  if (!socket) return std::nullopt;
  Client client(std::move(*socket), "shell");
  bool begun = false;
  std::optional<nlohmann::json> outcome;
  client.on_begun = [&](std::int64_t) { begun = true; };
  client.on_outcome = [&](std::int64_t, const nlohmann::json& object) { outcome = object; };
  client.execute(line);
  const auto started = Clock::now();
  while (!outcome) {
    const Duration limit = begun ? Duration(20s) : Duration(300ms);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(limit - (Clock::now() - started));
    if (left <= 0ms || !client.wait(static_cast<int>(left.count()))) break;
  }
  return begun ? outcome : std::nullopt;
}

}  // namespace

int stop(const Options& options, const std::string& line, bool all) {
  if (const auto outcome = ask_station(options, line)) return print_outcome(options, *outcome);
  std::fprintf(stderr, "no answer from the station of %s: the stop goes out by itself\n",
               options.name.c_str());
  // The presence period is short, because robots must know this participant before they accept its identity.
  // A stop to a named robot is repeated for 10 s, whether it is heard or not; `all` are the robots heard
  // within 5 s.
  auto live = LiveStation::open(options, {.presence = 100ms, .discovery_grace = all ? 5s : 10s});
  if (!live) return fail(options, kExitNoAnswer, live.error());
  const Outcome outcome = (*live)->execute(line, 25s);
  if (outcome.exit_code == kExitNoAnswer)
    std::fprintf(stderr, "this program ends: the stop no longer goes out\n");
  return print_outcome(options, {{"exit", outcome.exit_code},
                                 {"text", outcome.text},
                                 {"error", outcome.error},
                                 {"json", outcome.json}});
}

}  // namespace adit::station::cli
