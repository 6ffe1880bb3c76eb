// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/truth/exploration.hpp"
#include "sim/truth/repeated_way.hpp"

namespace adit::sim {

/// When what share was seen.
struct ExplorationResult {
  static constexpr std::array kShares{0.5, 0.9, 0.95, 0.97, 0.99};
  /// "t50" to "t99": the key of a share in reports.
  static std::string name(std::size_t n) { return "t" + std::to_string(std::lround(100 * kShares.at(n))); }
  struct Reached {
    double time_s{};
    double metres{};  ///< Driven by all robots until then.
  };
  std::array<std::optional<Reached>, kShares.size()> reached{};  ///< By kShares; nothing: never.
  struct Point {
    double time_s{}, metres{}, share{};
  };
  std::vector<Point> curve{};  ///< Once a second.
  double share{};              ///< At the end, [0, 1].
  double volume{};             ///< At the end, m3.
  double metres{};             ///< Driven by all robots.
  double repeat{};             ///< See RepeatedWay::share().
  double overlap{};            ///< See ExplorationTruth::overlap().
};

/// Follows the exploration of a run.
class ExplorationRecord {
 public:
  static constexpr double kPeriod = 0.2;  ///< Between the looks, s.

  ExplorationRecord(ExplorationTruth truth, std::size_t robots)
      : truth_(std::move(truth)), way_(robots), looked_(robots) {}

  /// Where the robots' base_links are (world frame); to be called every kPeriod. What stands still looks
  /// once.
  void add(double time_s, std::span<const Pose3> robots);

  const ExplorationTruth& truth() const { return truth_; }
  const RepeatedWay& way() const { return way_; }
  ExplorationResult result() const;

 private:
  ExplorationTruth truth_;
  RepeatedWay way_;
  std::vector<std::optional<Pose3>> looked_;  ///< By robot: from where it looked last.
  ExplorationResult result_{};
};

}  // namespace adit::sim
