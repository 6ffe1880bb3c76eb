// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "basestation/gui/bridge/card.hpp"
#include "basestation/model/text.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

using station::ComponentHealth;

constexpr double kFullQueue = 0.2;  // Queued airtime from which a link counts as full, s.

std::string count_text(std::uint32_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

void mark(const ComponentHealth& part, HealthCell& cell) {
  struct Mark {
    const char *text{}, *shape{};
    Token token{};
  };
  // In the order of PartState.
  static constexpr std::array kMarks{Mark{"starting", "ring", Token::text}, Mark{"up", "disc", Token::ok},
                                     Mark{"waits", "triangle", Token::warn},
                                     Mark{"FAILED", "square", Token::bad},
                                     Mark{"HUNG", "square", Token::bad}};
  const bool unwell = part.state == PartState::up && !part.healthy;
  const Mark shown =
      unwell ? Mark{"up, not well", "triangle", Token::warn} : kMarks[static_cast<std::size_t>(part.state)];
  cell.text = shown.text;
  cell.shape = shown.shape;
  cell.token = shown.token;
  if (part.restarts > 0) cell.hint = count_text(part.restarts, "restart", "restarts");
  if (part.hung > 0)
    cell.hint += (cell.hint.empty() ? "" : ", ") + count_text(part.hung, "thread", "threads");
}

std::string percent(double share) { return station::fixed(share * 100.0, 0) + " %"; }

std::string rate_text(double bytes) {
  return bytes < 1000.0 ? station::fixed(bytes, 0) + " B/s" : station::fixed(bytes / 1000.0, 1) + " kB/s";
}

void show_budget(const station::SenderReport* sender, const station::AgentTraffic* traffic, NetworkRow& row) {
  const double sent = traffic ? traffic->total_out : 0.0;
  if (!sender || !traffic) {
    row.budget = "no report yet";
  } else if (sender->link.empty()) {
    row.budget = "sends " + rate_text(sent) + ", unlimited";
  } else if (sender->bandwidth > 0.0) {
    row.share = std::clamp(sent * 8.0 / sender->bandwidth, 0.0, 1.0);
    row.budget =
        "sends " + rate_text(sent) + " of " + rate_text(sender->bandwidth / 8.0) + ", " + sender->link;
    row.parts = budget_parts(*traffic, sender->bandwidth);
    const auto most = std::ranges::max_element(row.parts, {}, &BudgetPart::share);
    if (most != row.parts.end() && row.parts.size() > 1) row.budget += ", most " + most->name;
  } else {
    row.budget = "sends " + rate_text(sent) + ", " + sender->link;
  }
  if (!sender) return;
  if (!sender->link.empty()) row.queue = "queue " + station::fixed(sender->queue * 1000.0, 0) + " ms";
  if (sender->state_rate > 0.0)
    row.queue +=
        (row.queue.empty() ? "" : ", ") + ("states " + station::fixed(sender->state_rate, 1) + " Hz");
  for (const auto& [priority, count] : sender->dropped)
    if (count > 0)
      row.dropped += (row.dropped.empty() ? "never sent: " : ", ") + std::to_string(count) + " " + priority;
}

std::string place_words(const station::FoundItem& item) {
  const auto& [x, y, z] = item.position;
  return station::fixed(x, 1) + " " + station::fixed(y, 1) + " " + station::fixed(z, 1);
}

std::string photo_words(const station::FoundPhoto& photo) {
  if (photo.here == station::PhotoHere::whole) return "whole";
  if (photo.percent > 0) return std::to_string(photo.percent) + " %";
  return photo.here == station::PhotoHere::thumbnail ? "thumbnail" : "none yet";
}

bool full(const station::SenderReport* sender) { return sender && sender->queue > kFullQueue; }

}  // namespace

HealthTable health_table(const station::HealthReport& report, const station::World& world) {
  HealthTable table;
  for (const station::RobotHealth& robot : report.robots)
    for (const ComponentHealth& part : robot.components)
      if (table.columns.size() < kMaxColumns &&
          std::find(table.columns.begin(), table.columns.end(), part.name) == table.columns.end())
        table.columns.push_back(part.name);
  for (const station::RobotHealth& robot : report.robots) {
    const station::Robot* seen = world.robot(robot.robot);
    const bool old = !seen || seen->lost;
    HealthCell head{.robot = robot.robot, .text = robot.robot, .old = old};
    if (old) head.hint = "LOST";
    if (robot.components.empty()) head.hint = "no report";
    table.cells.push_back(std::move(head));
    for (const std::string& column : table.columns) {
      HealthCell cell{.robot = robot.robot, .component = column, .old = old};
      const auto part = std::find_if(robot.components.begin(), robot.components.end(),
                                     [&](const ComponentHealth& one) { return one.name == column; });
      if (part != robot.components.end()) mark(*part, cell);
      table.cells.push_back(std::move(cell));
    }
  }
  return table;
}

HealthDetail health_detail(const station::HealthReport& report, const station::World& world,
                           const std::string& robot, const std::string& component) {
  HealthDetail out;
  for (const station::RobotHealth& one : report.robots) {
    if (one.robot != robot) continue;
    for (const ComponentHealth& part : one.components) {
      if (part.name != component) continue;
      HealthCell cell;
      mark(part, cell);
      const station::Robot* seen = world.robot(robot);
      const bool held = seen && seen->mine;
      out.mine = held && command::is_component(component);
      out.automatic = part.automatic;
      out.title = robot + " " + component + ": " + cell.text;
      out.text = cell.hint.empty() ? "never restarted" : cell.hint;
      if (part.hung > 0) out.text += " left behind";
      if (part.silent_for > 1.0F) out.text += ", silent for " + age_text(part.silent_for);
      if (!part.text.empty()) out.text += " — " + part.text;
      if (!out.mine) out.text += held ? " — no command restarts it" : " — you do not hold the robot";
      return out;
    }
  }
  return out;
}

std::vector<NetworkRow> network_rows(const station::NetworkReport& report, const std::string& own) {
  const auto traffic_of = [&](const std::string& name) -> const station::AgentTraffic* {
    for (const station::AgentTraffic& traffic : report.agents)
      if (traffic.agent == name) return &traffic;
    return nullptr;
  };
  std::vector<NetworkRow> rows;
  if (report.sender) {
    NetworkRow row{.agent = own + " (this station)", .shape = "disc", .token = Token::ok};
    show_budget(&*report.sender, traffic_of(own), row);
    if (full(&*report.sender)) row.shape = "triangle", row.token = Token::warn, row.loss = "link is full";
    rows.push_back(std::move(row));
  }
  for (const station::LinkReport& link : report.links) {
    const station::AgentTraffic* traffic = traffic_of(link.agent);
    const station::SenderReport* sender = link.sender ? &*link.sender : nullptr;
    NetworkRow row{.agent = link.agent, .shape = "disc", .token = Token::ok};
    row.loss = "lost from it " + percent(link.lost_from) +
               (link.lost_to ? ", to it " + percent(*link.lost_to) : ", to it unknown");
    row.trip = link.round_trip ? "round trip " + station::fixed(*link.round_trip * 1000.0, 0) + " ms"
                               : "no round trip";
    if (link.signal) row.trip += ", " + station::fixed(*link.signal, 0) + " dBm";
    if (link.bytes_from && link.bytes_to)
      row.rates = "from it " + rate_text(*link.bytes_from) + ", to it " + rate_text(*link.bytes_to);
    show_budget(sender, traffic, row);
    const bool silent = link.age > kSilent || (traffic && traffic->age > kSilent);
    const bool deaf = link.lost_to && *link.lost_to >= 1.0;
    if (full(sender)) row.loss = "link is full, " + row.loss;
    if (deaf) row.loss = "does not hear us, " + row.loss;
    if (silent) row.loss = "SILENT for " + age_text(std::max(link.age, traffic ? traffic->age : 0.0));
    if (silent || deaf)
      row.shape = "square", row.token = Token::bad;
    else if (full(sender) || link.lost_from > kLossy || (link.lost_to && *link.lost_to > kLossy))
      row.shape = "triangle", row.token = Token::warn;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<FoundRow> found_rows(const station::FoundReport& report, const std::string& own) {
  std::vector<FoundRow> rows;
  for (const station::FoundItem& item : report.findings) {
    FoundRow row{.number = static_cast<int>(item.number),
                 .importance = std::to_string(item.importance),
                 .kind = item.kind,
                 .robot = item.robot + (item.mark ? " (mark)" : ""),
                 .text = item.text,
                 .note = item.note};
    row.place = place_words(item);
    row.age = item.age ? age_text(*item.age) : "-";
    if (item.photo) row.photo_state = photo_words(*item.photo);
    const bool open = item.verdict == station::Verdict::open;
    row.verdict = open ? "new" : to_string(item.verdict);
    row.withdrawn = item.withdrawn;
    row.removable = item.mark && !item.withdrawn && item.robot == own;
    row.shape = open ? "ring" : item.verdict == station::Verdict::confirmed ? "disc" : "square";
    const bool dim = item.withdrawn || item.verdict == station::Verdict::rejected;
    row.token = dim ? Token::dim : open ? Token::text : Token::ok;
    rows.push_back(std::move(row));
  }
  return rows;
}

PhotoCaption photo_caption(const station::FoundItem& item) {
  const station::FoundPhoto photo = item.photo.value_or(station::FoundPhoto{});
  const std::string share = std::to_string(photo.percent) + " % of the photo is here";
  PhotoCaption out{.title = std::to_string(item.number) + "  " + item.kind, .text = item.text};
  out.line = (item.mark ? "marked by " : "found by ") + item.robot + "   at " + place_words(item) + "   " +
             (item.age ? age_text(*item.age) + " ago" : "at an unknown time") + "   id " + item.id;
  switch (photo.here) {
    case station::PhotoHere::none:
      out.state = "its thumbnail is not here yet; " + share;
      break;
    case station::PhotoHere::thumbnail:
      out.state = "thumbnail, enlarged; " + share;
      break;
    case station::PhotoHere::whole:
      out.state = "the whole photo";
  }
  return out;
}

std::string found_missing(const station::FoundReport& report) {
  std::string out;
  for (const station::FoundAtRobot& robot : report.at_robots) {
    if (robot.stored > robot.here)
      out += (out.empty() ? "" : ", ") + std::to_string(robot.stored - robot.here) + " are still at " +
             robot.robot;
    if (robot.overflowed > 0)
      out += (out.empty() ? "" : ", ") + robot.robot + " had no room for " + std::to_string(robot.overflowed);
  }
  return out;
}

std::vector<StairsRow> stairs_rows(const station::StairsReport& report) {
  std::vector<StairsRow> rows;
  for (const station::StairsItem& item : report.stairs) {
    const Staircase& s = item.stairs;
    const bool open = item.verdict == station::Verdict::open;
    StairsRow row{.number = static_cast<int>(item.number)};
    row.direction = std::to_string(station::degrees_of(s)) + "°";
    row.turn = 90.0 - station::degrees_of(s);
    row.steps = std::to_string(s.steps) + " steps";
    row.floors = station::fixed(s.floor_below(), 1) + " to " + station::fixed(s.floor_above(), 1) + " m";
    row.step = "rise " + station::fixed(s.rise, 2) + " m, run " + station::fixed(s.run, 2) + " m";
    row.breadth = "width " + station::fixed(s.width, 2) + " ± " + station::fixed(s.sigma.width, 2) + " m";
    row.robots = command::joined(item.robots, "-");
    row.verdict = open ? "new" : to_string(item.verdict);
    row.climbers = command::joined(station::climbers_of(item), "no robot");
    std::vector<std::string> others;
    for (const station::Climber& robot : item.fleet)
      if (!robot.may) others.push_back(robot.robot + " " + robot.reason);
    row.others = command::joined(others, "");
    row.token = open ? Token::text : item.verdict == station::Verdict::confirmed ? Token::ok : Token::dim;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace adit::gui
