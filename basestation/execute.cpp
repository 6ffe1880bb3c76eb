// SPDX-License-Identifier: Apache-2.0
// Execution of command lines by a station.
#include <algorithm>
#include <utility>

#include "basestation/findings/report.hpp"
#include "basestation/fleet/all_robots.hpp"
#include "basestation/model/json.hpp"
#include "basestation/report/json.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"
#include "basestation/station_impl.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

constexpr std::size_t kMaxWaiting = 64;
constexpr std::size_t kMaxFlows = 64;

using command::Request;
using command::Runs;
using command::verb;

int exit_of(const Answer& answer) {
  if (answer.accepted) return 0;
  return answer.reason == Reason::no_answer ? 3 : 1;
}

nlohmann::json json_of(const Request& request, int exit_code) {
  return {{"command", request.info->name}, {"exit", exit_code}, {"ok", exit_code == 0}};
}

std::string unknown_text(const Fleet& fleet) {
  return "no robot of that name has been heard; known robots: " +
         command::joined(fleet.robot_names(), "none");
}

Outcome unknown_robot(const Request& request, const Fleet& fleet, const std::string& robot) {
  Outcome outcome{
      .exit_code = 1, .error = robot + ": " + unknown_text(fleet) + "\n", .json = json_of(request, 1)};
  outcome.json["reason"] = name(Reason::unknown_robot);
  outcome.json["error"] = outcome.error;
  return outcome;
}

/// Suggests a mode for one that the robot does not know, e.g. ", did you mean waypoint?"; empty if none is
/// similar.
std::string nearest_mode(const RobotView* robot, const std::string& typed) {
  std::vector<std::string> offered;
  if (robot)
    for (const ModeChoice& choice : robot->choices) offered.push_back(choice.mode);
  const std::string meant = command::nearest(typed, offered);
  return meant.empty() ? "" : ", did you mean " + meant + "?";
}

/// Parameters of a command with a joystick stream; unset for other commands.
std::optional<SteerParams> steering(const Request& request) {
  const std::string mode = request.word("MODE");
  if (request.verb == verb("mode") && is_by_hand(mode))
    return SteerParams{.purpose = SteerParams::Purpose::enter, .mode = mode};
  if (request.verb == verb("teleop")) return SteerParams{.purpose = SteerParams::Purpose::teleop};
  if (request.verb != verb("drive")) return std::nullopt;
  return SteerParams{.velocity = {request.number("VX"), request.number("VY"), request.number("WZ")},
                     .duration = from_seconds(request.number("--for"))};
}

}  // namespace

bool Station::Impl::known(const Request& request) const {
  return std::all_of(request.robots.begin(), request.robots.end(),
                     [this](const std::string& robot) { return fleet_.robot(robot) != nullptr; });
}

bool Station::Impl::complete() const {
  const auto& robots = fleet_.robots();
  return !robots.empty() && std::all_of(robots.begin(), robots.end(), [](const auto& entry) {
    const RobotView& robot = entry.second;
    return robot.lost || (robot.described && robot.located && robot.owned && robot.behaviour_count > 0);
  });
}

bool Station::Impl::must_wait(std::uint64_t handle, const Request& request) const {
  // A stop is never delayed: it is also sent to robots that were not heard yet.
  if (request.verb == verb("stop")) return false;
  // No command overtakes an earlier one for the same robot.
  const auto& robots = request.robots;
  if (std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
        const auto& others = other.request.robots;
        return other.handle < handle && (other.request.all || request.all ||
                                         std::find_first_of(others.begin(), others.end(), robots.begin(),
                                                            robots.end()) != others.end());
      }))
    return true;
  if (!known(request) && fresh(params_.discovery_grace)) return true;
  if (request.info->runs != Runs::query && !request.all) return false;
  // Just after the start the first results are incomplete, and an absent robot looks like a late one.
  return fresh(params_.settle) || (fresh(2 * params_.settle) && !complete());
}

std::uint64_t Station::Impl::execute(const Request& request, Done done) {
  const std::uint64_t handle = next_handle_++;
  if (must_wait(handle, request) && waiting_.size() < kMaxWaiting)
    waiting_.push_back({handle, request, std::move(done)});
  else
    run(handle, request, std::move(done));
  return handle;
}

std::uint64_t Station::Impl::refuse(const Error& error, const Done& done) {
  note({.reason = error.reason, .text = error.text});
  Outcome outcome{.exit_code = 2, .error = error.text + "\n"};
  outcome.json = {{"exit", 2}, {"ok", false}, {"reason", name(error.reason)}, {"error", error.text}};
  done(outcome);
  return next_handle_++;
}

void Station::Impl::run(std::uint64_t handle, const Request& request, Done done) {
  if (request.all && request.robots.empty() && request.verb != verb("stop")) {
    const auto named = with_robots_named(request, fleet_);
    if (named) return run(handle, *named, std::move(done));
    note({.command = std::string(request.info->name), .reason = named.reason(), .text = named.error().text});
    Outcome outcome{.exit_code = 1, .error = named.error().text + "\n", .json = json_of(request, 1)};
    outcome.json["reason"] = name(named.reason());
    return done(outcome);
  }
  if (request.info->runs == Runs::query) return answer_query(request, done);
  if (request.verb == verb("up")) {
    closed_ = false;
    announce();
    return done({.text = "station " + params_.name + " is up\n", .json = json_of(request, 0)});
  }
  if (closed_) {
    note({.command = std::string(request.info->name),
          .reason = Reason::no_station,
          .text = std::string(describe(Reason::no_station))});
    Outcome outcome{.exit_code = 1, .error = std::string(describe(Reason::no_station)) + "\n"};
    outcome.json = json_of(request, 1);
    outcome.json["reason"] = name(Reason::no_station);
    return done(outcome);
  }
  if (request.verb == verb("down")) return down(std::move(done));
  if (request.info->first_word() == "finding") return judge_finding(request, done);
  if (request.verb == verb("stop") && request.all) return stop_all(request, std::move(done));
  if (request.verb == verb("convoy start")) return start_convoy(handle, request, std::move(done));
  if (request.verb == verb("convoy stop")) return stop_convoy(handle, request, std::move(done));
  command_robots(handle, request, std::move(done));
}

void Station::Impl::answer_query(const Request& request, const Done& done) {
  if (request.info->first_word() == "map") return answer_map(request, done);
  if (request.verb == verb("findings")) {  // Findings stay available when their robot is lost.
    for (const std::string& robot : request.robots) {
      const auto& all = desk_.all();
      const bool found =
          std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.first.robot == robot; });
      if (!found && !fleet_.robot(robot)) return done(unknown_robot(request, fleet_, robot));
    }
    Outcome outcome{.json = json_of(request, 0)};
    const FoundReport report = findings_report(desk_, book_, fleet_, request.robots);
    outcome.text = findings_text(report);
    outcome.json.update(findings_json(report, desk_, book_));
    const std::uint64_t refused = pieces_.refused(transfer::Kind::findings);
    outcome.json["refused_pieces"] = refused;
    if (refused > 0) outcome.text += std::to_string(refused) + " pieces of findings refused\n";
    return done(outcome);
  }
  std::vector<const RobotView*> selection;
  for (const std::string& robot : request.robots) {
    selection.push_back(fleet_.robot(robot));
    if (!selection.back()) return done(unknown_robot(request, fleet_, robot));
  }
  const Time at = strand_.now();
  Outcome outcome{.json = json_of(request, 0)};
  if (request.verb == verb("list")) {
    outcome.text = list_text(fleet_, at);
    outcome.json.update(list_json(fleet_, at));
  } else if (request.verb == verb("status") && !selection.empty()) {
    outcome.text = status_text(fleet_, *selection.front(), at);
    outcome.json.update(json_of(described(*selection.front(), at)));
    outcome.json["notifications"] = notices_json(fleet_, selection.front()->name, at);
  } else if (request.verb == verb("status")) {
    const Counts& c = sender_.counts();
    outcome.text = "station " + params_.name +
                   (params_.link.empty() ? ", no link profile" : " on " + params_.link) + ", up " +
                   fixed(seconds(at - started_), 0) + " s; commands " + std::to_string(c.sent) + " sent, " +
                   std::to_string(c.accepted) + " accepted, " + std::to_string(c.refused) + " refused, " +
                   std::to_string(c.unanswered) + " unanswered\n" + list_text(fleet_, at);
    outcome.json.update(list_json(fleet_, at));
    outcome.json["station"] = params_.name;
    outcome.json["link"] = params_.link;
    outcome.json["up_for"] = seconds(at - started_);
    outcome.json["commands"] = json_of(c);
    outcome.json["notifications"] = notices_json(fleet_, "", at);
  } else if (request.verb == verb("net")) {
    outcome.text = net_text(fleet_, at, params_.link, params_.bandwidth);
    outcome.json.update(net_json(fleet_, at));
  } else if (request.verb == verb("actions")) {
    const std::vector<Action> rows = actions({selection.begin(), selection.end()});
    outcome.text = actions_text(rows);
    outcome.json["actions"] = actions_json(rows);
  } else {
    if (selection.empty())
      for (const auto& [robot_name, robot] : fleet_.robots()) selection.push_back(&robot);
    outcome.json["robots"] = nlohmann::json::array();
    for (const RobotView* robot : selection) {
      outcome.json["robots"].push_back(health_json(*robot));
    }
    outcome.text = selection.empty() ? "no robot has been heard\n" : health_text(selection);
  }
  done(outcome);
}

void Station::Impl::command_robots(std::uint64_t handle, const Request& request, Done done) {
  auto gather = std::make_shared<Gather>();
  gather->request = request;
  gather->done = std::move(done);
  send_to_all(handle, gather);
}

void Station::Impl::send_to_all(std::uint64_t handle, const std::shared_ptr<Gather>& gather) {
  const std::vector<std::string>& robots = gather->request.robots;
  gather->answers.resize(robots.size());
  gather->missing = robots.size();
  for (std::size_t i = 0; i < robots.size(); ++i) command_robot(handle, robots[i], gather, i);
}

void Station::Impl::command_robot(std::uint64_t handle, const std::string& robot,
                                  const std::shared_ptr<Gather>& gather, std::size_t index) {
  const Request& request = gather->sent ? *gather->sent : gather->request;
  const auto ended = [this, gather, index](const Answer& answer) { gathered(gather, index, answer); };
  if (!fleet_.robot(robot) && request.verb != verb("stop"))
    return ended({.robot = robot, .reason = Reason::unknown_robot, .text = unknown_text(fleet_)});
  if (const auto steer = steering(request))
    return add_flow(handle, std::make_shared<Steer>(flow_dependencies(), robot, *steer, ended), ended);
  if (request.verb == verb("stop")) end_flows(robot, Reason::stopped);
  const bool asks_for_mode = !request.info->conditions.mode.empty();
  if (asks_for_mode && request.word("MODE") == "hold") end_flows(robot, Reason::cancelled);
  const Flow::Done answered =
      asks_for_mode ? end_drives_when_accepted(robot) : Flow::Done([](const Answer&) {});
  RobotCommand robot_command{.robot = robot, .request = request};
  if (request.verb == verb("goto") && request.has("--wait"))
    return add_flow(handle,
                    std::make_shared<Arrival>(flow_dependencies(), std::move(robot_command), answered, ended),
                    ended);
  sender_.send(std::move(robot_command), [answered, ended](const Answer& answer) {
    answered(answer);
    ended(answer);
  });
}

void Station::Impl::stop_all(const Request& request, Done done) {
  auto gather = std::make_shared<Gather>();
  gather->request = request;
  gather->done = std::move(done);
  stop_alls_.push_back({.gather = gather});
  for (const auto& [robot_name, robot] : fleet_.robots()) ask_stop(stop_alls_.back(), robot_name);
  if (!fresh(params_.discovery_grace)) finish_stop_all();
}

void Station::Impl::ask_stop(StopAll& all, const std::string& robot) {
  if (!all.asked.insert(robot).second) return;
  const std::size_t index = all.gather->answers.size();
  all.gather->answers.emplace_back();
  ++all.gather->missing;
  command_robot(0, robot, all.gather, index);
}

void Station::Impl::finish_stop_all() {
  for (StopAll& all : std::exchange(stop_alls_, {})) {
    if (all.gather->missing == 0) finish(*all.gather);
    // Otherwise the last answer completes it.
  }
}

void Station::Impl::gathered(const std::shared_ptr<Gather>& gather, std::size_t index, const Answer& answer) {
  gather->answers[index] = answer;
  gather->answers[index].command = gather->request.info->name;
  if (answer.reason == Reason::mode_unknown)
    gather->answers[index].text += nearest_mode(fleet_.robot(answer.robot), gather->request.word("MODE"));
  if (answer.route) gather->answers[index].text = route_text(*answer.route);
  note(gather->answers[index]);
  if (--gather->missing > 0) return;
  const bool growing = std::any_of(stop_alls_.begin(), stop_alls_.end(),
                                   [&](const StopAll& all) { return all.gather == gather; });
  if (!growing) finish(*gather);
}

void Station::Impl::finish(Gather& gather) {
  Outcome outcome;
  nlohmann::json results = nlohmann::json::array();
  bool refused = false, silent = false;
  for (const Answer& answer : gather.answers) {
    const int code = exit_of(answer);
    refused = refused || code == 1;
    silent = silent || code == 3;
    (code == 0 ? outcome.text : outcome.error) +=
        answer_text(answer, command::done_text(gather.request), params_.name);
    results.push_back(answer_json(answer));
  }
  if (gather.answers.empty()) {
    silent = true;
    outcome.error = "no robot has been heard; nothing was stopped\n";
  }
  outcome.exit_code = refused ? 1 : silent ? 3 : 0;
  outcome.json = json_of(gather.request, outcome.exit_code);
  outcome.json["results"] = results;
  if (const Done done = std::exchange(gather.done, nullptr)) done(outcome);
}

void Station::Impl::down(Done done) {
  Request request(verb("release"));
  for (const auto& [robot_name, robot] : fleet_.robots())
    if (robot.mine) request.robots.push_back(robot_name);
  auto gather = std::make_shared<Gather>();
  gather->request = request;
  gather->answers.resize(request.robots.size());
  gather->missing = request.robots.size();
  gather->done = [this, done = std::move(done)](const Outcome& released) {
    closed_ = true;
    const std::vector<std::string> unheard = sender_.drop_unheard();
    // A robot that does not answer keeps its holder; the station still closes, and reports this.
    Outcome outcome = released;
    outcome.exit_code = 0;
    if (!unheard.empty())
      outcome.text +=
          "never acknowledged a stop, which no longer goes out: " + command::joined(unheard, "") + "\n";
    outcome.text += "station " + params_.name + " is down\n";
    outcome.json = json_of(Request(verb("down")), 0);
    outcome.json["results"] = released.json["results"];
    done(outcome);
    if (owner_.on_down) owner_.on_down();
  };
  if (request.robots.empty()) {
    gather->answers.clear();
    const Done finished = std::exchange(gather->done, nullptr);
    return finished({.json = {{"results", nlohmann::json::array()}}});
  }
  for (std::size_t i = 0; i < request.robots.size(); ++i) {
    end_flows(request.robots[i], Reason::cancelled);
    command_robot(0, request.robots[i], gather, i);
  }
}

void Station::Impl::note(const Answer& answer) {
  last_answer_ = answer;
  if (owner_.on_answer) owner_.on_answer(answer);
  changed();
}

void Station::Impl::late_stop(const Answer& answer) {
  note(answer);
  const std::string end = answer.accepted ? "acknowledged the stop that was sent before it was heard"
                          : answer.answered
                              ? "refused the stop that was sent before it was heard: " + answer.text
                              : "did not acknowledge the stop: " + answer.text;
  fleet_.say({.robot = answer.robot,
              .level = answer.accepted ? Level::info : Level::warning,
              .code = answer.accepted ? "stop_acknowledged" : "stop_not_acknowledged",
              .reason = answer.reason,
              .text = answer.robot + " " + end},
             strand_.now());
}

void Station::Impl::add_flow(std::uint64_t handle, std::shared_ptr<Flow> flow, const Flow::Done& ended) {
  std::erase_if(flows_, [](const auto& entry) { return entry.second->over(); });
  // A drive replaces the robot's previous drive; a wait replaces none.
  const bool drives = dynamic_cast<Steer*>(flow.get()) != nullptr;
  const auto replaced = [&](const Flow& other) {
    return drives && other.robot() == flow->robot() && dynamic_cast<const Steer*>(&other);
  };
  const auto others = std::count_if(flows_.begin(), flows_.end(),
                                    [&](const auto& entry) { return !replaced(*entry.second); });
  if (static_cast<std::size_t>(others) >= kMaxFlows)
    return ended({.robot = flow->robot(),
                  .reason = Reason::queue_full,
                  .text = "64 drives and waits are going on at this station already"});
  for (const auto& [other, running] : std::multimap(flows_))
    if (replaced(*running)) running->hand_over();
  std::erase_if(flows_, [](const auto& entry) { return entry.second->over(); });
  flows_.emplace(handle, flow);
  flow->start();
}

void Station::Impl::end_flows(const std::string& robot, Reason reason) {
  for (const auto& [handle, flow] : std::multimap(flows_))
    if (flow->robot() == robot && dynamic_cast<Steer*>(flow.get()))
      flow->cancel(reason, reason == Reason::cancelled ? "another command took its place" : "");
}

Flow::Done Station::Impl::end_drives_when_accepted(const std::string& robot) const {
  std::vector<std::weak_ptr<Flow>> drives;  // The present drives: one that begins later must continue.
  for (const auto& [handle, flow] : flows_)
    if (flow->robot() == robot && dynamic_cast<Steer*>(flow.get())) drives.push_back(flow);
  return [drives](const Answer& answer) {
    if (!answer.accepted) return;
    for (const auto& weak : drives)
      if (const auto drive = weak.lock()) drive->cancel(Reason::cancelled, "another command took its place");
  };
}

void Station::Impl::cancel(std::uint64_t handle) {
  const auto [first, last] = flows_.equal_range(handle);
  for (const auto& [same, flow] : std::multimap(first, last)) flow->cancel(Reason::cancelled, "");
  for (auto it = waiting_.begin(); it != waiting_.end(); ++it) {
    if (it->handle != handle) continue;
    const Waiting dropped = std::move(*it);
    waiting_.erase(it);
    Outcome outcome{.exit_code = 1, .error = "cancelled\n", .json = json_of(dropped.request, 1)};
    outcome.json["reason"] = name(Reason::cancelled);
    return dropped.done(outcome);
  }
}

std::uint64_t Station::Impl::teleop(const std::string& robot, Done done) {
  return execute(Request(verb("teleop"), {robot}), std::move(done));
}

void Station::Impl::stick(std::uint64_t handle, const StickVelocity& velocity) {
  const auto [first, last] = flows_.equal_range(handle);
  for (const auto& [same, flow] : std::multimap(first, last))
    if (auto* steer = dynamic_cast<Steer*>(flow.get())) steer->set_velocity(velocity);
}

void Station::Impl::tick() {
  fleet_.check(strand_.now());
  for (const auto& [name, robot] : fleet_.robots())
    if (robot.located) {
      radio_.set_place(robot.participant, {robot.x, robot.y, robot.z});
      trails_.add(name, {robot.x, robot.y, robot.yaw});
    }
  acknowledge_pieces();
  std::erase_if(flows_, [](const auto& entry) { return entry.second->over(); });
  const auto ready = [this] {
    return std::find_if(waiting_.begin(), waiting_.end(),
                        [this](const Waiting& next) { return !must_wait(next.handle, next.request); });
  };
  for (auto next = ready(); next != waiting_.end(); next = ready()) {
    Waiting due = std::move(*next);
    waiting_.erase(next);
    run(due.handle, due.request, std::move(due.done));
  }
  for (StopAll& all : stop_alls_)
    for (const std::string& robot : fleet_.robot_names()) ask_stop(all, robot);
  if (!stop_alls_.empty() && !fresh(params_.discovery_grace)) finish_stop_all();
}

}  // namespace adit::station
