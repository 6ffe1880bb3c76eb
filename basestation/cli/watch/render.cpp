// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/watch/render.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basestation/model/action.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/report/table.hpp"
#include "core/command/words.hpp"

namespace adit::station::cli {
namespace {

/// A text in one line with its colour; colours are applied after clipping, so that no escape sequence is cut.
struct Cell {
  std::string text{};
  const char* colour{""};
};
constexpr const char* kRed = "31";
constexpr const char* kGreen = "32";
constexpr const char* kYellow = "33";
constexpr const char* kCyan = "36";
constexpr const char* kBold = "1";
constexpr const char* kDim = "2";
constexpr const char* kReverse = "7";

class Page {
 public:
  Page(int rows, int columns, bool colour)
      : rows_(static_cast<std::size_t>(rows)), columns_(static_cast<std::size_t>(columns)), colour_(colour) {}

  /// Adds a line. `background`: a colour for the complete line, including blanks up to the edge.
  void line(const std::vector<Cell>& cells, const char* background = "") {
    if (lines_.size() == rows_) return;
    std::string out;
    std::size_t used = 0;
    if (colour_ && *background != 0) out += sequence(background);
    for (const Cell& cell : cells) {
      const std::string text = cell.text.substr(0, columns_ - used);
      used += text.size();
      const bool own = colour_ && *cell.colour != 0 && *background == 0 && !text.empty();
      out += own ? sequence(cell.colour) + text + "\x1b[0m" : text;
    }
    if (*background != 0) out += std::string(columns_ - used, ' ');
    if (colour_ && *background != 0) out += "\x1b[0m";
    lines_.push_back(out);
  }
  /// Permits `more` further lines.
  void allow(std::size_t more) { rows_ += more; }
  std::size_t left() const { return rows_ - lines_.size(); }
  std::size_t columns() const { return columns_; }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  static std::string sequence(const char* code) { return std::string("\x1b[") + code + "m"; }
  std::size_t rows_, columns_;
  bool colour_;
  std::vector<std::string> lines_{};
};

std::string padded(std::string value, std::size_t width, bool right = false) {
  if (value.size() > width) value.resize(width);
  const std::string space(width - value.size(), ' ');
  return (right ? space + value : value + space) + " ";
}

std::string rate(double bytes) {
  if (!std::isfinite(bytes)) return "-";
  return bytes < 10000.0 ? fixed(bytes, 0) : fixed(bytes / 1000.0, 0) + "k";
}

Cell mode_cell(const Robot& robot, std::size_t width) {
  const std::string& mode = robot.mode;
  if (robot.stopped) return {padded("STOP " + mode, width), kRed};
  const bool waits = mode != "hold" && !robot.moving_allowed && robot.reason != Reason::none;
  if (waits) return {padded(mode + "!", width), kYellow};
  return {padded(mode.empty() ? "?" : mode, width), mode == "hold" ? "" : kGreen};
}

Cell holder_cell(const Robot& robot, std::size_t width) {
  const std::string& holder = robot.holder;
  const char* colour = robot.mine ? kGreen : holder.empty() ? kDim : "";
  const std::string lock = robot.locked ? "#" : "";
  return {padded(holder.empty() ? "-" : holder.substr(0, width - lock.size()) + lock, width), colour};
}

Cell goal_cell(const Robot& robot, std::size_t width) {
  const GoalState phase = robot.goal_state;
  if (phase == GoalState::none) return {padded("-", width), kDim};
  const std::string where = fixed(robot.goal[0], 1) + "," + fixed(robot.goal[1], 1);
  const char* colour = phase == GoalState::blocked ? kRed : phase == GoalState::reached ? kGreen : "";
  const std::string shown(phase == GoalState::active    ? "to"
                          : phase == GoalState::reached ? "at"
                                                        : to_string(phase));
  return {padded(shown + " " + where, width), colour};
}

Cell age_cell(const Robot& robot) {
  const double age = robot.age;
  if (robot.lost) return {padded("LOST", 5, true), kRed};
  return {padded(fixed(age, 1) + "s", 5, true), age > 1.0 ? kYellow : ""};
}

void robots(Page& page, const World& world, const WatchState& state) {
  const std::size_t spare = page.columns() > 80 ? std::min<std::size_t>(page.columns() - 80, 32) : 0;
  const std::size_t mode_width = 9 + std::min<std::size_t>(spare, 8);
  const std::size_t name_width = 6 + (spare > 8 ? std::min<std::size_t>(spare - 8, 8) : 0);
  const std::size_t holder_width = 6 + (spare > 16 ? std::min<std::size_t>(spare - 16, 8) : 0);
  const std::size_t goal_width = 14 + (spare > 24 ? spare - 24 : 0);
  page.line({{padded("  ", 3) + padded("ROBOT", name_width) + padded("KIND", 7) + padded("MODE", mode_width) +
              padded("HOLDER", holder_width) + padded("X", 6, true) + padded("Y", 6, true) +
              padded("YAW", 4, true) + padded("M/S", 4, true) + padded("GOAL", goal_width) +
              padded("AGE", 5, true) + (spare > 6 ? padded("B/S", 6, true) : "")}},
            kBold);
  const std::vector<Robot>& list = world.robots;
  const std::vector<int> numbers = numbers_of(world);
  // Keeps the selected robot in view.
  const std::size_t room = page.left() > 8 ? page.left() - 8 : 1;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == state.selected) chosen = i;
  const std::size_t first = chosen >= room ? chosen - room + 1 : 0;
  for (std::size_t i = first; i < list.size() && i < first + room; ++i) {
    const Robot& robot = list[i];
    const bool selected = robot.name == state.selected;
    const double nan = std::nan("");
    const double x = robot.located ? robot.x : nan, y = robot.located ? robot.y : nan;
    const double speed = robot.located ? std::hypot(robot.vx, robot.vy) : nan;
    const double yaw = robot.located ? robot.yaw * 180.0 / std::numbers::pi : nan;
    std::vector<Cell> cells{{selected ? "> " : "  "},
                            {numbers[i] <= 9 ? std::to_string(numbers[i]) + " " : "  ", kDim},
                            {padded(robot.name, name_width), selected ? kBold : ""},
                            {padded(robot.platform, 7), ""},
                            mode_cell(robot, mode_width),
                            holder_cell(robot, holder_width),
                            {padded(fixed(x, 1), 6, true)},
                            {padded(fixed(y, 1), 6, true)},
                            {padded(fixed(yaw, 0), 4, true)},
                            {padded(fixed(speed, 1), 4, true)},
                            goal_cell(robot, goal_width),
                            age_cell(robot)};
    const auto traffic = world.traffic.find(robot.name);
    if (spare > 6)
      cells.push_back({padded(traffic != world.traffic.end() ? rate(traffic->second.out) : "-", 6, true)});
    page.line(cells, selected ? kReverse : "");
  }
  if (list.empty()) page.line({{"   no robot has been heard", kDim}});
}

/// Adds the detail line of the selected robot.
void detail(Page& page, const World& world, const WatchState& state) {
  const Robot* robot = world.robot(state.selected);
  if (!robot) return page.line({});
  std::vector<Cell> cells{{" " + state.selected + ": ", kBold}};
  if (!robot->stops.empty())
    cells.push_back({"stopped by " + command::joined(robot->stops, "") + "  ", kRed});
  std::string troubles;
  for (const std::string& trouble : robot->troubles) troubles += trouble + "  ";
  if (!troubles.empty()) cells.push_back({troubles, kRed});
  if (robot->reason != Reason::none && robot->stops.empty())
    cells.push_back({"does not move: " + std::string(name(robot->reason)) + "  ", kYellow});
  std::string areas;
  for (const Area& area : robot->areas)
    areas += (areas.empty() ? "" : ", ") + area.name + " " + std::string(name(area.kind));
  if (!areas.empty()) cells.push_back({"areas: " + areas + "  ", kCyan});
  if (const contract::Exploration& explored = robot->exploration; explored.phase != ExplorationPhase::none)
    cells.push_back({std::string(to_string(explored.phase)) + " about " + fixed(100.0 * explored.share, 0) +
                         "%, " + std::to_string(explored.open) + " frontiers left  ",
                     kCyan});
  if (robot->locked)
    cells.push_back({robot->lease_left >= 0.0F ? "locked, lapses in " + fixed(robot->lease_left, 0) + " s  "
                                               : "locked  "});
  std::string closed;
  for (const ModeOption& mode : robot->options)
    if (!can_enter(mode))
      closed += (closed.empty() ? "" : ", ") + mode.mode + " (" + std::string(name(mode.reason)) + ")";
  if (!closed.empty()) cells.push_back({"no " + closed, kDim});
  const bool no_goal = robot->goal_state == GoalState::none || robot->goal_state == GoalState::kept;
  if (const std::string motion = motion_text(*robot); !motion.empty() && no_goal)
    cells.insert(cells.begin() + 1, {motion + "  ", kGreen});
  if (cells.size() == 1) cells.push_back({"ready", kGreen});
  page.line(cells);
}

void notices(Page& page, const World& world, std::size_t room) {
  page.line({{" NOTIFICATIONS", kBold}});
  if (room < 2) return;
  std::size_t shown = 0;
  for (auto it = world.notices.rbegin(); it != world.notices.rend() && shown < room - 1; ++it, ++shown) {
    const char* colour = !it->mine                           ? kDim
                         : it->severity == Severity::error   ? kRed
                         : it->severity == Severity::warning ? kYellow
                                                             : "";
    const std::string line = " " + padded(short_age(it->age), 5, true) + padded(it->robot, 6);
    page.line({{line}, {it->text.empty() ? it->code : it->text, colour}});
  }
  if (world.notices.empty()) {
    page.line({{"   none yet", kDim}});
    ++shown;
  }
  for (; shown + 1 < room; ++shown) page.line({});
}

void help(Page& page) {
  static const std::vector<const char*> rows{
      "up down 1-9  select a robot           t  take     r  release   l  lock, unlock",
      "s  stop it      S  stop all           e  reset your stop  E  reset every stop",
      "h  hold         w  waypoint, go on    g  goto X Y         :  any command line",
      "m  drive it: arrows or wasd, q e sideways, space zero, + - speed, Esc quits",
      "?  this help                          Q or q  leave the dashboard",
  };
  page.line({{" KEYS", kBold}});
  for (const char* row : rows) page.line({{std::string("  ") + row}});
}

}  // namespace

std::vector<std::string> names_of(const World& world) {
  std::vector<std::string> names;
  for (const Robot& robot : world.robots) names.push_back(robot.name);
  return names;
}

std::vector<std::string> render(const World& world, const WatchState& state, int rows, int columns,
                                bool colour) {
  const int footer = std::min(rows, 2);  // Always visible: typed line or answer, and the keys.
  Page page(rows - footer, columns, colour);
  const Counts& counts = world.commands;
  std::string title = " ADIT  " + world.station +
                      (world.link.empty() ? "  no link profile" : "  link " + world.link) + "  commands " +
                      std::to_string(counts.accepted) + " done " + std::to_string(counts.refused) +
                      " refused " + std::to_string(counts.unanswered) + " unanswered";
  const FindingCounts& findings = world.findings;
  if (findings.listed > 0)
    title += "  findings " + std::to_string(findings.listed) + ", " + std::to_string(findings.open) + " new";
  std::string others;
  for (const StationSummary& station : world.stations)
    if (!station.self) others += (others.empty() ? "  with " : ", ") + station.name;
  page.line({{title + others}}, kReverse);
  if (state.silent)
    page.line({{" the station does not answer", kRed}});
  else
    page.line({});
  robots(page, world, state);
  page.line({});
  detail(page, world, state);
  page.line({});
  if (state.help) help(page);
  if (page.left() > 1) notices(page, world, page.left());
  while (page.left() > 0) page.line({});
  page.allow(static_cast<std::size_t>(footer));
  if (state.typing)
    page.line({{":" + state.line + "_", kBold}});
  else
    page.line({{" " + state.message, state.refused ? kRed : kCyan}});
  if (state.driving)
    page.line({{" DRIVING " + state.selected + "  " + state.driving_text + "  space zero  Esc quits"}},
              "30;43");
  else
    page.line({{" t take r release l lock s stop S all e reset h hold w go g goto m drive ? q"}}, kReverse);
  return page.take();
}

}  // namespace adit::station::cli
