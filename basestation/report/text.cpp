// SPDX-License-Identifier: Apache-2.0
#include "basestation/report/text.hpp"

#include <cmath>
#include <numbers>

#include "basestation/model/route.hpp"
#include "basestation/report/table.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

std::string battery_text(const RobotView& robot) {
  return robot.battery < 0.0F ? "-" : fixed(robot.battery * 100.0, 0) + "%";
}

std::string age_text(const RobotView& robot, Time now) {
  return (robot.lost ? "lost " : "") + fixed(seconds(now - robot.last_heard), 1);
}

std::string holder_text(const RobotView& robot) {
  if (!robot.owned) return "?";
  if (robot.holder.empty()) return "-";
  return robot.holder + (robot.mine ? "*" : "");
}

std::string place_text(const std::array<float, 3>& place) {
  return " at " + fixed(place[0], 1) + " " + fixed(place[1], 1) + " " + fixed(place[2], 1);
}

}  // namespace

std::string mode_text(const RobotView& robot) { return robot.behaviour_count == 0 ? "?" : robot.mode; }

std::string pose_text(const RobotView& robot) {
  if (!robot.located) return "-";
  return fixed(robot.x, 1) + " " + fixed(robot.y, 1) + " " + fixed(robot.yaw * 180.0 / std::numbers::pi, 0) +
         "d";
}

std::string goal_text(const RobotView& robot) {
  if (robot.goal_state == GoalState::none) return "-";
  return std::string(to_string(robot.goal_state)) + " " + fixed(robot.goal[0], 1) + " " +
         fixed(robot.goal[1], 1);
}

std::string stops_text(const RobotView& robot) {
  if (robot.stops.empty()) return robot.stopped ? "stopped" : "-";
  return command::joined(robot.stops, "-");
}

std::string list_text(const Fleet& fleet, Time now) {
  std::vector<std::vector<std::string>> rows{
      {"ROBOT", "KIND", "MODE", "HOLDER", "LOCK", "STOPPED BY", "X Y YAW", "M/S", "GOAL", "BATT", "AGE S"}};
  for (const auto& [robot_name, robot] : fleet.robots())
    rows.push_back({robot_name, or_dash(robot.platform), mode_text(robot), holder_text(robot),
                    robot.locked ? "locked" : "-", stops_text(robot), pose_text(robot),
                    robot.located ? fixed(std::hypot(robot.vx, robot.vy), 2) : "-", goal_text(robot),
                    battery_text(robot), age_text(robot, now)});
  std::string out = rows.size() == 1 ? "no robot has been heard\n" : table(rows);
  out += "stations: " + fleet.own_name() + " (this one)";
  if (fleet.own_place()) out += place_text(*fleet.own_place());
  for (const auto& [station_name, station] : fleet.stations())
    out += ", " + station_name + (now - station.last_heard > Fleet::kLostAfter ? " (silent)" : "") +
           (station.place ? place_text(*station.place) : "");
  return out + "\n";
}

namespace {

/// The newest notices of a robot, newest first, one per line; empty if there are none.
std::string notices_text(const Fleet& fleet, const std::string& robot, Time now) {
  constexpr int max_notices = 5;
  std::string out;
  int shown = 0;
  const auto& all = fleet.notices();
  for (auto notice = all.rbegin(); notice != all.rend() && shown < max_notices; ++notice) {
    if (notice->robot != robot) continue;
    out += (shown == 0 ? "  notices  " : "           ") + fixed(seconds(now - notice->at), 0) +
           " s ago: " + (notice->text.empty() ? notice->code : notice->text) + "\n";
    ++shown;
  }
  return out;
}

}  // namespace

std::string status_text(const Fleet& fleet, const RobotView& robot, Time now) {
  std::string out = robot.name + "  " + or_dash(robot.platform) + ", " + or_dash(robot.software) +
                    ", heard " + fixed(seconds(now - robot.last_heard), 1) + " s ago" +
                    (robot.lost ? ", LOST" : "") + "\n";
  std::string holder = robot.owned ? (robot.holder.empty() ? "nobody" : robot.holder) : "not heard yet";
  if (robot.mine) holder += " (you)";
  if (robot.locked) holder += ", locked";
  if (robot.locked && robot.lease_left >= 0.0F) holder += ", lapses in " + fixed(robot.lease_left, 0) + " s";
  out += "  holder   " + holder + "\n";
  std::string mode = mode_text(robot);
  if (robot.behaviour_count > 0 && !robot.moving_allowed && robot.reason != Reason::none)
    mode += ", does not move: " + std::string(describe(robot.reason)) + " [" +
            std::string(name(robot.reason)) + "]";
  if (robot.recovery != RecoveryState::drive) mode += ", " + recovery_text(robot.recovery);
  out += "  mode     " + mode + "\n";
  out += "  stops    " + stops_text(robot) + "\n";
  out += "  goal     " + goal_text(robot) + "\n";
  if (const std::string way = route_text(robot); !way.empty()) out += "  route    " + way + "\n";
  if (!robot.convoy.empty()) out += "  convoy   " + command::joined(robot.convoy, "") + "\n";
  if (!robot.yields_to.empty())
    out += "  yields   makes way for " + robot.yields_to + "\n";
  else if (robot.yields)
    out += "  yields   to robots with right of way\n";
  for (const Area& area : robot.areas) out += "  area     " + area_text(area) + "\n";
  if (robot.exploration.phase != ExplorationPhase::none)
    out += "  explored " + exploration_text(robot.exploration) + "\n";
  if (robot.located)
    out += "  pose     x " + fixed(robot.x, 2) + " y " + fixed(robot.y, 2) + " z " + fixed(robot.z, 2) +
           " m, yaw " + fixed(robot.yaw * 180.0 / std::numbers::pi, 1) + " degrees\n  speed    " +
           fixed(robot.vx, 2) + " " + fixed(robot.vy, 2) + " m/s, turn " + fixed(robot.wz, 2) + " rad/s\n";
  constexpr float kTilted = 0.05F;  // rad: less is not worth a line.
  if (robot.located && std::hypot(robot.roll, robot.pitch) > kTilted)
    out += "  tilt     roll " + fixed(robot.roll * 180.0 / std::numbers::pi, 0) + ", pitch " +
           fixed(robot.pitch * 180.0 / std::numbers::pi, 0) + " degrees\n";
  if (robot.located && robot.localisation != Localisation::off)
    out += "  place    " + std::string(name(robot.localisation)) +
           (robot.sigma < kUnknownPlace ? ", known to " + fixed(robot.sigma, 2) + " m\n" : ", unknown\n");
  if (robot.described)
    out += "  size     " + size_text(robot.size) + "\n  limits   " + limits_text(robot) + "\n  sensors  " +
           command::joined(robot.sensors, "-") + "\n  services " + command::joined(robot.services, "-") +
           "\n";
  out += "  battery  " + battery_text(robot) + "\n";
  for (const ModeOption& option : robot.options) {
    std::string row = "  mode " + option.mode;
    row.resize(std::max<std::size_t>(row.size() + 1, 23), ' ');
    out += row + (can_enter(option) ? "possible" : "not now: " + std::string(describe(option.reason))) + "\n";
  }
  out += notices_text(fleet, robot.name, now);
  return out;
}

namespace {

std::string ms_text(double seconds) { return fixed(seconds * 1e3, 0); }

std::string links_text(const NetworkReport& report, const std::string& own_name) {
  std::vector<std::vector<std::string>> rows{{"LINK TO", "HEARD S AGO", "LOST FROM %", "LOST TO %",
                                              "ROUND TRIP MS", "B/S FROM", "B/S TO", "QUEUE MS", "STATE HZ",
                                              "SIGNAL DBM", "LINK"}};
  for (const LinkReport& link : report.links) {
    const bool limited = link.sender && !link.sender->link.empty();
    const bool states = link.sender && link.sender->state_rate > 0.0;
    rows.push_back(
        {link.agent, fixed(link.age, 1), fixed(link.lost_from * 100.0, 0),
         link.lost_to ? fixed(*link.lost_to * 100.0, 0) : "-",
         link.round_trip ? ms_text(*link.round_trip) : "-",
         link.bytes_from ? fixed(*link.bytes_from, 0) : "-", link.bytes_to ? fixed(*link.bytes_to, 0) : "-",
         limited ? ms_text(link.sender->queue) : "-", states ? fixed(link.sender->state_rate, 1) : "-",
         link.signal ? fixed(*link.signal, 0) : "-",
         limited ? link.sender->link + " " + fixed(link.sender->bandwidth / 1e3, 0) + " kbit/s" : "-"});
  }
  std::map<std::string, SenderReport> senders;
  if (report.sender) senders[own_name] = *report.sender;
  for (const LinkReport& link : report.links)
    if (link.sender) senders[link.agent] = *link.sender;
  std::string out = table(rows);
  for (const auto& [agent, sender] : senders) {
    std::string classes;
    for (std::size_t p = 0; p < wire::kPriorities; ++p)
      if (const std::uint32_t dropped = sender.dropped.at(priority_name(p)); dropped > 0)
        classes +=
            (classes.empty() ? "" : ", ") + std::string(priority_name(p)) + " " + std::to_string(dropped);
    if (!classes.empty()) out += agent + " dropped before the air took it: " + classes + "\n";
  }
  return out;
}

}  // namespace

std::string net_text(const NetworkReport& report, const StationParams& params) {
  if (report.agents.empty()) return "no link report has been heard yet; they come every 2 s\n";
  std::vector<std::vector<std::string>> rows{
      {"AGENT", "TOPIC", "B/S OUT", "N/S OUT", "B/S IN", "N/S IN", "DROPPED"}};
  double out_sum = 0.0, discovery_sum = 0.0;
  for (const AgentTraffic& traffic : report.agents) {
    // On a full link the report period is 8 s.
    const bool silent = traffic.age > 4 * seconds(Fleet::kLostAfter);
    std::string first = traffic.agent + (silent ? " (silent)" : "");
    for (const TopicTraffic& row : traffic.topics) {
      rows.push_back({first, row.topic, fixed(row.bytes_out, 0), fixed(row.samples_out, 1),
                      fixed(row.bytes_in, 0), fixed(row.samples_in, 1), std::to_string(row.dropped)});
      first.clear();
    }
    rows.push_back(
        {first, "discovery", fixed(traffic.discovery_out, 0), "-", fixed(traffic.discovery_in, 0), "-", "-"});
    rows.push_back({"", "total", fixed(traffic.total_out, 0), "-", fixed(traffic.total_in, 0), "-",
                    std::to_string(traffic.malformed)});
    if (silent) continue;
    out_sum += traffic.total_out;
    discovery_sum += traffic.discovery_out;
  }
  std::string out = table(rows) + "all agents send " + fixed(out_sum, 0) + " B/s, of it discovery " +
                    fixed(discovery_sum, 0) + " B/s";
  if (params.bandwidth > 0.0)
    out += ": " + fixed(out_sum * 8.0 / params.bandwidth * 100.0, 1) + " % of " + params.link + " (" +
           fixed(params.bandwidth / 1000.0, 0) + " kbit/s)";
  return out + "\n\n" + links_text(report, params.name);
}

std::string health_text(const HealthReport& report) {
  if (report.robots.empty()) return "no robot has been heard\n";
  std::vector<std::vector<std::string>> rows{
      {"ROBOT", "COMPONENT", "STATE", "POLICY", "SILENT S", "RESTARTS", "HUNG", "REMARK"}};
  std::string silent, note;
  for (const RobotHealth& health : report.robots) {
    if (health.components.empty()) silent += health.robot + ": no health report has been heard\n";
    for (const ComponentHealth& part : health.components) {
      const bool component = command::is_component(part.name);
      if (!component) note = "POLICY -: no component of the agent; restart and policy do not take it\n";
      rows.push_back({health.robot, part.name, word(part.state),
                      !component       ? "-"
                      : part.automatic ? "auto"
                                       : "manual",
                      fixed(part.silent_for, 1), std::to_string(part.restarts), std::to_string(part.hung),
                      part.text});
    }
  }
  return (rows.size() == 1 ? "" : table(rows)) + note + silent;
}

std::string actions_text(const std::vector<Action>& actions) {
  std::vector<std::vector<std::string>> rows{{"COMMAND", "NOW", "REMARK"}};
  for (const Action& action : actions) {
    std::string remark = action.text;
    if (!remark.empty() && !action.robot.empty()) remark = action.robot + ": " + remark;
    if (!action.valid) remark += " [" + std::string(name(action.reason)) + "]";
    rows.push_back({action.command, action.valid ? "yes" : "no", remark});
  }
  return table(rows);
}

std::string route_text(const contract::PlannedRoute& route) {
  constexpr std::size_t most = 12;  // Corners after the start.
  std::string out = fixed(route.length, 1) + " m";
  if (route.unknown_length > 0.0) out += ", " + fixed(route.unknown_length, 1) + " m of it not seen yet";
  for (std::size_t i = 1; i < route.points.size() && i <= most; ++i)
    out += (i == 1 ? ": " : ", ") + fixed(route.points[i][0], 1) + " " + fixed(route.points[i][1], 1);
  return out + (route.corners > most + 1 ? " ..." : "");
}

std::string answer_text(const Answer& answer, const std::string& done, const std::string& own_name) {
  if (answer.accepted) {
    return answer.robot + ": " + done + (answer.text.empty() ? "" : "; " + answer.text) + "\n";
  }
  std::string why = answer.text.empty() ? std::string(describe(answer.reason)) : answer.text;
  const bool named = answer.holder.empty() || answer.holder == own_name ||
                     answer.reason == Reason::cancelled || why.find(answer.holder) != std::string::npos;
  if (!named) why += " (holder: " + answer.holder + ")";
  if (answer.reason == Reason::cancelled) return answer.robot + ": ended: " + why + " [cancelled]\n";
  const bool refused = answer.answered || answer.reason != Reason::no_answer;
  return (answer.robot.empty() ? "" : answer.robot + ": ") + (refused ? "refused: " : "") + why + " [" +
         std::string(name(answer.reason)) + "]\n";
}

}  // namespace adit::station
