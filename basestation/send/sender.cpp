// SPDX-License-Identifier: Apache-2.0
#include "basestation/send/sender.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "adit/command.h"
#include "core/command/words.hpp"
#include "core/contract/command.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

using namespace std::chrono_literals;

struct Sender::Pending {
  RobotCommand robot_command{};
  std::vector<Done> done{};
  contract::Command message{};
  Time first_sent{};
  Time waits_since{};  ///< Start of the time limit; not started for a robot that was not heard yet.
  Time repeated{};
  Timer timer{};
  bool reported{};   ///< It was reported as not acknowledged yet.
  bool overtaken{};  ///< A stop with a higher number was sent after it.
  bool blind{};      ///< It was sent before this station knew the authority in force.
  bool resting{};    ///< It was refused for a temporary cause, and is sent again at the next repeat.
  Answer refusal{};  ///< The refusal.
  bool is_stop() const { return robot_command.request.verb == command::verb("stop"); }
};

struct Sender::Lane {
  wire::Writer<radio::Command> writer{};
  std::uint64_t next_seq{1};
  std::deque<std::shared_ptr<Pending>> queue{};
  std::shared_ptr<Pending> current{};
  std::shared_ptr<Pending> stop{};
};

Sender::Sender(SenderParams params, Executor& strand, wire::Participant& radio, Fleet& fleet)
    : params_(std::move(params)), strand_(strand), radio_(radio), fleet_(fleet), started_(strand.now()) {}

Sender::~Sender() = default;

Sender::Lane* Sender::lane(const std::string& robot) {
  const auto found = lanes_.find(robot);
  if (found != lanes_.end()) return found->second.get();
  if (lanes_.size() == Fleet::kMaxRobots + kMaxUnheard) return nullptr;
  auto writer = wire::Writer<radio::Command>::make(radio_, wire::topics::kCommand, robot);
  if (!writer) return nullptr;
  auto made = std::make_shared<Lane>();
  made->writer = std::move(*writer);
  made->next_seq = first_seq_;
  return lanes_.emplace(robot, std::move(made)).first->second.get();
}

void Sender::prepare(const std::string& robot) { lane(robot); }

void Sender::send(RobotCommand robot_command, Done done) {
  if (unheard(robot_command.robot) && !lanes_.contains(robot_command.robot)) make_room();
  Lane* to = lane(robot_command.robot);
  if (!to) {
    return done({.robot = robot_command.robot,
                 .command = std::string(robot_command.name()),
                 .reason = Reason::wire_failed,
                 .text = "the network layer has no writer left for this robot"});
  }
  auto pending = std::make_shared<Pending>();
  pending->robot_command = std::move(robot_command);
  pending->done.push_back(std::move(done));
  if (pending->is_stop()) {
    if (to->stop) {  // A stop is pending: the same answer serves both.
      to->stop->done.push_back(std::move(pending->done.front()));
      return;
    }
    if (to->current) to->current->overtaken = true;
    to->stop = pending;
    return start(*to, pending);
  }
  if (to->current && to->queue.size() == kMaxQueue) {
    return pending->done.front()({.robot = pending->robot_command.robot,
                                  .command = std::string(pending->robot_command.name()),
                                  .reason = Reason::queue_full,
                                  .text = "16 commands wait for this robot already"});
  }
  if (to->current) {
    to->queue.push_back(std::move(pending));
    return;
  }
  to->current = pending;
  start(*to, pending);
}

void Sender::make_room() {
  std::size_t count = 0;
  const std::string* oldest = nullptr;
  Time since{};
  for (const auto& [robot, lane] : lanes_) {
    if (!unheard(robot)) continue;
    ++count;
    if (lane->current) continue;
    // A lane without a stop is closed first.
    const Time sent = lane->stop ? lane->stop->first_sent : Time::min();
    if (oldest && sent >= since) continue;
    oldest = &robot;
    since = sent;
  }
  if (count < kMaxUnheard || !oldest) return;
  close_lane(*oldest, "it no longer goes out: it gave way to newer stops for robots that were not heard");
}

void Sender::close_lane(std::string robot, const std::string& why) {
  const auto found = lanes_.find(robot);
  const std::shared_ptr<Lane> lane = found->second;
  lanes_.erase(found);
  // A used number would get the robot's first answer to it again.
  first_seq_ = std::max(first_seq_, lane->next_seq);
  if (const std::shared_ptr<Pending> stop = lane->stop)
    finish(*lane, stop, {.reason = Reason::no_answer, .text = why});
}

void Sender::start(Lane& to, std::shared_ptr<Pending> pending) {
  pending->first_sent = pending->waits_since = pending->repeated = strand_.now();
  renumber(to, *pending);
  ++counts_.sent;
  const Duration repeat = pending->is_stop() ? params_.repeat_stop : params_.repeat;
  pending->timer = strand_.every(
      repeat, [this, robot = pending->robot_command.robot, weak = std::weak_ptr<Pending>(pending)] {
        if (auto alive = weak.lock()) tick(robot, alive);
      });
  transmit(to, *pending);
}

void Sender::renumber(Lane& to, Pending& pending) {
  contract::Command& message = pending.message;
  message = {.robot = pending.robot_command.robot,
             .station = params_.name,
             .station_id = params_.id,
             .epoch = message.epoch,
             .seq = to.next_seq++,
             .request = pending.robot_command.request};
  if (const RobotView* robot = fleet_.robot(message.robot)) {
    message.epoch = robot->epoch;
    pending.blind = !robot->owned;
  }
  pending.resting = false;
  pending.overtaken = false;
}

void Sender::transmit(Lane& to, Pending& pending) {
  // The participant counts a sample that could not be queued, and the next repeat replaces it.
  (void)to.writer.write(encode(pending.message));
}

void Sender::tick(const std::string& robot, const std::shared_ptr<Pending>& pending) {
  constexpr Duration slow = 1s;
  const std::shared_ptr<Lane> lane = lanes_.at(robot);
  Lane& to = *lane;
  const Time now = strand_.now();
  const Duration limit = pending->is_stop() ? params_.give_up_stop : params_.give_up;
  if (pending->is_stop() && unheard(robot)) {
    pending->waits_since = now;
    report_unheard(*pending);
    if (to.stop != pending) return;  // A callback gave a command that ended this one.
    if (now - pending->first_sent >= limit && now - pending->repeated < slow) return;
  }
  if (now - pending->waits_since >= limit) {
    if (pending->resting) return finish(to, pending, pending->refusal);
    withdraw(to, *pending);
    const std::string text = "no answer within " + std::to_string(limit / 1s) + " s";
    return finish(to, pending, {.reason = Reason::no_answer, .text = text});
  }
  if (pending->resting) {
    renumber(to, *pending);
    if (pending->is_stop() && to.current) to.current->overtaken = true;
  } else {
    ++counts_.repeats;
  }
  pending->repeated = now;
  transmit(to, *pending);
}

void Sender::report_unheard(Pending& pending) const {
  const Time now = strand_.now();
  if (now - started_ < params_.discovery_grace || now - pending.first_sent < 1s) return;
  if (pending.done.empty()) return;
  pending.reported = true;
  const Answer answer{
      .robot = pending.robot_command.robot,
      .command = std::string(pending.robot_command.name()),
      .seq = pending.message.seq,
      .reason = Reason::no_answer,
      .text = "sent, not acknowledged yet: no robot of that name has been heard (known robots: " +
              command::joined(fleet_.robot_names(), "none") +
              "); while this station runs, the stop goes out until it is acknowledged"};
  for (const Done& done : std::exchange(pending.done, {})) done(answer);
}

std::vector<std::string> Sender::drop_unheard() {
  std::vector<std::string> lanes, names;
  for (const auto& [robot, lane] : lanes_) {
    if (!unheard(robot) || lane->current) continue;
    lanes.push_back(robot);
    if (lane->stop) names.push_back(robot);
  }
  for (const std::string& robot : lanes)
    if (lanes_.contains(robot)) close_lane(robot, "not acknowledged, and no longer sent");
  return names;
}

void Sender::withdraw(Lane& to, const Pending& pending) {
  // The writer stores its newest sample and retransmits it after a gap of any length: a query replaces it. A
  // late stop is harmless, and a pending stop has replaced the sample already.
  if (pending.is_stop() || to.stop) return;
  contract::Command question = pending.message;
  question.seq = to.next_seq++;
  question.request = command::Request(command::verb("query"));
  (void)to.writer.write(encode(question));
}

bool Sender::worth_another(const Pending& pending, const contract::Acknowledgement& ack) const {
  const Reason reason = ack.reason;
  // The robot never received it: a stop overtook it, or a later command overtook a lost stop.
  if (reason == Reason::stale_sequence && (pending.overtaken || pending.is_stop())) return true;
  // A restarted station did not know the epoch yet; the refusal contains it.
  if (reason == Reason::stale_epoch && pending.blind) return true;
  // The robot's agent was restarted while this was pending, and this station is still the holder.
  if (reason == Reason::stale_epoch && ack.holder == params_.name &&
      ack.epoch.start != pending.message.epoch.start)
    return true;
  // The robot has not received this participant's presence yet.
  const bool unknown = reason == Reason::identity_mismatch || reason == Reason::unknown_station;
  return unknown && (pending.is_stop() || pending.first_sent - started_ < 5s);
}

void Sender::hear(const contract::Acknowledgement& ack) {
  const auto found = lanes_.find(ack.robot);
  if (found == lanes_.end()) return;
  Lane& to = *found->second;
  std::shared_ptr<Pending> pending;
  for (const auto& candidate : {to.stop, to.current})
    if (candidate && candidate->message.seq == ack.seq) pending = candidate;
  if (!pending || pending->resting) return;
  Answer answer{.seq = ack.seq,
                .accepted = ack.accepted(),
                .answered = true,
                .reason = ack.reason,
                .text = ack.text,
                .holder = ack.holder,
                .route = ack.route,
                .latency = strand_.now() - pending->first_sent};
  if (!ack.accepted() && worth_another(*pending, ack)) {
    pending->resting = true;
    pending->refusal = std::move(answer);
    return;
  }
  finish(to, pending, std::move(answer));
}

void Sender::finish(Lane& to, const std::shared_ptr<Pending>& pending, Answer answer) {
  answer.robot = pending->robot_command.robot;
  answer.command = pending->robot_command.name();
  if (answer.accepted)
    ++counts_.accepted;
  else
    ++(answer.answered ? counts_.refused : counts_.unanswered);
  pending->timer.cancel();
  if (to.stop == pending) {
    to.stop.reset();
  } else {
    to.current.reset();
    if (!to.queue.empty()) {
      to.current = to.queue.front();
      to.queue.pop_front();
      start(to, to.current);
    }
  }
  if (pending->reported && on_late) on_late(answer);
  for (const Done& done : pending->done) done(answer);
}

bool Sender::idle(const std::string& robot) const {
  const auto found = lanes_.find(robot);
  return found == lanes_.end() || (!found->second->current && !found->second->stop);
}

}  // namespace adit::station
