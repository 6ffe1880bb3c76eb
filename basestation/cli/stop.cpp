// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/commands.hpp"

#include <chrono>
#include <cstdio>

#include "basestation/cli/run_line.hpp"
#include "basestation/client/stop.hpp"
#include "basestation/host/live_station.hpp"
#include "basestation/model/json.hpp"

namespace adit::station::cli {

using namespace std::chrono_literals;

int stop(const Options& options, const command::Request& request, const std::string& line) {
  if (!options.alone)
    if (const auto outcome = client::stop_by_station(options, "shell", line))
      return print_outcome(options, *outcome);
  std::fprintf(stderr, "no answer from the station of %s: the stop goes out by itself\n",
               options.name.c_str());
  // The presence period is short, because robots must know this participant before they accept its identity.
  // A stop to a named robot is repeated for 10 s, whether it is heard or not; `all` are the robots heard
  // within 5 s.
  auto live = host::LiveStation::open(
      options, {.presence = 100ms, .discovery_grace = request.all ? 5s : 10s, .content = false});
  if (!live) return fail(options, kExitNoAnswer, live.error());
  const Outcome outcome = (*live)->execute(request, 25s);
  if (outcome.exit_code == kExitNoAnswer)
    std::fprintf(stderr, "this program ends: the stop no longer goes out\n");
  return print_outcome(
      options,
      outcome_from(outcome_json(outcome.exit_code, outcome.text, outcome.error, outcome.json)).value());
}

}  // namespace adit::station::cli
