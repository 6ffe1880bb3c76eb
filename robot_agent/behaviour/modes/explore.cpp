// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/explore.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/store/pack.hpp"

namespace adit::agent {

using contract::ExplorationPhase;

void ExploreMode::note(Facts&, Time) const {
  if (!context_.holder_heard || !context_.holder_heard()) return;
  if (const auto pose = context_.pose()) heard_at_ = pose->position();
}

void ExploreMode::set_exploration(const ExploreRequest& request) {
  request_ = request;
  begin();
}

void ExploreMode::begin() {
  ++run_;
  view_ = {.phase = ExplorationPhase::starting};
  goal_.reset();
  navigated_ = {};
  asked_.reset();
  last_asked_.reset();
  ends_.reset();
  begins_ = true;
  complete_ = false;
  why_ = Reason::none;
}

// `mode R explore` goes on with an exploration that was interrupted, and begins one otherwise.
void ExploreMode::enter(Time now) {
  if (view_.phase == ExplorationPhase::none || is_over()) {
    request_ = {};
    begin();
  }
  if (!ends_ && std::isfinite(request_.limit)) ends_ = now + from_seconds(request_.limit);
}

void ExploreMode::tick(bool passes, Time now) {
  active_ = true;
  if (is_over()) return context_.output.write(Stand{}, now);
  if (view_.phase == ExplorationPhase::reporting) {
    if (passes) tick_return();
  } else {
    if (ends_ && now >= *ends_)
      conclude(Reason::cancelled, "the time for it is over");
    else if (passes)
      ask(now);
  }
  if (!is_over() && goal_)
    context_.output.write(GoTo{.goal = *goal_,
                               .id = goal_id_,
                               .pass = view_.open > 1 && view_.phase != ExplorationPhase::reporting,
                               .continues = true},
                          now);
  else
    context_.output.write(Stand{}, now);
}

void ExploreMode::ask(Time now) {
  if (asked_ && now - *asked_ < kAnswerLost) return;
  if (last_asked_ && now - *last_asked_ < kAskPeriod) return;
  const bool blocked = goal_ && navigated_.gave_up();
  if (blocked) navigated_ = {};
  asked_ = last_asked_ = now;
  context_.explore({blocked, begins_, request_.area},
                   [this, run = run_](const Result<nav::ExploreStep>& step) {
                     if (run != run_) return;
                     asked_.reset();
                     if (step)
                       answered(*step);
                     else if (step.reason() == Reason::outside_area)
                       conclude(Reason::outside_area, step.error().text);
                   });
}

void ExploreMode::answered(const nav::ExploreStep& step) {
  begins_ = false;
  view_.volume = static_cast<float>(step.volume);
  view_.share = static_cast<float>(step.volume > 0 ? step.volume / (step.volume + step.open) : 0);
  view_.open = static_cast<std::uint16_t>(std::min<std::size_t>(step.frontiers, 65'535));
  view_.unreachable = static_cast<std::uint16_t>(std::min<std::size_t>(step.unreachable, 65'535));
  if (step.state == nav::ExploreState::done) return conclude(Reason::none, summary());
  if (step.state == nav::ExploreState::no_viewpoint)
    return conclude(Reason::no_viewpoint, std::string(describe(Reason::no_viewpoint)));
  if (!step.goal) {
    goal_.reset();
    return;
  }
  // A correction of the map moves a goal a little.
  const bool other = !goal_ || (*goal_ - *step.goal).norm() > kOtherGoal;
  goal_ = *step.goal;
  if (other) {
    ++goal_id_;
    navigated_ = {};
  }
  const auto pose = context_.pose();
  const bool far = pose && (goal_->head<2>() - pose->position()).norm() > kFar;
  view_.phase = far ? ExplorationPhase::travelling : ExplorationPhase::exploring;
}

std::string ExploreMode::summary() const {
  char text[120];
  std::snprintf(text, sizeof text, "explored %.0f m3; %u places were not reached", view_.volume,
                static_cast<unsigned>(view_.unreachable));
  return text;
}

void ExploreMode::conclude(Reason reason, const std::string& text) {
  why_ = reason;
  complete_ = reason == Reason::none;
  view_.reason = reason;
  context_.notify_holder(reason == Reason::no_viewpoint ? Severity::warning : Severity::info,
                         complete_ ? "explored" : "explore_ended", reason, text);
  ++run_;  // No answer of the router counts any more.
  asked_.reset();
  navigated_ = {};
  goal_.reset();
  begin_return();
}

void ExploreMode::begin_return() {
  view_.phase = ExplorationPhase::reporting;
  switch (why_ == Reason::no_viewpoint ? AfterExploring::wait : request_.after) {
    case AfterExploring::wait:
      return finish();
    case AfterExploring::home:
      return return_to(context_.home);
    case AfterExploring::report:
      return return_to(context_.holder_heard && context_.holder_heard() ? std::nullopt : heard_at_);
  }
}

void ExploreMode::return_to(std::optional<Eigen::Vector2d> place) {
  if (!place) return finish();
  goal_ = Eigen::Vector3d(place->x(), place->y(), std::nan(""));
  ++goal_id_;
}

void ExploreMode::tick_return() {
  const bool heard = request_.after == AfterExploring::report && context_.holder_heard();
  if (heard || navigated_.arrived) return finish();
  if (!navigated_.gave_up()) return;
  context_.notify_holder(Severity::warning, "unreachable", Reason::goal_unreachable,
                         request_.after == AfterExploring::home
                             ? "the robot explored, but found no way home"
                             : "the robot explored, but found no way to where its holder was heard");
  finish();
}

void ExploreMode::finish() {
  view_.phase = complete_ ? ExplorationPhase::done : ExplorationPhase::ended;
  view_.reason = why_;
  goal_.reset();
}

void ExploreMode::store(StoredBehaviour& stored) const {
  if (view_.phase == ExplorationPhase::none) return;
  stored.modes.push_back({"explore", store::Packer{}
                                         .put(static_cast<std::uint8_t>(view_.phase))
                                         .put(static_cast<std::uint8_t>(request_.after))
                                         .flag(complete_)
                                         .put(static_cast<std::uint16_t>(why_))
                                         .put(request_.limit)
                                         .text(request_.area)
                                         .bytes()});
}

// The map of the router is empty after a restart of the agent: the next scans show that what is around the
// robot was seen, and it looks at the rest again.
void ExploreMode::restore(const StoredBehaviour& stored) {
  const store::Bytes* bytes = stored.of("explore");
  if (!bytes) return;
  store::Unpacker in(*bytes);
  const auto state = in.get<std::uint8_t>();
  const auto after = in.get<std::uint8_t>();
  const bool complete = in.flag();
  const auto why = in.get<std::uint16_t>();
  const double limit = in.number();
  const std::string area = in.text(32);
  if (!in.done() || state > static_cast<std::uint8_t>(ExplorationPhase::ended) || after > 2 || !(limit > 0))
    return;
  request_ = {static_cast<AfterExploring>(after), limit, area};
  begin();
  const auto was = static_cast<ExplorationPhase>(state);
  if (was != ExplorationPhase::done && was != ExplorationPhase::ended && was != ExplorationPhase::reporting)
    return;
  view_.phase = was;
  complete_ = complete;
  why_ = view_.reason = static_cast<Reason>(why);
  if (was == ExplorationPhase::reporting) begin_return();
}

}  // namespace adit::agent
