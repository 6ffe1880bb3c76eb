// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/expectations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace adit::sim {
namespace {

using When = Expectation::When;

std::string quoted(const std::string& text) { return text.empty() ? "nobody" : text; }

// Each overload gives what is there instead; empty: as expected.
std::string mismatch(const NearExpectation& e, const Evidence& evidence) {
  const Pose2 pose = evidence.pose(e.robot);
  const double off = std::hypot(pose.x - e.x, pose.y - e.y);
  if (off <= e.tolerance) return {};
  char text[96];
  std::snprintf(text, sizeof text, "at %.2f %.2f, %.2f m away", pose.x, pose.y, off);
  return text;
}

std::string mismatch(const StateExpectation& e, const Evidence& evidence) {
  const RobotWord& word = evidence.word(e.robot);
  std::string out;
  const auto say = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (e.mode && word.mode != *e.mode) say("mode is " + (word.mode.empty() ? "not known" : word.mode));
  if (e.holder && word.authority.holder != *e.holder) say("holder is " + quoted(word.authority.holder));
  if (e.locked && word.authority.locked != *e.locked)
    say(word.authority.locked ? "it is locked" : "it is not locked");
  if (e.stopped && word.stopped != *e.stopped) say(word.stopped ? "it is stopped" : "it is not stopped");
  if (e.near)
    if (const std::string where = mismatch(*e.near, evidence); !where.empty()) say(where);
  return out;
}

std::string mismatch(const AnswerExpectation& e, const Evidence& evidence) {
  const auto it = evidence.last_answer.find(e.by);
  if (it == evidence.last_answer.end()) return "got no answer yet";
  if (it->second == e.refused) return {};
  return it->second == Reason::none ? "the last answer accepted"
                                    : "refused: " + std::string(name(it->second));
}

std::string mismatch(const FindingsExpectation& e, const Evidence& evidence) {
  const auto it = evidence.findings.find(e.by);
  if (it == evidence.findings.end()) return "the station does not run";
  return it->second == e.findings ? std::string() : "it has " + std::to_string(it->second);
}

std::string percent(const char* what, double share) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.1f %%", what, 100 * share);
  return text;
}

std::string mismatch(const ExploredExpectation& e, const Evidence& evidence) {
  std::vector<std::size_t> robots;
  for (const std::string& robot : e.robots) robots.push_back(evidence.index(robot));
  const ExplorationTruth& truth = evidence.exploration->truth();
  const double share = e.area || !robots.empty() ? truth.share(e.area, robots) : truth.share();
  return share >= e.share ? std::string() : percent("explored", share);
}

std::string mismatch(const RepeatExpectation& e, const Evidence& evidence) {
  const double share = evidence.exploration->way().share();
  return share <= e.share ? std::string() : percent("driven again", share);
}

std::string collisions(const NoCollision& e, const Scenario& scenario, const Evidence& evidence) {
  for (const RobotSpec& robot : scenario.robots) {
    if (e.caused && evidence.caused(robot.id) > 0) return robot.id + " ran into something";
    if (!e.caused && evidence.collisions(robot.id) > 0) return robot.id + " touched something";
  }
  return {};
}

std::string shortfall(const AtLeast& e, const RunReport& report) {
  const auto below = [&](double is, const std::string& what) {
    if (is >= e.amount) return std::string();
    char text[64];
    std::snprintf(text, sizeof text, "%.1f only", is);
    return what + text;
  };
  if (e.what == "commands") return below(static_cast<double>(report.commands.sent), "");
  if (e.what == "refusals") return below(static_cast<double>(report.commands.refused), "");
  if (e.what == "faults") return below(static_cast<double>(report.fault_count()), "");
  for (const auto& [id, robot] : report.robots) {
    const double is = e.what == "moving" ? robot.moving : robot.distance;
    if (const std::string text = below(is, id + ": "); !text.empty()) return text;
  }
  return {};
}

}  // namespace

Expectations::Expectations(const Scenario& scenario) : scenario_(scenario) {
  for (const Expectation& e : scenario.expectations) states_.push_back({false, {e.text, e.line, false, {}}});
}

std::vector<Duration> Expectations::instants() const {
  std::vector<Duration> out;
  for (const Expectation& e : scenario_.expectations)
    if (e.when != When::always) out.push_back(e.time);
  std::sort(out.begin(), out.end());
  return out;
}

void Expectations::judge(Duration now, const Evidence& evidence) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const Expectation& e = scenario_.expectations[i];
    State& state = states_[i];
    if (state.settled || (e.when == When::at && now < e.time)) continue;
    std::string found;
    if (const auto* robot = std::get_if<StateExpectation>(&e.what)) found = mismatch(*robot, evidence);
    if (const auto* near = std::get_if<NearExpectation>(&e.what)) found = mismatch(*near, evidence);
    if (const auto* answer = std::get_if<AnswerExpectation>(&e.what)) found = mismatch(*answer, evidence);
    if (const auto* desk = std::get_if<FindingsExpectation>(&e.what)) found = mismatch(*desk, evidence);
    if (const auto* explored = std::get_if<ExploredExpectation>(&e.what))
      found = mismatch(*explored, evidence);
    if (const auto* repeat = std::get_if<RepeatExpectation>(&e.what)) found = mismatch(*repeat, evidence);
    if (e.when == When::always) continue;
    state.result.ok = found.empty();
    state.result.found = found;
    state.settled = e.when == When::at || state.result.ok || now >= e.time;
  }
}

std::vector<ExpectationResult> Expectations::finish(const Evidence& evidence, const RunReport& report) {
  std::vector<ExpectationResult> out;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const Expectation& e = scenario_.expectations[i];
    ExpectationResult result = states_[i].result;
    if (e.when == When::always) {
      if (const auto* none = std::get_if<NoCollision>(&e.what))
        result.found = collisions(*none, scenario_, evidence);
      if (const auto* least = std::get_if<AtLeast>(&e.what)) result.found = shortfall(*least, report);
      result.ok = result.found.empty();
    } else if (!states_[i].settled) {
      result.ok = false;
      if (result.found.empty()) result.found = "the run ended before";
    }
    out.push_back(std::move(result));
  }
  return out;
}

}  // namespace adit::sim
