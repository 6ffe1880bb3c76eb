// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "robot_agent/command/requests.hpp"
#include "robot_agent/convoy/convoy.hpp"

namespace adit::agent {

/// A robot that executes every request and records it.
struct FakeRequests : Requests {
  Result<void> request_mode(const std::string& mode, Time) override {
    calls.push_back("mode " + mode);
    return {};
  }
  Result<void> request_goal(const Eigen::Vector3d& to, Time) override {
    if (stopped) return {Reason::stopped, "stopped"};
    goal = to;
    calls.push_back("goal");
    return {};
  }
  void limit_unknown(double metres) override { budget = metres; }
  Result<void> set_pose(const Pose2& at, Time) override {
    if (!holds) return {Reason::wrong_mode, "only in hold"};
    pose = at;
    calls.push_back("pose");
    return {};
  }
  Result<void> request_explore(const ExploreRequest& request, Time) override {
    exploration = request;
    calls.push_back("explore");
    return {};
  }
  Result<void> add_area(const nav::Area& asked, Time) override {
    area = asked;
    calls.push_back("area");
    return {};
  }
  Result<void> remove_area(const std::string& name, Time) override {
    calls.push_back("no area " + name);
    return {};
  }
  Result<void> join_convoy(const ConvoyOrder& order, Time) override {
    convoy = order;
    calls.push_back("join");
    return {};
  }
  Result<void> leave_convoy(Time) override {
    calls.push_back("peeloff");
    return {};
  }
  Result<void> allow_yield(bool allowed, Time) override {
    calls.push_back(allowed ? "yield on" : "yield off");
    return {};
  }
  void stop_changed(bool on, Time) override {
    stopped = on;
    calls.push_back(on ? "stopped" : "reset");
  }
  void holder_changed(Time) override { calls.push_back("holder"); }
  void holder_restarted(Time) override { calls.push_back("restarted"); }
  Result<void> stick(const Twist2& twist, Time at) override {
    if (!takes_stick && !twist.zero()) return {Reason::wrong_mode, {}};
    sticks.push_back(twist);
    stick_at = at;
    return {};
  }

  bool stopped{};
  Eigen::Vector3d goal{0.0, 0.0, 0.0};  ///< The last one requested.
  double budget{-1.0};                  ///< The last one set, m.
  bool takes_stick{true};
  bool holds{true};
  ExploreRequest exploration{};  ///< The last one requested.
  nav::Area area{};              ///< The last one added.
  ConvoyOrder convoy{};          ///< The last one joined.
  Pose2 pose{};                  ///< The last one set.
  std::vector<std::string> calls{};
  std::vector<Twist2> sticks{};
  Time stick_at{};  ///< Time of the newest sample.
};

}  // namespace adit::agent
