// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/router_client.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "core/contract/robot.hpp"

namespace adit::agent {
namespace {

using contract::kFarthestPlace;

constexpr Duration kFind = 500ms;
// A goto waits for this, and each command is answered within 150 ms (rule 3): a router that is busy judges
// the goal with the next route.
constexpr Duration kCheck = 100ms;
constexpr Duration kExplore = 2s;
constexpr Duration kClear = 1s;

}  // namespace

RouterClient::RouterClient(Executor& strand, Log log, const Platform& platform, const Frames& frames,
                           const RouteServices* services, Inputs inputs)
    : Component("router client", strand, std::move(log)),
      platform_(platform),
      frames_(frames),
      services_(services),
      inputs_(std::move(inputs)) {}

template <class Query, class Answer, class DoneFn>
void RouterClient::ask(const Service<Query, Answer>& service, Query query,
                       std::optional<Eigen::Vector3d> goal, Duration deadline, DoneFn done) {
  query.odom_epoch = frames_.odom_epoch();
  query.areas = inputs_.areas();
  if (inputs_.stairs) query.stairs = inputs_.stairs(std::array{place(), goal.value_or(place())});
  call(service, query, {.deadline = deadline},
       [this, epoch = query.odom_epoch, done = std::move(done)](const Result<Answer>& answer) {
         done(answer, epoch == frames_.odom_epoch());
       });
}

void RouterClient::find_route(const Eigen::Vector3d& goal, const Done<PlannedRoute>& done) {
  protect([&] {
    if (!goal.head<2>().allFinite() || std::isinf(goal.z()))
      return done({Reason::out_of_range, "a place has finite coordinates"});
    if (!services_) return done({Reason::not_supported, "this robot has no router: its platform says none"});
    if (!frames_.initialised()) return done({Reason::no_localisation, "the robot does not know where it is"});
    RouteQuery query{};
    query.from = place();
    query.to = frames_.to_odom(goal);
    ask(services_->find, query, query.to, kFind,
        [this, done](const Result<nav::Route>& route, bool same_frame) {
          if (!route) return done({Reason::no_answer, "the router does not answer; see health"});
          if (!same_frame) return done({Reason::odometry_jumped, "the odometry jumped meanwhile"});
          done(planned_route(*route, frames_));
        });
  });
}

void RouterClient::check_goal(const Eigen::Vector3d& goal, bool replace, const Done<GoalReport>& done) {
  protect([&] {
    if (!services_ || !frames_.initialised() || platform_.flies() ||
        !(goal.head<2>().norm() <= kFarthestPlace) || std::isinf(goal.z()))
      return done({Reason::not_supported, "the goal is not judged"});
    GoalQuery query{};
    query.from = place();
    query.to = frames_.to_odom(goal);
    query.replace = replace;
    ask(services_->check, query, query.to, kCheck,
        [this, goal, done](const Result<nav::GoalFinding>& found, bool same_frame) {
          if (!found) return done(found.error());
          if (!same_frame) return done({Reason::odometry_jumped, "the odometry jumped meanwhile"});
          done(goal_report(*found, goal, frames_));
        });
  });
}

void RouterClient::explore(const NextPlaceQuery& asked, const Done<nav::ExploreStep>& done) {
  if (!services_) return done({Reason::not_supported, "this robot has no router: its platform says none"});
  ExploreQuery query{};
  query.place = place();
  query.blocked = asked.blocked;
  query.begins = asked.begins;
  if (!asked.area.empty()) {
    const RouteAreas areas = inputs_.areas();
    const nav::Area* area = areas.all.find(asked.area);
    if (!area) return done({Reason::outside_area, "the area " + asked.area + " was removed"});
    nav::Area within = *area;
    within.kind = nav::AreaKind::keep_in;
    (void)query.within.add(std::move(within));
  }
  query.made = now();
  ask(services_->explore, std::move(query), std::nullopt, kExplore,
      [this, done](const Result<nav::ExploreStep>& found, bool same_frame) {
        if (!found) return done(found);
        if (!same_frame) return;
        nav::ExploreStep step = *found;
        if (step.goal) step.goal = frames_.to_map(*step.goal);
        done(step);
      });
}

void RouterClient::find_clear_place(const nav::Corridor& corridor, const std::string& asker,
                                    std::function<void(std::optional<Eigen::Vector2d>)> done) {
  if (!services_ || !frames_.initialised()) return done(std::nullopt);
  ClearPlaceQuery query{};
  query.query.from = place();
  for (const Eigen::Vector2d& point : corridor.route)
    query.query.corridor.route.push_back(frames_.to_odom(point));
  query.query.corridor.width = corridor.width;
  query.query.radius = std::hypot(platform_.length, platform_.width) / 2;
  query.team = inputs_.team();
  for (TeamRobot& robot : query.team)
    if (robot.name == asker) robot.cost = nav::kNoWay;
  ask(services_->clear, std::move(query), std::nullopt, kClear,
      [this, done = std::move(done)](const Result<std::optional<Eigen::Vector3d>>& found, bool same_frame) {
        if (!same_frame) return;
        if (!found || !*found) return done(std::nullopt);
        done(Eigen::Vector2d(frames_.to_map(**found).head<2>()));
      });
}

}  // namespace adit::agent
