// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "basestation/alert/queue.hpp"
#include "sim/truth/operator_truth.hpp"

namespace adit::bench {

/// Judges the alerts of one operator by what is true in the rehearsal.
///
/// A false alert says that a robot is lost, stopped or does not move when it is not so. A missed loss is one
/// of which the operator's machine has had the proof for 1 s and that no alert of the robot shows; an alert
/// of a more dangerous condition shows it, too.
class AlertJudge {
 public:
  static constexpr Duration kMustShow{1s};
  static constexpr Duration kSilentStand{20s};

  struct Figures {
    int judged{}, wrong{};   ///< Alerts that appeared; of them false ones.
    int other{};             ///< Alerts of what the truth does not know: disks, requests, components, ...
    int losses{}, missed{};  ///< Losses that lasted for kMustShow; of them missed ones.
    int silent_stands{};     ///< Robots that stood for kSilentStand with a goal while nothing needed anyone.
    double slowest{};        ///< Longest time from the proof of a loss to its alert, s.
  };

  explicit AlertJudge(const std::string& station) : truth_(station) {}

  sim::OperatorTruth& truth() { return truth_; }
  /// The alerts at that time. Call it ten times a second; a longer pause means that the station restarted.
  void look(const station::AlertQueue& alerts, const station::World& world, Duration now);

  const Figures& figures() const { return figures_; }
  /// What was wrong, in the order of time: "12.3 s r1 blocked: false".
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  /// A loss that lasts.
  struct Episode {
    bool counted{}, missed{};
    std::optional<Duration> shown{};  ///< When an alert last showed it.
  };
  void judge(const station::Alert& alert, Duration now);
  void look_for(const std::string& robot, sim::Loss loss, const std::vector<station::Alert>& alerts,
                Duration now);
  void look_for_stand(const std::string& robot, const std::vector<station::Alert>& alerts, Duration now);
  void complain(Duration now, const std::string& text);

  sim::OperatorTruth truth_;
  std::optional<Duration> looked_{};
  std::set<std::pair<std::uint64_t, std::string>> known_{};  ///< Alerts and their robots.
  std::map<std::pair<std::string, sim::Loss>, Episode> episodes_{};
  std::set<std::string> silent_{};
  Figures figures_{};
  std::vector<std::string> complaints_{};
};

}  // namespace adit::bench
