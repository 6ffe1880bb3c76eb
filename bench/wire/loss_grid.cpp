// SPDX-License-Identifier: Apache-2.0
// What a link leaves of commands, joystick and state while bulk and video fill it: delivered share and
// latency.
//   loss_grid [--live] [--commands N] [--loss L --kbit B --latency MS]
// Without a cell all 40 of the grid, in rehearsal; live takes as long as the clock does.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>

#include "bench/wire/load.hpp"
#include "bench/wire/watched_net.hpp"
#include "tests/live/driver.hpp"

namespace adit::bench {
namespace {

struct Cell {
  double loss{}, kbit{}, latency{};
};

struct Options {
  bool live{};
  int commands{40};
  std::vector<Cell> cells{};
};

std::string name_of(const std::string& topic, std::span<const std::uint8_t> cdr) {
  radio::Command command;
  if (topic != wire::topics::kCommand.name || !wire::decode(cdr, command)) return topic;
  switch (command.kind()) {
    case radio::CMD_STOP:
      return "stop";
    case radio::CMD_TAKE:
      return "take";
    case radio::CMD_GOTO:
      return "goto";
    default:
      return "other";
  }
}

std::string share_and_times(const Passages::Row& row) {
  auto took = row.took;
  std::sort(took.begin(), took.end());
  const auto at = [&](double q) {
    return took.empty() ? 0.0 : took[static_cast<std::size_t>(q * static_cast<double>(took.size() - 1))];
  };
  char text[64];
  std::snprintf(
      text, sizeof text, "%5.1f %5.0f %5.0f",
      row.written == 0 ? 0.0 : 100.0 * static_cast<double>(row.arrived) / static_cast<double>(row.written),
      at(0.5) * 1e3, at(0.99) * 1e3);
  return text;
}

/// What was asked for, what was answered, and what the robot did.
struct Asked {
  int asked{}, answered{}, gotos{}, takes_and_releases{}, unanswered_changes{};
};

void ask(live::Operator& op, const std::string& line, Asked& asked) {
  const auto outcome = op.ask(line);
  const auto result = outcome.json.contains("results") ? outcome.json.at("results").at(0) : outcome.json;
  const bool accepted = result.value("accepted", outcome.exit_code == 0);
  const bool changes = line.starts_with("goto") || line.starts_with("take") || line.starts_with("release");
  ++asked.asked;
  if (outcome.exit_code != 3) ++asked.answered;
  if (outcome.exit_code == 3 && changes) ++asked.unanswered_changes;
  if (!accepted) return;
  if (line.starts_with("goto"))
    ++asked.gotos;
  else if (changes)
    ++asked.takes_and_releases;
}

void run(const Cell& cell, const Options& options) {
  wire::LinkProfile link;
  link.bandwidth = cell.kbit * 1e3;
  link.latency = cell.latency * 1e-3;
  link.loss = cell.loss / 100.0;
  Passages passages(name_of);
  WatchedNet net(options.live ? live::make_live_net(link) : live::make_rehearsal_net(link), passages);
  agent::AgentParams params{};
  params.name = "r1";
  live::Robot robot(net, params);
  live::PlainDriver driver(net);
  live::Operator op(net, "op1");
  Asked warm, asked;
  for (int i = 0; i < 60 && warm.answered == 0; ++i) {
    net.pass(1s);
    ask(op, "stop r1", warm);
  }
  ask(op, "take r1", warm);
  ask(op, "reset r1", warm);
  ask(op, "goto r1 5 0", warm);
  ask(op, "release r1", warm);
  net.pass(5s);
  const auto before = op.view("r1");

  const auto strand = net.machine("load").strand("load");
  std::unique_ptr<Load> up, down;
  Timer sticks;
  auto stick = wire::Writer<radio::Joystick>::make(op.radio(), wire::topics::kJoystick, "r1").value();
  radio::Joystick sample;
  sample.robot("r1");
  net.on(*strand, [&] {
    up = std::make_unique<Load>(robot.radio(), *strand, link, 1);
    down = std::make_unique<Load>(op.radio(), *strand, link, 2);
    sticks = strand->every(50ms, [&] {
      sample.seq(sample.seq() + 1);
      (void)stick.write(sample);  // the sender holds no robot: it is heard and refused
    });
  });
  net.pass(5s);
  passages.count(true);
  for (int i = 0; i < options.commands; ++i) {
    ask(op, "take r1", asked);
    ask(op, "goto r1 5 0", asked);
    ask(op, "stop r1", asked);
    ask(op, "reset r1", asked);
    ask(op, "release r1", asked);
    net.pass(1s);  // an operator's typing speed; leaves time for the effects
  }
  passages.count(false);
  net.on(*strand, [&] {
    sticks.cancel();
    up.reset(), down.reset();
  });
  net.pass(10s);
  const auto after = op.view("r1");
  const int done = static_cast<int>(after.goal_id - before.goal_id) +
                   static_cast<int>(after.epoch.counter - before.epoch.counter);
  const int accepted = asked.gotos + asked.takes_and_releases;
  const bool once = accepted <= done && done <= accepted + asked.unanswered_changes;
  auto rows = passages.rows();
  std::printf("| %2.0f | %4.0f | %3.0f | %5.1f | %s |", cell.loss, cell.kbit, cell.latency,
              100.0 * asked.answered / asked.asked, once ? "yes" : "NO");
  for (const char* name : {"stop", "take", "goto", "adit/joystick", "adit/robot_state", "adit/load_bulk"})
    std::printf(" %s |", share_and_times(rows[name]).c_str());
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit::bench;
  Options options;
  Cell cell{.loss = -1, .kbit = 100, .latency = 10};
  CLI::App app{"Delivered share and latency on a full link.", "loss_grid"};
  app.add_flag("--live", options.live, "over Fast DDS on loopback instead of the rehearsal's radio");
  app.add_option("--commands", options.commands, "of each kind and cell")->check(CLI::Range(1, 10000));
  app.add_option("--loss", cell.loss, "one cell alone: frames lost, percent");
  app.add_option("--kbit", cell.kbit, "kbit/s");
  app.add_option("--latency", cell.latency, "one way, ms");
  CLI11_PARSE(app, argc, argv);
  if (cell.loss >= 0) {
    options.cells.push_back(cell);
  } else {
    for (const double loss : {0, 5, 10, 20, 40})
      for (const double kbit : {100, 250, 500, 1000})
        for (const double latency : {10, 200}) options.cells.push_back({loss, kbit, latency});
  }
  std::printf(
      "%s, %d commands of each kind a cell. Of each kind: %% that arrived, median, p99 ms one way\n\n",
      options.live ? "Live" : "In rehearsal", options.commands);
  std::printf(
      "| loss %% | kbit/s | ms | answered %% | once | stop | take | goto | joystick | state | bulk |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Cell& each : options.cells) run(each, options);
}
