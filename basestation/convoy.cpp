// SPDX-License-Identifier: Apache-2.0
// Commands of a station that concern a convoy as a whole.
#include <algorithm>
#include <utility>

#include "basestation/station_impl.hpp"
#include "core/command/words.hpp"

namespace adit::station {

using command::Request;
using command::verb;

void Station::Impl::start_convoy(std::uint64_t handle, const Request& request, Done done) {
  Request join(verb("join"), request.robots);
  join.values = {{"ROBOT", request.robots, {}},
                 {"ID", {}, {static_cast<double>(1 + random_.below(std::uint64_t{1} << 52))}}};
  for (const char* option : {"--gap", "--speed"})
    if (const auto* given = request.find(option)) join.values.push_back(*given);
  auto gather = std::make_shared<Gather>();
  gather->request = request;
  gather->sent = std::move(join);
  // The gather owns this handler, which must not own it.
  gather->done = [this, handle, weak = std::weak_ptr(gather),
                  done = std::move(done)](const Outcome& outcome) {
    const auto ended = weak.lock();
    const auto refused = [](const Answer& answer) { return !answer.accepted; };
    const auto& answers = ended->answers;
    const auto first = std::find_if(answers.begin(), answers.end(), refused);
    if (first == answers.end()) return done(outcome);
    // All or none: the robots that accepted leave again. One that did not answer may have accepted.
    std::vector<std::string> others;
    for (const Answer& answer : answers)
      if (answer.accepted || !answer.answered) others.push_back(answer.robot);
    std::erase_if(others, [this](const std::string& robot) { return !fleet_.robot(robot); });
    Outcome told = outcome;
    if (!others.empty()) told.error += "no convoy: taken back from " + command::joined(others, "") + "\n";
    last_answer_ = *first;  // The refusal, whichever answer arrived last.
    done(told);
    for (const std::string& robot : others)
      sender_.send({.robot = robot, .request = Request(verb("peeloff"))}, [](const Answer&) {});
  };
  send_to_all(handle, gather);
}

void Station::Impl::stop_convoy(std::uint64_t handle, const Request& request, Done done) {
  auto gather = std::make_shared<Gather>();
  gather->request = request;
  // A robot that does not know of a convoy says so itself.
  if (const RobotView* robot = fleet_.robot(request.robots.front()); robot && !robot->convoy.empty())
    gather->request.robots = robot->convoy;
  gather->sent = Request(verb("peeloff"), gather->request.robots);
  gather->done = std::move(done);
  send_to_all(handle, gather);
}

}  // namespace adit::station
