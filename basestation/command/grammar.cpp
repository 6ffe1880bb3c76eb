#include "basestation/command/grammar.hpp"

#include <algorithm>
#include <array>

namespace adit::station {
namespace {

constexpr std::array table{
    CommandInfo{Verb::up, "up", "", "start this operator's station and leave it running", "up", -1, 0},
    CommandInfo{Verb::down, "down", "", "release what the station holds and end it", "down", -1, 0},
    CommandInfo{Verb::list, "list", "", "robots and stations, one line each", "list", -1, 0},
    CommandInfo{Verb::status, "status", "[R]", "all that is known of a robot, or of the station", "status r1",
                0, 1},
    CommandInfo{Verb::watch, "watch", "", "live dashboard that also takes keys (? shows them)", "watch", -1,
                0},
    CommandInfo{Verb::net, "net", "", "bytes a second per agent and topic, discovery apart", "net", -1, 0},
    CommandInfo{Verb::health, "health", "[R]", "components of a robot, or of all", "health r1", 0, 1},
    CommandInfo{Verb::findings, "findings", "[R...]", "what robots found, most important first",
                "findings r1", 0, 0},
    CommandInfo{Verb::actions, "actions", "R...", "which commands are valid now, and why the others are not",
                "actions r1 r2", 1, 0},
    CommandInfo{Verb::run, "run", "FILE [--all]",
                "play the script of a scenario live: this operator's lines, or all with --all",
                "run demo.yaml", -1, 0},
    CommandInfo{Verb::take, "take", "R...", "become the holder of robots", "take r1 r2", 1, 0},
    CommandInfo{Verb::release, "release", "R...", "give robots up; ends the lock", "release r1", 1, 0},
    CommandInfo{Verb::lock, "lock", "R...", "nobody may take the robot while you are heard", "lock r1", 1, 0},
    CommandInfo{Verb::unlock, "unlock", "R...", "whoever asks may take the robot", "unlock r1", 1, 0},
    CommandInfo{Verb::grant, "grant", "R OPERATOR", "hand a robot over to another operator", "grant r1 op2",
                1, 1},
    CommandInfo{Verb::mode, "mode", "R... MODE",
                "ask for a mode: hold, manual, smart_joystick, waypoint, explore or external", "mode r1 hold",
                1, 0},
    CommandInfo{Verb::drive, "drive", "R VX VY WZ [--for SECONDS]",
                "drive with m/s, m/s and rad/s for a time (1 s), then let go", "drive r1 0.5 0 -0.2 --for 3",
                1, 1},
    CommandInfo{Verb::go_to, "goto", "R X Y [Z] [--wait]",
                "go to a point of the map, m; with --wait return on arrival", "goto r1 12 0.5 --wait", 1, 1},
    CommandInfo{Verb::plan, "plan", "R X Y [Z]",
                "ask the robot's global planner for the way to a point, m; moves nothing", "plan r1 12 0.5",
                1, 1},
    CommandInfo{Verb::teleop, "teleop", "R", "drive by keyboard or game controller", "teleop r1", 1, 1},
    CommandInfo{Verb::stop, "stop", "R...|all", "software stop: needs no authority, latches until reset",
                "stop all", 1, 0},
    CommandInfo{Verb::reset, "reset", "R... [--override]",
                "clear your stop, with --override those of others; moves nothing", "reset r1", 1, 0},
    CommandInfo{Verb::restart, "restart", "R COMPONENT",
                "make a component anew, or the whole agent (health lists them)", "restart r1 planner", 1, 1},
    CommandInfo{Verb::policy, "policy", "R COMPONENT auto|manual",
                "who restarts a component that failed: the robot, or you", "policy r1 planner manual", 1, 1},
};

}  // namespace

std::span<const CommandInfo> commands() { return table; }

const CommandInfo& info(Verb verb) {
  for (const CommandInfo& row : table)
    if (row.verb == verb) return row;
  return table.front();  // not reached: every verb has its row, which a test checks
}

const CommandInfo* find_command(std::string_view name) {
  for (const CommandInfo& row : table)
    if (row.name == name) return &row;
  return nullptr;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const CommandInfo& row : table) names.emplace_back(row.name);
  return names;
}

const std::vector<std::string>& mode_names() {
  static const std::vector<std::string> names{"hold",     "manual",  "smart_joystick",
                                              "waypoint", "explore", "external"};
  return names;
}

std::string help(const CommandInfo& command) {
  std::string out = "usage: basestation " + std::string(command.name);
  if (!command.usage.empty()) out += " " + std::string(command.usage);
  out += "\n\n  " + std::string(command.summary);
  out += "\n\nexample: basestation " + std::string(command.example) + "\n";
  return out;
}

std::string help_all() {
  std::string out;
  for (const CommandInfo& row : table) {
    std::string left = std::string(row.name) + (row.usage.empty() ? "" : " ") + std::string(row.usage);
    left.resize(std::max<std::size_t>(left.size() + 2, 30), ' ');
    out += "  " + left + std::string(row.summary) + "\n";
  }
  return out;
}

}  // namespace adit::station
