// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <memory>

#include "sim/checker/rule.hpp"

namespace adit::sim {

struct Violation {
  int rule{};
  Duration at{};  ///< Time since the start of the run.
  std::string robot{};
  std::string text{};
};

/// Watches the rules of docs/architecture.md from outside: it receives what reached each robot, what each
/// robot sent, and what the world did, and never looks into an agent.
class Checker {
 public:
  /// The rules that are checked.
  static constexpr std::array kNumbers{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  /// Title of rule `number` in docs/architecture.md.
  static const char* title(int number);

  explicit Checker(std::vector<RobotFacts> robots);
  ~Checker();

  /// One thing seen. Times never go back. What is seen in one instant is judged together, when time goes
  /// on: what was received and answered first, then what was published, then the velocities.
  void observe(const std::string& robot, Duration at, Event event);
  /// Time went on to `now` (call it at least every 20 ms, and at the end).
  void advance(Duration now);

  /// At most 100 of each rule are stored; all are counted.
  const std::vector<Violation>& violations() const { return violations_; }
  std::uint64_t count(int rule) const { return counts_.at(static_cast<std::size_t>(rule)); }

 private:
  struct WatchedRobot;
  void dispatch(WatchedRobot& robot);
  void judge(WatchedRobot& robot, const Event& event);
  ReportViolation violation_reporter(WatchedRobot& robot, int rule);

  std::map<std::string, std::unique_ptr<WatchedRobot>> robots_;
  std::vector<Violation> violations_{};
  std::array<std::uint64_t, 12> counts_{};  ///< Violations by rule number.
};

}  // namespace adit::sim
