// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/watch/render.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basestation/report/table.hpp"

namespace adit::station::cli {
namespace {

using nlohmann::json;

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

  /// Adds a line. `whole`: a colour for the complete line, including blanks up to the edge.
  void line(const std::vector<Cell>& cells, const char* whole = "") {
    if (lines_.size() == rows_) return;
    std::string out;
    std::size_t used = 0;
    if (colour_ && *whole != 0) out += sequence(whole);
    for (const Cell& cell : cells) {
      const std::string text = cell.text.substr(0, columns_ - used);
      used += text.size();
      const bool own = colour_ && *cell.colour != 0 && *whole == 0 && !text.empty();
      out += own ? sequence(cell.colour) + text + "\x1b[0m" : text;
    }
    if (*whole != 0) out += std::string(columns_ - used, ' ');
    if (colour_ && *whole != 0) out += "\x1b[0m";
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

double number(const json& object, const char* key, std::size_t index = 0) {
  const auto found = object.find(key);
  if (found == object.end()) return std::nan("");
  const json& value = found->is_array() ? (index < found->size() ? (*found)[index] : json()) : *found;
  return value.is_number() ? value.get<double>() : std::nan("");
}

std::string text(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

bool flag(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}

std::string padded(std::string value, std::size_t width, bool right = false) {
  if (value.size() > width) value.resize(width);
  const std::string space(width - value.size(), ' ');
  return (right ? space + value : value + space) + " ";
}

std::string rate(double bytes) {
  if (!std::isfinite(bytes)) return "-";
  return bytes < 10000.0 ? fixed(bytes, 0) : fixed(bytes / 1000.0, 0) + "k";
}

Cell mode_cell(const json& robot, std::size_t width) {
  const std::string mode = text(robot, "mode");
  const std::string reason = text(robot, "reason");
  if (flag(robot, "stopped")) return {padded("STOP " + mode, width), kRed};
  const bool waits = mode != "hold" && !flag(robot, "moving_allowed") && reason != "none" && !reason.empty();
  if (waits) return {padded(mode + "!", width), kYellow};
  return {padded(mode.empty() ? "?" : mode, width), mode == "hold" ? "" : kGreen};
}

Cell holder_cell(const json& robot, std::size_t width) {
  const std::string holder = text(robot, "holder");
  const char* colour = flag(robot, "mine") ? kGreen : holder.empty() ? kDim : "";
  const std::string lock = flag(robot, "locked") ? "#" : "";
  return {padded(holder.empty() ? "-" : holder.substr(0, width - lock.size()) + lock, width), colour};
}

Cell goal_cell(const json& robot, std::size_t width) {
  const std::string state = text(robot, "goal_state");
  if (state == "none" || state.empty()) return {padded("-", width), kDim};
  const std::string where = fixed(number(robot, "goal", 0), 1) + "," + fixed(number(robot, "goal", 1), 1);
  const char* colour = state == "blocked" ? kRed : state == "reached" ? kGreen : "";
  const std::string shown = state == "active" ? "to" : state == "reached" ? "at" : state;
  return {padded(shown + " " + where, width), colour};
}

Cell age_cell(const json& robot) {
  const double age = number(robot, "age");
  if (flag(robot, "lost")) return {padded("LOST", 5, true), kRed};
  return {padded(fixed(age, 1) + "s", 5, true), age > 1.0 ? kYellow : ""};
}

void robots(Page& page, const json& snapshot, const WatchState& state) {
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
  const json list = snapshot.value("robots", json::array());
  const json traffic = snapshot.value("traffic", json::object());
  // Keeps the selected robot in view.
  const std::size_t room = page.left() > 8 ? page.left() - 8 : 1;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (text(list[i], "robot") == state.selected) chosen = i;
  const std::size_t first = chosen >= room ? chosen - room + 1 : 0;
  for (std::size_t i = first; i < list.size() && i < first + room; ++i) {
    const json& robot = list[i];
    const std::string robot_name = text(robot, "robot");
    const bool selected = robot_name == state.selected;
    const double speed = std::hypot(number(robot, "velocity", 0), number(robot, "velocity", 1));
    const double yaw = number(robot, "pose", 3) * 180.0 / std::numbers::pi;
    std::vector<Cell> cells{{selected ? "> " : "  "},
                            {i < 9 ? std::to_string(i + 1) + " " : "  ", kDim},
                            {padded(robot_name, name_width), selected ? kBold : ""},
                            {padded(text(robot, "kind"), 7), ""},
                            mode_cell(robot, mode_width),
                            holder_cell(robot, holder_width),
                            {padded(fixed(number(robot, "pose", 0), 1), 6, true)},
                            {padded(fixed(number(robot, "pose", 1), 1), 6, true)},
                            {padded(fixed(yaw, 0), 4, true)},
                            {padded(fixed(speed, 1), 4, true)},
                            goal_cell(robot, goal_width),
                            age_cell(robot)};
    if (spare > 6)
      cells.push_back(
          {padded(traffic.contains(robot_name) ? rate(number(traffic[robot_name], "out")) : "-", 6, true)});
    page.line(cells, selected ? kReverse : "");
  }
  if (list.empty()) page.line({{"   no robot has been heard", kDim}});
}

/// Adds the detail lines of the selected robot.
void detail(Page& page, const json& snapshot, const WatchState& state) {
  for (const json& robot : snapshot.value("robots", json::array())) {
    if (text(robot, "robot") != state.selected) continue;
    std::vector<Cell> cells{{" " + state.selected + ": ", kBold}};
    const json stops = robot.value("stops", json::array());
    if (!stops.empty()) {
      std::string by;
      for (const json& stop : stops)
        by += (by.empty() ? "" : ", ") + (stop.is_string() ? stop.get<std::string>() : "");
      cells.push_back({"stopped by " + by + "  ", kRed});
    }
    std::string troubles;
    for (const json& trouble : robot.value("troubles", json::array()))
      if (trouble.is_string()) troubles += trouble.get<std::string>() + "  ";
    if (!troubles.empty()) cells.push_back({troubles, kRed});
    const std::string reason = text(robot, "reason");
    if (reason != "none" && !reason.empty() && stops.empty())
      cells.push_back({"does not move: " + reason + "  ", kYellow});
    std::string areas;
    for (const json& area : robot.value("areas", json::array()))
      areas += (areas.empty() ? "" : ", ") + text(area, "name") + " " + text(area, "kind");
    if (!areas.empty()) cells.push_back({"areas: " + areas + "  ", kCyan});
    if (const auto explored = robot.find("exploration"); explored != robot.end())
      cells.push_back({text(*explored, "state") + " about " + fixed(100.0 * number(*explored, "share"), 0) +
                           "%, " + fixed(number(*explored, "open"), 0) + " frontiers left  ",
                       kCyan});
    if (flag(robot, "locked")) {
      const double lease = number(robot, "lock_lease_left");
      cells.push_back({lease >= 0.0 ? "locked, lapses in " + fixed(lease, 0) + " s  " : "locked  "});
    }
    std::string closed;
    for (const json& mode : robot.value("modes", json::array()))
      if (!flag(mode, "available") && text(mode, "reason") != "joystick_stale")
        closed += (closed.empty() ? "" : ", ") + text(mode, "mode") + " (" + text(mode, "reason") + ")";
    if (!closed.empty()) cells.push_back({"no " + closed, kDim});
    if (cells.size() == 1) cells.push_back({"ready", kGreen});
    page.line(cells);
    return;
  }
  page.line({});
}

void notices(Page& page, const json& snapshot, std::size_t room) {
  page.line({{" NOTIFICATIONS", kBold}});
  if (room < 2) return;
  const json list = snapshot.value("notices", json::array());
  std::size_t shown = 0;
  for (auto it = list.rbegin(); it != list.rend() && shown < room - 1; ++it, ++shown) {
    const std::string level = text(*it, "level");
    const char* colour = !flag(*it, "mine")   ? kDim
                         : level == "error"   ? kRed
                         : level == "warning" ? kYellow
                                              : "";
    std::string line = " " + padded(short_age(number(*it, "age")), 5, true) + padded(text(*it, "robot"), 6);
    page.line({{line}, {text(*it, "text").empty() ? text(*it, "code") : text(*it, "text"), colour}});
  }
  if (list.empty()) {
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

std::vector<std::string> robots_of(const json& snapshot) {
  std::vector<std::string> names;
  for (const json& robot : snapshot.value("robots", json::array())) names.push_back(text(robot, "robot"));
  return names;
}

std::vector<std::string> render(const json& snapshot, const WatchState& state, int rows, int columns,
                                bool colour) {
  const int footer = std::min(rows, 2);  // Always visible: typed line or answer, and the keys.
  Page page(rows - footer, columns, colour);
  const json counts = snapshot.value("commands", json::object());
  std::string title =
      " ADIT  " + text(snapshot, "station") +
      (text(snapshot, "link").empty() ? "  no link profile" : "  link " + text(snapshot, "link")) +
      "  commands " + fixed(number(counts, "accepted"), 0) + " done " + fixed(number(counts, "refused"), 0) +
      " refused " + fixed(number(counts, "unanswered"), 0) + " unanswered";
  std::string others;
  for (const json& station : snapshot.value("stations", json::array()))
    if (!flag(station, "self")) others += (others.empty() ? "  with " : ", ") + text(station, "station");
  page.line({{title + others}}, kReverse);
  if (state.silent)
    page.line({{" the station does not answer", kRed}});
  else
    page.line({});
  robots(page, snapshot, state);
  page.line({});
  detail(page, snapshot, state);
  page.line({});
  if (state.help) help(page);
  if (page.left() > 1) notices(page, snapshot, page.left());
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
