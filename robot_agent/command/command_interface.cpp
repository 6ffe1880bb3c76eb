// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command/command_interface.hpp"

#include <algorithm>

#include "robot_agent/convoy/convoy.hpp"

namespace adit::agent {
namespace {

using command::verb;

/// Asks the supervisor, if there is one.
template <class Function, class... Arguments>
Result<void> supervised(const Function& function, const Arguments&... arguments) {
  if (!function) return {Reason::not_supported, std::string(describe(Reason::not_supported))};
  return function(arguments...);
}

/// Whether the command only queries state and changes nothing. The answer to every other accepted command is
/// stored before it is sent, even if the command changed nothing: a repeat after a restart must not have an
/// effect that the first command did not have.
bool is_question(const command::CommandInfo& row) {
  return !row.conditions.holder && row.line == command::Line::none;
}

ConvoyOrder convoy_of(const command::Request& request) {
  ConvoyOrder order{};
  order.convoy = static_cast<std::uint64_t>(request.number("ID"));
  if (const auto* names = request.find("ROBOT")) order.robots = names->words;
  order.gap = request.number("--gap");
  order.speed = request.number("--speed");
  return order;
}

nav::Area area_of(const command::Request& request) {
  nav::Area area{.name = request.word("NAME"), .weight = request.number("--weight")};
  const auto kind = std::find(std::begin(nav::kAreaKinds), std::end(nav::kAreaKinds), request.word("KIND"));
  area.kind = static_cast<nav::AreaKind>(kind - std::begin(nav::kAreaKinds));
  const std::vector<double> corners = request.numbers("X Y"), z = request.numbers("--z");
  for (std::size_t i = 0; i + 1 < corners.size(); i += 2)
    area.corners.emplace_back(corners[i], corners[i + 1]);
  if (z.size() == 2) {
    area.z_min = z[0];
    area.z_max = z[1];
  }
  return area;
}

}  // namespace

CommandInterface::CommandInterface(CommandParams params, Requests& requests, Outputs outputs)
    : params_(std::move(params)),
      requests_(requests),
      outputs_(std::move(outputs)),
      authority_(params_.epoch_start, params_.lock_lease) {}

StoredAuthority CommandInterface::stored() const {
  StoredAuthority stored{authority_.epoch(), authority_.holder(), {}, authority_.locked(), stops_.all()};
  if (const Station* station = holders_station()) stored.speaker = station->binding.stored();
  return stored;
}

const Station* CommandInterface::holders_station() const {
  const auto& holder = authority_.holder();
  const Station* known = holder ? stations_.find(holder->name) : nullptr;
  return known && known->id == holder->id ? known : nullptr;
}

const wire::ParticipantId* CommandInterface::holders_participant() const {
  const Station* station = holders_station();
  return station ? &station->binding.participant() : nullptr;
}

void CommandInterface::restore(const StoredAuthority& stored, const std::vector<StoredAnswers>& answers,
                               Time now) {
  authority_.restore(stored.holder, stored.locked, stored.epoch.counter, now);
  if (stored.holder && stored.speaker)
    stations_.restore(stored.holder->name, stored.holder->id, *stored.speaker, now);
  for (const Party& stopper : stored.stops) stops_.set(stopper);
  memory_.restore(answers, now);
}

void CommandInterface::hear(const MessageSender& from, std::uint16_t protocol, Time now) {
  if (!valid_name(from.name)) return;
  if (identify(from, StationTable::Sign::presence, now).reason == Reason::none)
    stations_.announce(from.name, protocol);
}

std::optional<Answer> CommandInterface::handle(const Command& c, Time now) {
  if (const Answer* first = memory_.find(c.from.participant, c.seq)) {
    identify(c.from, StationTable::Sign::command, now);  // A repeat also counts as a heartbeat.
    Answer again = *first;
    if (again.epoch == Epoch{}) {  // It was given before a restart: holder and epoch may have changed since.
      again.holder = authority_.holder_name();
      again.epoch = authority_.epoch();
    }
    return again;
  }
  const Outcome outcome = judge(c, now);
  const Answer result = answer(c, outcome);
  // A command with an invalid name is refused each time and needs no memory or disk space.
  if (c.seq != 0 && valid_name(c.from.name))
    memory_.remember(c.from.participant, result, c.request.info->line, !is_question(*c.request.info), now,
                     holders_participant());
  return result;
}

CommandInterface::Outcome CommandInterface::judge(const Command& c, Time now) {
  const bool stops = c.request.verb == verb("stop");
  if (c.robot != params_.robot) return {Reason::wrong_robot};
  if (!valid_name(c.from.name)) return {Reason::bad_argument, "a station's name is 1 to 32 of [A-Za-z0-9_-]"};
  if (const Outcome identity = identify(c.from, StationTable::Sign::command, now);
      identity.reason != Reason::none) {
    if (identity.reason == Reason::identity_mismatch && !may_be_back(c.from))
      report_intruder(c.from.name, c.from.participant, now);
    // A stop needs no authority: it is accepted without proof of the station's identity, without an entry in
    // the table, and under a name that another station has (rule 4). Its latch has the id of who sent it.
    if (!stops) return identity;
  }
  if (c.seq == 0) return {Reason::bad_argument, "command numbers start at 1"};
  if (!stops && !is_meant(c.epoch)) return {Reason::name_taken};
  if (memory_.too_old(c.from.participant, c.seq, stops ? Line::none : c.request.info->line))
    return {Reason::stale_sequence};
  const Station* station = stations_.find(c.from.name);
  if (!stops && station && station->protocol != 0 && station->protocol != params_.protocol)
    return {Reason::wrong_protocol};
  if (c.request.info->conditions.holder) {
    const Outcome holds = check_holder(c);
    if (holds.reason != Reason::none) return holds;
  }
  return perform(c, now);
}

CommandInterface::Outcome CommandInterface::identify(const MessageSender& from, StationTable::Sign sign,
                                                     Time now) {
  const bool holds = authority_.held_by(from.name, from.id);
  const auto verdict = stations_.hear(from, sign, authority_.holder(), now);
  if (verdict.rejected) report_intruder(from.name, *verdict.rejected, now);
  // A claim to be restarted suffices: a manual mode must not continue meanwhile.
  if (holds && verdict.restarted) requests_.holder_restarted(now);
  if (verdict.reason == Reason::none) {
    if (outputs_.accepted) outputs_.accepted(from);
    if (holds) authority_.hear(now);
    return {};
  }
  // Use of the holder's name by another station is an intrusion, not only a clash of names.
  if (verdict.reason == Reason::name_in_use && from.name == authority_.holder_name())
    return {Reason::identity_mismatch};
  return {verdict.reason};
}

CommandInterface::Outcome CommandInterface::check_holder(const Command& c) const {
  if (!authority_.holder()) return {Reason::nobody_holds};
  if (!authority_.held_by(c.from.name, c.from.id))
    return {Reason::not_holder, "held by " + authority_.holder_name() + "; take it first"};
  if (c.epoch != authority_.epoch()) return {Reason::stale_epoch};
  return {};
}

CommandInterface::Outcome CommandInterface::perform(const Command& c, Time now) {
  if (c.request.verb == verb("stop")) return stop(c, now);  // A stop is accepted with any arguments.
  if (c.invalid) return {c.invalid->reason, c.invalid->text};
  switch (c.request.verb) {
    case verb("take"):
      return take(c, now);
    case verb("release"):
      return release(c, now);
    case verb("grant"):
      return grant(c, now);
    case verb("reset"):
      return reset(c, now);
    case verb("mode"):
      return asked(c, requests_.request_mode(c.request.word("MODE"), now));
    case verb("goto"):
      return go_to(c, now);
    case verb("home"):
      return asked(c, requests_.request_goal(params_.home, now));
    case verb("explore"):
      return explore(c, now);
    case verb("area add"):
      return outcome(requests_.add_area(area_of(c.request), now));
    case verb("area remove"):
      return outcome(requests_.remove_area(c.request.word("NAME"), now));
    case verb("pose"):
      return outcome(
          requests_.set_pose({c.request.number("X"), c.request.number("Y"), c.request.number("YAW")}, now));
    case verb("join"):
      return asked(c, requests_.join_convoy(convoy_of(c.request), now));
    case verb("peeloff"):
      return outcome(requests_.leave_convoy(now));
    case verb("yield"):
      return outcome(requests_.allow_yield(c.request.word("WAY") == "on", now));
    case verb("lock"):
      authority_.lock();
      outputs_.changed();
      return {};
    case verb("unlock"):
      authority_.unlock();
      outputs_.changed();
      return {};
    case verb("query"):
    case verb("plan"):  // RadioEdge asks the global planner and adds the route to the answer.
      return {};
    case verb("restart"):
      return outcome(supervised(outputs_.restart, c.request.word("COMPONENT")));
    case verb("policy"):
      return outcome(
          supervised(outputs_.policy, c.request.word("COMPONENT"), c.request.word("POLICY") == "auto"));
    default:
      return {Reason::unknown_command};
  }
}

CommandInterface::Outcome CommandInterface::go_to(const Command& c, Time now) {
  if (c.goal && c.goal->reason != Reason::none && c.goal->reason != Reason::goal_unseen)
    return asked(c, Error{c.goal->reason, c.goal->text});
  const Outcome outcome = asked(c, requests_.request_goal(c.goal ? c.goal->place : place_of(c.request), now));
  if (outcome.reason != Reason::none) return outcome;
  requests_.limit_unknown(c.request.number("--budget"));
  if (!c.goal || c.goal->text.empty()) return {};
  const bool unseen = c.goal->reason == Reason::goal_unseen;
  notify(c.from.name, unseen ? Severity::warning : Severity::info, unseen ? "goal_unseen" : "goal_moved",
         c.goal->reason, c.goal->text);
  return {Reason::none, c.goal->text};
}

CommandInterface::Outcome CommandInterface::explore(const Command& c, Time now) {
  ExploreRequest request{};
  request.after = after_exploring(c.request.word("--after"));
  if (c.request.has("--for")) request.limit = c.request.number("--for");
  request.area = c.request.word("--area");
  return asked(c, requests_.request_explore(request, now));
}

CommandInterface::Outcome CommandInterface::take(const Command& c, Time now) {
  if (authority_.held_by(c.from.name, c.from.id)) return {};
  tick(now);  // Ends a lock that expired since the last tick.
  const std::string former = authority_.holder_name();
  if (authority_.locked()) {
    notify(former, Severity::info, "asked", Reason::locked, c.from.name + " asked for " + params_.robot);
    return {Reason::locked, "locked by " + former + ", who is notified of your request"};
  }
  authority_.give({c.from.name, c.from.id}, now);
  requests_.holder_changed(now);
  if (!former.empty())
    notify(former, Severity::warning, "taken", Reason::none, c.from.name + " took " + params_.robot);
  outputs_.changed();
  return {};
}

CommandInterface::Outcome CommandInterface::release(const Command& c, Time now) {
  authority_.clear(now);
  requests_.holder_changed(now);
  notify({}, Severity::info, "released", Reason::none, c.from.name + " released " + params_.robot);
  outputs_.changed();
  return {};
}

CommandInterface::Outcome CommandInterface::grant(const Command& c, Time now) {
  const std::string to = c.request.word("OPERATOR");
  if (to == c.from.name) return {Reason::bad_argument, "you hold the robot already"};
  const Station* heir = stations_.find(to);
  if (!heir || !stations_.heard(to, now)) return {Reason::unknown_operator};
  const std::string text = c.from.name + " granted " + params_.robot + " to " + to;
  authority_.give({heir->name, heir->id}, now);
  requests_.holder_changed(now);
  notify(to, Severity::info, "granted", Reason::none, text);
  notify(c.from.name, Severity::info, "granted", Reason::none, text);
  outputs_.changed();
  return {};
}

CommandInterface::Outcome CommandInterface::stop(const Command& c, Time now) {
  const Party stopper{c.from.name, c.from.id};
  const bool fresh = !stops_.has(stopper);
  stops_.set(stopper);
  requests_.stop_changed(true, now);
  if (fresh && authority_.holder() && *authority_.holder() != stopper)
    notify(authority_.holder_name(), Severity::warning, "stopped", Reason::stopped,
           c.from.name + " stopped " + params_.robot);
  if (fresh) outputs_.changed();
  return {};
}

CommandInterface::Outcome CommandInterface::reset(const Command& c, Time now) {
  const bool others = c.request.has("--override");
  const Party own{c.from.name, c.from.id};
  if (!stops_.any()) return {};
  if (!others && !stops_.has(own))
    return {Reason::stop_of_another, "stopped by " + stops_.all().front().name + "; use reset --override"};
  std::string text{};
  if (others) {
    for (const Party& stopper : stops_.all()) {
      if (stopper == own) continue;
      const std::string notice = c.from.name + " reset the stop of " + stopper.name + " on " + params_.robot;
      notify(stopper.name, Severity::warning, "reset", Reason::none, notice);
      notify(c.from.name, Severity::info, "reset", Reason::none, notice);
    }
    stops_.clear_all();
  } else {
    stops_.clear(own);
    if (stops_.any()) text = "still stopped by " + stops_.all().front().name;
  }
  requests_.stop_changed(stops_.any(), now);
  outputs_.changed();
  return {Reason::none, text};
}

CommandInterface::Outcome CommandInterface::asked(const Command& c, const Result<void>& result) const {
  if (result) return {};
  notify(c.from.name, Severity::warning, "mode_refused", result.reason(), result.error().text);
  return {result.reason(), result.error().text};
}

std::optional<Answer> CommandInterface::handle(const StickSample& s, Time now) {
  const Outcome outcome = judge(s, now);
  if (outcome.reason == Reason::none) return std::nullopt;
  if (!stream_refusals_.pass(s.participant, now)) return std::nullopt;
  const Station* station = stations_.by_participant(s.participant);
  Command as_command{};
  as_command.from = {station ? station->name : std::string{}, s.station_id, s.participant};
  return answer(as_command, outcome);
}

CommandInterface::Outcome CommandInterface::judge(const StickSample& s, Time now) {
  if (s.robot != params_.robot) return {Reason::wrong_robot};
  if (!is_meant(s.epoch)) return {Reason::name_taken};
  const auto& holder = authority_.holder();
  if (!holder) return {Reason::nobody_holds};
  const Station* bound = holders_station();
  const bool right_one = bound && bound->binding.participant() == s.participant;
  if (!right_one) {
    if (s.station_id != holder->id)
      return {Reason::not_holder, "held by " + holder->name + "; take it first"};
    if (!may_be_back({holder->name, s.station_id, s.participant}))
      report_intruder(holder->name, s.participant, now);
    return {Reason::identity_mismatch};
  }
  if (s.station_id != holder->id) return {Reason::identity_mismatch};
  if (s.epoch != authority_.epoch()) return {Reason::stale_epoch};
  const Time received = now - s.waited;
  stick_heard_ = received;
  if (const Reason reason = gate_.judge(s, now); reason != Reason::none) return {reason};
  identify({holder->name, holder->id, s.participant}, StationTable::Sign::command, now);  // A heartbeat.
  const Result<void> taken = requests_.stick(s.twist, received);
  return taken ? Outcome{} : Outcome{taken.reason(), taken.error().text};
}

void CommandInterface::tick(Time now) {
  if (!authority_.lapse(now)) return;
  notify({}, Severity::warning, "lock_lapsed", Reason::none,
         "the lock of " + authority_.holder_name() + " on " + params_.robot +
             " lapsed: not heard for its lease");
  outputs_.changed();
}

bool CommandInterface::unlock_at_console() {
  if (!authority_.locked()) return false;
  authority_.unlock();
  notify({}, Severity::warning, "lock_lapsed", Reason::none,
         "the lock of " + authority_.holder_name() + " on " + params_.robot +
             " was ended at the robot's console");
  outputs_.changed();
  return true;
}

Answer CommandInterface::answer(const Command& c, const Outcome& outcome) const {
  std::string text = outcome.text;
  if (text.empty() && outcome.reason != Reason::none) text = describe(outcome.reason);
  return {.station = c.from.name,
          .station_id = c.from.id,
          .seq = c.seq,
          .reason = outcome.reason,
          .text = std::move(text),
          .holder = authority_.holder_name(),
          .epoch = authority_.epoch()};
}

bool CommandInterface::may_be_back(const MessageSender& from) const {
  const Station* known = stations_.find(from.name);
  return known && known->id == from.id && known->binding.claimed_by(from.participant);
}

void CommandInterface::report_intruder(const std::string& name, const wire::ParticipantId& participant,
                                       Time now) {
  if (!authority_.holder() || !intruders_.pass(participant, now)) return;
  notify(authority_.holder_name(), Severity::error, "intruder", Reason::identity_mismatch,
         "participant " + wire::to_string(participant) + " claims to be " + name + " on " + params_.robot);
}

void CommandInterface::notify(const std::string& to, Severity severity, const char* code, Reason reason,
                              std::string text) const {
  outputs_.notify({to, severity, code, reason, std::move(text)});
}

}  // namespace adit::agent
