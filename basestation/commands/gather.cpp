// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/gather.hpp"

#include <algorithm>
#include <utility>

#include "basestation/report/json.hpp"
#include "basestation/report/text.hpp"

namespace adit::station {

Gather::Gather(command::Request request, Done done) : request_(std::move(request)), done_(std::move(done)) {}

std::size_t Gather::expect(const std::string& robot) {
  ++missing_;
  answers_.push_back({.robot = robot});
  return answers_.size() - 1;
}

void Gather::take(std::size_t index, Answer answer) {
  answers_[index] = std::move(answer);
  finish();
}

void Gather::close() { finish(); }

void Gather::finish() {
  if (--missing_ == 0) std::exchange(done_, nullptr)(*this);
}

bool Gather::expects(const std::string& robot) const {
  return std::any_of(answers_.begin(), answers_.end(), [&](const Answer& a) { return a.robot == robot; });
}

Outcome Gather::outcome(const std::string& own_name) const {
  Outcome outcome = done_outcome(request_, "", {{"results", nlohmann::json::array()}});
  for (const Answer& answer : answers_) {
    const int code = answer.accepted ? 0 : answer.reason == Reason::no_answer ? 3 : 1;
    (code == 0 ? outcome.text : outcome.error) += answer_text(answer, command::done_text(request_), own_name);
    outcome.json["results"].push_back(answer_json(answer));
    // A refusal counts more than silence.
    if (outcome.exit_code != 1 && code != 0) outcome.exit_code = code;
  }
  outcome.json["exit"] = outcome.exit_code;
  outcome.json["ok"] = outcome.exit_code == 0;
  return outcome;
}

}  // namespace adit::station
