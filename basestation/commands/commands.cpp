// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/commands.hpp"

#include <algorithm>
#include <utility>

#include "adit/command.h"
#include "basestation/commands/stairs_way.hpp"
#include "basestation/commands/station_commands.hpp"
#include "basestation/findings/stairs_report.hpp"
#include "basestation/flow/arrival.hpp"
#include "basestation/flow/steer.hpp"
#include "basestation/model/leaving.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

constexpr std::size_t kMaxWaiting = 64;

using command::Request;
using command::Runs;
using command::verb;

/// Suggests a mode for one that the robot does not know, e.g. ", did you mean waypoint?"; empty if none is
/// similar.
std::string nearest_mode(const RobotView* robot, const std::string& typed) {
  std::vector<std::string> offered;
  if (robot)
    for (const ModeOption& option : robot->options) offered.push_back(option.mode);
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

/// Whether a stop of its robot ends the command while it waits: it needs authority, so that it may clear the
/// stop or move the robot, and does not only change who has authority.
bool ended_by_stop(const Request& request) {
  return request.info->conditions.holder && request.info->line != command::Line::authority;
}

/// Names the robots that the `all` of a request means now. Errors: not_holder or unknown_robot when it means
/// none.
Result<Request> with_robots_named(Request request, const Fleet& fleet) {
  using command::AllRobots;
  const AllRobots all = request.info->arguments[0].all;
  for (const auto& [name, robot] : fleet.robots())
    if (all == AllRobots::heard || (all == AllRobots::held && robot.mine) ||
        (all == AllRobots::unheld && robot.owned && robot.holder.empty() && !robot.lost))
      request.robots.push_back(name);
  if (!request.robots.empty()) return request;
  if (all == AllRobots::held) return {Reason::not_holder, "you hold no robot"};
  return {Reason::unknown_robot,
          fleet.robots().empty() ? "no robot has been heard"
                                 : "every robot has a holder; to take one from another operator, name it"};
}

bool shares_robots(const Request& one, const Request& other) {
  return one.all || other.all ||
         std::find_first_of(one.robots.begin(), one.robots.end(), other.robots.begin(), other.robots.end()) !=
             one.robots.end();
}

}  // namespace

Commands::Commands(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
                   Presence& presence, Content& content, Cameras& cameras, Random& random)
    : params_(params),
      strand_(strand),
      fleet_(fleet),
      presence_(presence),
      content_(content),
      random_(random),
      started_(strand.now()),
      sender_({.name = params.name, .id = params.id, .discovery_grace = params.discovery_grace}, strand,
              radio, fleet),
      stick_(params.id, strand, radio, fleet),
      maps_(params, strand, fleet, content),
      findings_(params, strand, fleet, content),
      cameras_(cameras),
      camera_commands_(strand, cameras) {
  sender_.on_late = [this](const Answer& answer) { late_stop(answer); };
}

bool Commands::known(const Request& request) const {
  return std::all_of(request.robots.begin(), request.robots.end(),
                     [this](const std::string& robot) { return fleet_.robot(robot) != nullptr; });
}

bool Commands::complete() const {
  const auto& robots = fleet_.robots();
  return !robots.empty() && std::all_of(robots.begin(), robots.end(), [](const auto& entry) {
    const RobotView& robot = entry.second;
    return robot.lost || (robot.described && robot.located && robot.owned && robot.behaviour_count > 0);
  });
}

bool Commands::must_wait(std::uint64_t handle, const Request& request) const {
  // A stop is never delayed: it is also sent to robots that were not heard yet.
  if (request.verb == verb("stop")) return false;
  // No command overtakes an earlier one for the same robot.
  if (std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
        return other.handle < handle && shares_robots(other.request, request);
      }))
    return true;
  if (!known(request) && fresh(params_.discovery_grace)) return true;
  if (request.verb == verb("down")) {
    // A robot that accepted a command a moment ago says in its next state what it does now.
    if (accepted_ && strand_.now() - *accepted_ < params_.settle) return true;
    return !request.has("--leave") && (fresh(params_.settle) || (fresh(2 * params_.settle) && !complete()));
  }
  if (request.info->runs != Runs::query && !request.all) return false;
  // Just after the start the first results are incomplete, and an absent robot looks like a late one.
  return fresh(params_.settle) || (fresh(2 * params_.settle) && !complete());
}

std::uint64_t Commands::execute(const Result<Request>& request, const Done& done) {
  if (!request) return refuse(request.error(), done);
  if (request->info->runs == Runs::terminal)
    return refuse({Reason::not_supported, std::string(request->info->name) + " works in a terminal only"},
                  done);
  return begin(*request, done);
}

std::uint64_t Commands::begin(const Request& request, Done done) {
  const std::uint64_t handle = next_handle_++;
  if (!must_wait(handle, request))
    run(handle, request, std::move(done));
  else if (waiting_.size() < kMaxWaiting)
    waiting_.push_back({handle, request, std::move(done)});
  else
    refuse(request, Reason::queue_full, std::string(describe(Reason::queue_full)), done);
  if (request.verb == verb("stop")) drop_waiting(handle, request);
  return handle;
}

void Commands::drop_waiting(std::uint64_t handle, const Request& stop) {
  const auto dropped = [&](const Waiting& other) {
    return other.handle < handle && ended_by_stop(other.request) && shares_robots(other.request, stop);
  };
  for (auto next = std::find_if(waiting_.begin(), waiting_.end(), dropped); next != waiting_.end();
       next = std::find_if(waiting_.begin(), waiting_.end(), dropped)) {
    const Waiting ended = std::move(*next);
    waiting_.erase(next);
    refuse(ended.request, Reason::stopped, "not sent, as a stop was given after it", ended.done);
  }
}

void Commands::refuse(const Request& request, Reason reason, const std::string& text, const Done& done) {
  note({.command = std::string(request.info->name), .reason = reason, .text = text});
  done(refused_outcome(request, reason, text));
}

std::uint64_t Commands::refuse(const Error& error, const Done& done) {
  note({.reason = error.reason, .text = error.text});
  done(failed_outcome(kExitUsage, error));
  return next_handle_++;
}

void Commands::run_waiting() {
  const auto ready = [this] {
    return std::find_if(waiting_.begin(), waiting_.end(),
                        [this](const Waiting& next) { return !must_wait(next.handle, next.request); });
  };
  for (auto next = ready(); next != waiting_.end(); next = ready()) {
    Waiting due = std::move(*next);
    waiting_.erase(next);
    run(due.handle, due.request, std::move(due.done));
  }
}

void Commands::run(std::uint64_t handle, const Request& request, Done done) {
  if (request.all && request.robots.empty() && request.verb != verb("stop")) {
    const auto named = with_robots_named(request, fleet_);
    if (named) return run(handle, *named, std::move(done));
    return refuse(request, named.reason(), named.error().text, done);
  }
  if (request.info->runs == Runs::query) return answer_query(request, done);
  if (request.verb == verb("up")) {
    presence_.go_up();
    return done(done_outcome(request, "station " + params_.name + " is up\n"));
  }
  if (!presence_.up())
    return refuse(request, Reason::no_station, std::string(describe(Reason::no_station)), done);
  if (request.verb == verb("down")) return down(request, done);
  if (request.info->first_word() == "finding") return findings_.run(request, done);
  if (request.info->first_word() == "camera") return camera_commands_.run(request, done);
  if (request.verb == verb("stop") && request.all) return stop_all(request, done);
  if (request.verb == verb("convoy start")) return start_convoy(handle, request, std::move(done));
  if (request.verb == verb("convoy stop")) return stop_convoy(handle, request, done);
  if (request.verb == verb("stairs go")) return go_over_stairs(handle, request, done);
  command_robots(handle, request, request, reported_to(std::move(done)));
}

void Commands::answer_query(const Request& request, const Done& done) {
  if (request.info->first_word() == "map") return maps_.run(request, done);
  if (request.verb == verb("cameras")) return done(cameras_outcome(request, fleet_, cameras_));
  const Time now = strand_.now();
  const Outcome outcome =
      query_outcome(request, {params_, fleet_, sender_.counts(), content_, now - started_, now});
  if (request.has("--export") && outcome.exit_code == kExitDone) return findings_.write_file(request, done);
  done(outcome);
}

Gather::Done Commands::reported_to(Done done) const {
  return [this, done = std::move(done)](const Gather& gather) { done(gather.outcome(params_.name)); };
}

void Commands::command_robots(std::uint64_t handle, const Request& request, const Request& answered,
                              Gather::Done done) {
  const auto gather = std::make_shared<Gather>(answered, std::move(done));
  for (const std::string& robot : answered.robots) command_robot(handle, robot, request, gather);
  gather->close();
}

void Commands::command_robot(std::uint64_t handle, const std::string& robot, const Request& request,
                             const std::shared_ptr<Gather>& gather) {
  // What it does when it is released shows its state before that.
  const RobotView* state = fleet_.robot(robot);
  const std::string then = request.verb == verb("release") && state
                               ? after_release(described(*state, strand_.now())).text
                               : std::string();
  const auto ended = [this, gather, then, index = gather->expect(robot)](Answer answer) {
    answer.command = gather->request().info->name;
    if (!then.empty() && (answer.accepted || answer.reason == Reason::no_answer)) answer.text = then;
    if (answer.reason == Reason::mode_unknown)
      answer.text += nearest_mode(fleet_.robot(answer.robot), gather->request().word("MODE"));
    if (answer.route) answer.text = route_text(*answer.route);
    note(answer);
    gather->take(index, std::move(answer));
  };
  if (!fleet_.robot(robot) && request.verb != verb("stop"))
    return ended({.robot = robot, .reason = Reason::unknown_robot, .text = unknown_text(fleet_)});
  ++commanded_[robot];
  const FlowDependencies dependencies{strand_, fleet_, sender_, stick_};
  const auto start = [&](const std::shared_ptr<Flow>& flow) {
    if (const auto started = flows_.start(handle, flow); !started)
      ended({.robot = robot, .reason = started.error().reason, .text = started.error().text});
  };
  if (const auto steer = steering(request))
    return start(std::make_shared<Steer>(dependencies, robot, *steer, ended));
  if (request.verb == verb("stop")) flows_.end_drives(robot, Reason::stopped);
  const bool asks_for_mode = !request.info->conditions.mode.empty();
  if (asks_for_mode && request.word("MODE") == "hold") flows_.end_drives(robot, Reason::cancelled);
  const Flow::Done answered =
      asks_for_mode ? flows_.end_drives_when_accepted(robot) : Flow::Done([](const Answer&) {});
  RobotCommand robot_command{.robot = robot, .request = request};
  if (request.verb == verb("goto") && request.has("--wait"))
    return start(std::make_shared<Arrival>(dependencies, std::move(robot_command), answered, ended));
  sender_.send(std::move(robot_command), [answered, ended](const Answer& answer) {
    answered(answer);
    ended(answer);
  });
}

void Commands::start_convoy(std::uint64_t handle, const Request& request, Done done) {
  Request join(verb("join"), request.robots);
  join.values = {{"ROBOT", request.robots, {}},
                 {"ID", {}, {static_cast<double>(1 + random_.below(std::uint64_t{1} << 52))}}};
  for (const char* option : {"--gap", "--speed"})
    if (const auto* given = request.find(option)) join.values.push_back(*given);
  command_robots(handle, join, request, [this, done = std::move(done)](const Gather& gather) {
    Outcome outcome = gather.outcome(params_.name);
    const auto& answers = gather.answers();
    const auto first =
        std::find_if(answers.begin(), answers.end(), [](const Answer& answer) { return !answer.accepted; });
    if (first == answers.end()) return done(outcome);
    // All or none: the robots that accepted leave again. One that did not answer may have accepted.
    std::vector<std::string> others;
    for (const Answer& answer : answers)
      if ((answer.accepted || !answer.answered) && fleet_.robot(answer.robot)) others.push_back(answer.robot);
    if (!others.empty()) outcome.error += "no convoy: taken back from " + command::joined(others, "") + "\n";
    last_answer_ = *first;  // The refusal, whichever answer arrived last.
    done(outcome);
    for (const std::string& robot : others)
      sender_.send({.robot = robot, .request = Request(verb("peeloff"))}, [](const Answer&) {});
  });
}

void Commands::stop_convoy(std::uint64_t handle, Request request, const Done& done) {
  // A robot that does not know of a convoy says so itself.
  if (const RobotView* robot = fleet_.robot(request.robots.front()); robot && !robot->convoy.empty())
    request.robots = robot->convoy;
  command_robots(handle, Request(verb("peeloff"), request.robots), request, reported_to(done));
}

void Commands::go_over_stairs(std::uint64_t handle, const Request& request, const Done& done) {
  const auto goals =
      stairs_way(request, stairs_report(content_.desk(), content_.book(), content_.chunks(), fleet_));
  if (!goals) return refuse(request, goals.reason(), goals.error().text, done);
  if (goals->size() == 1 || !known(request))
    return command_robots(handle, goals->front(), request, reported_to(done));
  const std::string robot = request.robots.front();
  const std::uint64_t command = ++commanded_[robot];
  const auto gather = std::make_shared<Gather>(request, reported_to(done));
  const auto taken = [this, gather, index = gather->expect(robot)](Answer answer) {
    answer.command = gather->request().info->name;
    note(answer);
    gather->take(index, std::move(answer));
  };
  gather->close();
  const auto accepted = std::make_shared<bool>(false);
  const auto later = [this, name = request.info->name](Answer answer) {
    answer.command = name;
    note(answer);
  };
  const auto flow = std::make_shared<Arrival>(
      FlowDependencies{strand_, fleet_, sender_, stick_},
      RobotCommand{.robot = robot, .request = goals->front()},
      [accepted, taken, ended = flows_.end_drives_when_accepted(robot)](const Answer& answer) {
        *accepted = answer.accepted;
        ended(answer);
        taken(answer);
      },
      [this, accepted, later, robot, command, far = goals->back()](const Answer& at_near_end) {
        // A state from before a later command of the operator may show that it arrived.
        if (!*accepted || commanded_[robot] != command) return;
        if (!at_near_end.accepted) return later(at_near_end);
        // A state that was late on its way says where a robot was, not that it is there to be sent on.
        if (const RobotView* view = fleet_.robot(robot); !view || view->lost)
          return later(
              {.robot = robot,
               .reason = Reason::no_answer,
               .text = "it came to the stairs, but is not heard any more, and is not sent over them"});
        sender_.send({.robot = robot, .request = far}, later);
      });
  // It goes on when the command line that began it has ended.
  constexpr std::uint64_t kNoLine = 0;
  if (const auto started = flows_.start(kNoLine, flow); !started)
    taken({.robot = robot, .reason = started.error().reason, .text = started.error().text});
}

void Commands::stop_all(const Request& request, const Done& done) {
  stop_alls_.push_back(std::make_shared<Gather>(request, [this, done](const Gather& gather) {
    Outcome outcome = gather.outcome(params_.name);
    if (gather.answers().empty()) {
      outcome.exit_code = 3;
      outcome.error = "no robot has been heard; nothing was stopped\n";
      outcome.json.update({{"exit", 3}, {"ok", false}});
    }
    done(outcome);
  }));
  ask_stop(stop_alls_.back());
  if (!fresh(params_.discovery_grace)) close_stop_alls();
}

void Commands::ask_stop(std::shared_ptr<Gather> all) {
  for (const std::string& robot : fleet_.robot_names())
    if (!all->expects(robot)) command_robot(0, robot, all->request(), all);
}

void Commands::close_stop_alls() {
  for (const auto& all : std::exchange(stop_alls_, {})) all->close();
}

void Commands::down(const Request& request, const Done& done) {
  Request release(verb("release"));
  nlohmann::json robots = nlohmann::json::array();
  std::string lines;
  bool all_rest = true;
  for (const auto& [robot_name, robot] : fleet_.robots()) {
    if (!robot.mine) continue;
    const AfterRelease after = after_release(described(robot, strand_.now()));
    release.robots.push_back(robot_name);
    robots.push_back(
        {{"robot", robot_name}, {"mode", robot.mode}, {"rests", after.rests}, {"then", after.text}});
    lines += robot_name + ": " + after.text + "\n";
    all_rest = all_rest && after.rests;
  }
  if (!all_rest && !request.has("--leave")) {
    const std::string text = "refused: " + std::string(describe(Reason::would_go_on)) + " [" +
                             std::string(name(Reason::would_go_on)) + "]";
    note({.command = std::string(request.info->name), .reason = Reason::would_go_on, .text = text});
    Outcome outcome = refused_outcome(request, Reason::would_go_on, text);
    outcome.error += lines;
    outcome.json["robots"] = std::move(robots);
    return done(outcome);
  }
  const auto gather =
      std::make_shared<Gather>(release, [this, request, done, robots](const Gather& released) {
        presence_.go_down();
        const std::vector<std::string> unheard = sender_.drop_unheard();
        // A robot that does not answer keeps its holder; the station still closes, and reports this.
        const Outcome answers = released.outcome(params_.name);
        Outcome outcome =
            done_outcome(request, answers.text, {{"results", answers.json["results"]}, {"robots", robots}});
        outcome.error = answers.error;
        if (!unheard.empty())
          outcome.text +=
              "never acknowledged a stop, which no longer goes out: " + command::joined(unheard, "") + "\n";
        outcome.text += "station " + params_.name + " is down\n";
        done(outcome);
        if (on_down) on_down();
      });
  for (const std::string& robot : release.robots) {
    flows_.end_drives(robot, Reason::cancelled);
    command_robot(0, robot, release, gather);
  }
  gather->close();
}

void Commands::note(const Answer& answer) {
  last_answer_ = answer;
  if (on_answer) on_answer();
}

void Commands::late_stop(const Answer& answer) {
  note(answer);
  const std::string end = answer.accepted ? "acknowledged the stop that was sent before it was heard"
                          : answer.answered
                              ? "refused the stop that was sent before it was heard: " + answer.text
                              : "did not acknowledge the stop: " + answer.text;
  fleet_.say({.severity = answer.accepted ? Severity::info : Severity::warning,
              .code = answer.accepted ? "stop_acknowledged" : "stop_not_acknowledged",
              .reason = answer.reason,
              .text = answer.robot + " " + end,
              .robot = answer.robot},
             strand_.now());
}

void Commands::cancel(std::uint64_t handle) {
  flows_.cancel(handle);
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Waiting& command) { return command.handle == handle; });
  if (found == waiting_.end()) return;
  const Waiting dropped = std::move(*found);
  waiting_.erase(found);
  dropped.done(refused_outcome(dropped.request, Reason::cancelled, "cancelled"));
}

void Commands::hear(const radio::Acknowledgement& sample, const wire::SampleInfo& info) {
  const auto ack = contract::decode(sample);
  if (!ack || ack->station != params_.name || ack->station_id != params_.id) return;
  // Another robot of that name also answers.
  if (!fleet_.speaks_for(ack->robot, info.sender)) return;
  fleet_.learn_authority(ack->robot, ack->holder, ack->epoch);
  if (ack->accepted()) accepted_ = strand_.now();
  if (ack->seq != 0) return sender_.hear(*ack);
  flows_.stream_refused(ack->robot, ack->reason, ack->text);
}

void Commands::tick() {
  maps_.follow_robots();
  flows_.drop_ended();
  run_waiting();
  for (const auto& all : std::vector(stop_alls_)) ask_stop(all);
  if (!stop_alls_.empty() && !fresh(params_.discovery_grace)) close_stop_alls();
}

}  // namespace adit::station
