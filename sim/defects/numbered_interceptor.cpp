// SPDX-License-Identifier: Apache-2.0
#include "sim/defects/numbered_interceptor.hpp"

#include <algorithm>

namespace adit::sim {

void NumberedInterceptor::pass(CommandFrom command, std::vector<Arrival>& out) {
  radio::Command& c = command.sample;
  c.seq(c.seq() * kSpacing);
  std::uint64_t& newest = newest_[command.info.sender];
  newest = std::max(newest, c.seq());
  out.push_back(arrival(command));
}

std::uint64_t NumberedInterceptor::next(const wire::ParticipantId& participant) {
  std::uint64_t& newest = newest_[participant];
  if (newest % kSpacing != kSpacing - 1) ++newest;
  return newest;
}

void NumberedInterceptor::pass_as_new(CommandFrom command, std::vector<Arrival>& out) {
  radio::Command& c = command.sample;
  const Asked asked{c.station(), c.station_id(), c.seq()};
  c.seq(next(command.info.sender));
  asked_[{c.station_id(), c.seq()}] = asked;
  out.push_back(arrival(command));
}

void NumberedInterceptor::pass_as_holders(const CommandFrom& command, std::vector<Arrival>& out) {
  const auto holder = holders_participant();
  if (!holder) return pass(command, out);
  const auto [it, fresh] = strangers_.try_emplace({command.info.sender, command.sample.seq()}, command);
  CommandFrom& as = it->second;
  if (fresh) {
    radio::Command& c = as.sample;
    const Asked asked{c.station(), c.station_id(), c.seq()};
    as.info.sender = *holder;
    c.station(authority().holder());
    c.station_id(authority().holder_id());
    c.epoch(authority().epoch());
    c.seq(next(*holder));
    asked_[{c.station_id(), c.seq()}] = asked;
  }
  out.push_back(arrival(as));
}

void NumberedInterceptor::give(radio::CommandKind kind, std::vector<Arrival>& out, std::string_view word,
                               std::uint16_t options) {
  const auto holder = holders_participant();
  if (!holder) return;
  CommandFrom command{{}, {*holder, now()}};
  radio::Command& c = command.sample;
  c.robot(authority().robot());
  c.station(authority().holder());
  c.station_id(authority().holder_id());
  c.epoch(authority().epoch());
  c.kind(kind);
  if (!word.empty()) c.words({std::string(word)});
  c.options(options);
  c.seq(next(*holder));
  asked_[{c.station_id(), c.seq()}] = {};
  out.push_back(arrival(command));
}

bool NumberedInterceptor::on_answer(radio::Acknowledgement& answer) {
  const auto found = asked_.find({answer.station_id(), answer.seq()});
  if (found == asked_.end()) {
    answer.seq(answer.seq() / kSpacing);
    return true;
  }
  const Asked& asked = found->second;
  if (asked.seq == 0) return false;
  answer.station(asked.station);
  answer.station_id(asked.id);
  answer.seq(asked.seq);
  return true;
}

}  // namespace adit::sim
