// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "sim/checker/rule.hpp"

namespace adit::sim {
namespace {

constexpr Duration kAnswerTime{150ms};
constexpr Duration kStreamAnswerPeriod{1s};

/// Rule 3: every command is answered, refusals with a numbered reason and a text; refused streams at most
/// once a second.
class Acknowledge : public Rule {
 public:
  void on_event(const RobotModel& robot, const Event& event,
                const ReportViolation& report_violation) override {
    if (std::get_if<AgentStarted>(&event)) {
      streams_.clear();
      reported_.clear();
    }
    if (const auto* sample = std::get_if<JoystickHeard>(&event)) on_sample(robot, *sample);
    const auto* ack = std::get_if<AckSent>(&event);
    if (!ack) return;
    if (ack->accepted && ack->reason != Reason::none) report_violation("accepted with a reason to refuse");
    if (!ack->accepted && (ack->reason == Reason::none || name(ack->reason) == "unknown"))
      report_violation("refused without a numbered reason");
    if (!ack->accepted && ack->text.empty()) report_violation("refused without a text");
    if (ack->seq == 0) on_stream_answer(robot, *ack, report_violation);
  }

  void on_time(const RobotModel& robot, const ReportViolation& report_violation) override {
    if (!robot.alive() || robot.disturbed()) return;
    for (const RobotModel::Pending& p : robot.pending()) {
      if (robot.now() - p.at <= kAnswerTime || p.at <= reported_[p.command.from]) continue;
      reported_[p.command.from] = p.at;
      report_violation("did not answer command " + std::to_string(p.command.seq) + " of " +
                       p.command.station);
    }
    for (auto& [id, stream] : streams_) {
      if (!stream.refused_since || robot.now() - *stream.refused_since <= kAnswerTime) continue;
      report_violation("refused a joystick in silence");
      stream.refused_since.reset();
    }
  }

 private:
  struct Stream {
    std::optional<Duration> refused_since{};  ///< Time of the first refused sample without an answer.
    std::optional<Duration> answered{};
    std::map<wire::ParticipantId, Duration> senders{};  ///< Time of each participant's last sample.
  };

  void on_sample(const RobotModel& robot, const JoystickHeard& sample) {
    Stream& stream = streams_[sample.id];
    stream.senders[sample.from] = robot.now();
    // Only what is certain to be refused: the sender does not hold the robot.
    if (!robot.alive() || robot.refusal(sample) != "it was not sent by the holder") return;
    if (sample.id == robot.authority().holder_id) return;
    const bool answered = stream.answered && robot.age(*stream.answered) <= kStreamAnswerPeriod;
    if (!stream.refused_since && !answered) stream.refused_since = robot.now();
  }

  void on_stream_answer(const RobotModel& robot, const AckSent& ack,
                        const ReportViolation& report_violation) {
    Stream& stream = streams_[ack.id];
    // An answer names no participant: of several that stream under one id, each gets one a second.
    std::erase_if(stream.senders, [&](const auto& s) { return robot.now() - s.second > 2s; });
    const bool one = stream.senders.size() <= 1;
    if (one && stream.answered && robot.age(*stream.answered) < kStreamAnswerPeriod - 10ms)
      report_violation("answered a stream of " + ack.station + " more than once a second");
    stream.answered = robot.now();
    stream.refused_since.reset();
  }

  std::map<StationId, Stream> streams_{};
  std::map<wire::ParticipantId, Duration> reported_{};
};

}  // namespace

std::unique_ptr<Rule> make_acknowledge_rule() { return std::make_unique<Acknowledge>(); }

}  // namespace adit::sim
