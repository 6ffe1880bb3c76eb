// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/expectations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/contract/robot.hpp"

namespace adit::sim {
namespace {

using When = Expectation::When;

constexpr Duration kMapPeriod = 5s;  // Between two judgements of a map, which take long.

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
  if (e.explore) {
    const std::string_view state = to_string(static_cast<contract::ExplorationPhase>(word.exploration));
    const bool same = state == *e.explore || (*e.explore == "exploring" && state == "travelling");
    if (!same) say("its exploration is " + std::string(state));
  }
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
  if (it->second != e.findings) return "it has " + std::to_string(it->second);
  if (!e.photos) return {};
  const auto photos = evidence.photos.find(e.by);
  const std::size_t count = photos == evidence.photos.end() ? 0 : photos->second;
  return count == *e.photos ? std::string() : "it has " + std::to_string(count) + " whole photos";
}

std::string mismatch(const PicturesExpectation& e, const Evidence& evidence) {
  const auto it = evidence.pictures.find(e.by);
  if (it == evidence.pictures.end()) return "the station does not run";
  return it->second >= e.least ? std::string() : "it got " + std::to_string(it->second);
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

std::string mismatch(const MapExpectation& e, const Evidence& evidence) {
  const std::optional<MapJudgement> map = evidence.map ? evidence.map(e.by) : std::nullopt;
  if (!map) return e.by + " has no map";
  if (e.share && map->share < *e.share) return percent("the map holds", map->share);
  if (e.wrong && map->wrong() > *e.wrong)
    return percent("wrong are", map->wrong_occupied) + percent(" of the occupied and", map->wrong_free) +
           " of the free voxels";
  return {};
}

/// Distance of a point from the way between two others: a pose was stated within the last 20 ms.
double off_way(const Eigen::Vector2d& point, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double length = way.squaredNorm();
  const double part = length > 0.0 ? std::clamp((point - from).dot(way) / length, 0.0, 1.0) : 0.0;
  return (point - from - part * way).norm();
}

std::string mismatch(const RepeatExpectation& e, const Evidence& evidence) {
  const double share = evidence.exploration->way().share();
  return share <= e.share ? std::string() : percent("driven again", share);
}

std::string mismatch(const ConvoyExpectation& e, const Evidence& evidence) {
  for (const std::string& robot : e.order) {
    const auto& said = evidence.word(robot).convoy;
    if (said == e.order) continue;
    std::string names;
    for (const std::string& name : said) names += " " + name;
    return robot + " says:" + (names.empty() ? " no convoy" : names);
  }
  return {};
}

std::string mismatch(const InLineExpectation& e, const Evidence& evidence) {
  const Eigen::Vector2d direction = (e.to - e.from).normalized();
  std::string previous;
  double before = std::numeric_limits<double>::infinity();
  for (const std::string& robot : e.robots) {
    const double along = (evidence.pose(robot).position() - e.from).dot(direction);
    if (along >= before) return robot + " is before " + previous;
    previous = robot;
    before = along;
  }
  return {};
}

std::string mismatch(const NoticeExpectation& e, const Evidence& evidence) {
  return evidence.notified(e.by, e.code, e.robot) ? std::string() : e.by + " was not notified";
}

std::string mismatch(const ReasonExpectation& e, const Evidence& evidence) {
  return evidence.reported(e.robot, e.reason) ? std::string() : e.robot + " did not say so";
}

using Outline = std::array<Eigen::Vector2d, 4>;

Outline outline(const RobotSpec& robot, const Pose2& pose) {
  const Platform& p = robot.settings.platform;
  const double x = p.length / 2, y = p.width / 2;
  return {pose * Eigen::Vector2d(x, y), pose * Eigen::Vector2d(-x, y), pose * Eigen::Vector2d(-x, -y),
          pose * Eigen::Vector2d(x, -y)};
}

/// The least distance of a corner of one outline from a side of the other; outlines do not overlap.
double distance(const Outline& a, const Outline& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [corners, sides] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Eigen::Vector2d& corner : *corners)
      for (std::size_t i = 0; i < sides->size(); ++i) {
        const Eigen::Vector2d from = (*sides)[i], side = (*sides)[(i + 1) % sides->size()] - from;
        const double part = std::clamp((corner - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (corner - from - part * side).norm());
      }
  return least;
}

std::string mismatch(const GapExpectation& e, const Scenario& scenario, const Evidence& evidence) {
  const double gap = distance(outline(*scenario.robot(e.a), evidence.pose(e.a)),
                              outline(*scenario.robot(e.b), evidence.pose(e.b)));
  if (gap >= e.min && gap <= e.max) return {};
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", gap);
  return text;
}

// The outlines are convex, and so is the rectangle: they are apart if a side of either separates them.
bool overlaps(const Outline& body, const ExplorationArea& area) {
  const Outline rectangle{Eigen::Vector2d(area.x0, area.y0), Eigen::Vector2d(area.x1, area.y0),
                          Eigen::Vector2d(area.x1, area.y1), Eigen::Vector2d(area.x0, area.y1)};
  const auto reach = [](const Outline& of, const Eigen::Vector2d& along) {
    std::pair range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Eigen::Vector2d& corner : of)
      range = {std::min(range.first, corner.dot(along)), std::max(range.second, corner.dot(along))};
    return range;
  };
  for (const Eigen::Vector2d& along :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(body[0] - body[1]),
        Eigen::Vector2d(body[1] - body[2])}) {
    const auto a = reach(body, along), b = reach(rectangle, along);
    if (a.second <= b.first || b.second <= a.first) return false;
  }
  return true;
}

std::string mismatch(const PlaceExpectation& e, const Scenario& scenario, const Evidence& evidence) {
  for (const std::string& robot : e.robots) {
    const Pose2 pose = evidence.pose(robot);
    const Outline body = outline(*scenario.robot(robot), pose);
    const bool within = std::all_of(body.begin(), body.end(), [&](const Eigen::Vector2d& c) {
      return c.x() >= e.area.x0 && c.x() <= e.area.x1 && c.y() >= e.area.y0 && c.y() <= e.area.y1;
    });
    if (e.inside ? within : !overlaps(body, e.area)) continue;
    char text[64];
    std::snprintf(text, sizeof text, " at %.2f %.2f", pose.x, pose.y);
    return robot + text;
  }
  return {};
}

std::string mismatch(const StillExpectation& e, std::optional<Eigen::Vector2d>& start,
                     const Evidence& evidence) {
  const Eigen::Vector2d place = evidence.pose(e.robot).position();
  if (!start) start = place;
  const double moved = (place - *start).norm();
  if (moved <= e.distance) return {};
  char text[32];
  std::snprintf(text, sizeof text, "moved %.2f m", moved);
  return text;
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
  for (const Expectation& e : scenario_.expectations)
    if (e.when == When::during) out.push_back(e.from);
  std::sort(out.begin(), out.end());
  return out;
}

std::string Expectations::watch(const ProgressExpectation& e, Duration now, const Evidence& evidence,
                                State& state) const {
  constexpr double kProgress = 0.3;  // m
  for (const std::string& robot : e.robots) {
    const RobotWord& word = evidence.word(robot);
    const Eigen::Vector2d place = evidence.pose(robot).position();
    const auto [standing, begins] = state.stands.try_emplace(robot, Standing{place, now});
    Standing& last = standing->second;
    if (begins || !word.drives_to_goal || word.stopped || (place - last.at).norm() > kProgress)
      last = {place, now};
    if (now - last.since <= e.within) continue;
    char text[96];
    std::snprintf(text, sizeof text, " stays at %.2f %.2f from %.1f s on", last.at.x(), last.at.y(),
                  seconds(last.since));
    return robot + text;
  }
  return {};
}

void Expectations::judge(Duration now, const Evidence& evidence) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const Expectation& e = scenario_.expectations[i];
    State& state = states_[i];
    if (state.settled || (e.when == When::at && now < e.time) || (e.when == When::during && now < e.from))
      continue;
    std::string found;
    if (const auto* robot = std::get_if<StateExpectation>(&e.what)) found = mismatch(*robot, evidence);
    if (const auto* near = std::get_if<NearExpectation>(&e.what)) found = mismatch(*near, evidence);
    if (const auto* answer = std::get_if<AnswerExpectation>(&e.what)) found = mismatch(*answer, evidence);
    if (const auto* desk = std::get_if<FindingsExpectation>(&e.what)) found = mismatch(*desk, evidence);
    if (const auto* pictures = std::get_if<PicturesExpectation>(&e.what))
      found = mismatch(*pictures, evidence);
    if (const auto* explored = std::get_if<ExploredExpectation>(&e.what))
      found = mismatch(*explored, evidence);
    if (const auto* repeat = std::get_if<RepeatExpectation>(&e.what)) found = mismatch(*repeat, evidence);
    if (const auto* convoy = std::get_if<ConvoyExpectation>(&e.what)) found = mismatch(*convoy, evidence);
    if (const auto* line = std::get_if<InLineExpectation>(&e.what)) found = mismatch(*line, evidence);
    if (const auto* notice = std::get_if<NoticeExpectation>(&e.what)) found = mismatch(*notice, evidence);
    if (const auto* map = std::get_if<MapExpectation>(&e.what)) {
      if (now < e.time && (e.when == When::at || !map->share || now % kMapPeriod != 0ns)) continue;
      found = mismatch(*map, evidence);
    }
    if (const auto* within = std::get_if<PoseWithinExpectation>(&e.what)) {
      for (const std::string& robot : within->robots) {
        PoseSeen& seen = state.poses[robot];
        const Eigen::Vector2d truth = evidence.pose(robot).position();
        const RobotWord& word = evidence.word(robot);
        const Eigen::Vector2d before = seen.judged < 0ns ? truth : seen.truth;
        seen.truth = truth;
        if (!word.pose || word.pose_sent == seen.judged) continue;
        seen.judged = word.pose_sent;
        const double off = off_way(word.pose->position.head<2>(), before, truth);
        if (off <= within->distance) continue;
        char text[64];
        std::snprintf(text, sizeof text, " was %.2f m from where it said at ", off);
        state.result.found = robot + text + std::to_string(now / 1s) + " s";
        state.settled = true;
        break;
      }
    }
    if (const auto* reason = std::get_if<ReasonExpectation>(&e.what)) found = mismatch(*reason, evidence);
    if (const auto* progress = std::get_if<ProgressExpectation>(&e.what)) {
      state.result.found = watch(*progress, now, evidence, state);
      state.settled = !state.result.found.empty();
    }
    if (const auto* place = std::get_if<PlaceExpectation>(&e.what)) {
      found = mismatch(*place, scenario_, evidence);
      if (!found.empty()) state.result.found = found + " at " + std::to_string(now / 1s) + " s";
      state.settled = !found.empty();
    }
    if (e.when == When::always) continue;
    if (e.when == When::during) {
      if (const auto* gap = std::get_if<GapExpectation>(&e.what)) found = mismatch(*gap, scenario_, evidence);
      if (const auto* still = std::get_if<StillExpectation>(&e.what))
        found = mismatch(*still, state.start, evidence);
      if (!found.empty()) found += " at " + std::to_string(now / 1s) + " s";
      state.result.ok = found.empty();
      state.result.found = found;
      state.settled = !found.empty() || now >= e.time;
      continue;
    }
    state.result.ok = found.empty();
    state.result.found = found;
    state.settled = e.when == When::at || state.result.ok || now >= e.time;
  }
}

bool Expectations::all_settled() const {
  bool timed = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const Expectation& e = scenario_.expectations[i];
    if (std::holds_alternative<AtLeast>(e.what) || (e.when != When::always && !states_[i].settled))
      return false;
    timed = timed || e.when != When::always;
  }
  return timed;
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
