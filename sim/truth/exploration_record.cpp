// SPDX-License-Identifier: Apache-2.0
#include "sim/truth/exploration_record.hpp"

namespace adit::sim {
namespace {

constexpr double kMoved = 0.01;   ///< A robot that moved less sees the same, m.
constexpr double kTurned = 0.01;  ///< rad

bool moved(const Pose3& from, const Pose3& to) {
  return (from.position - to.position).norm() > kMoved ||
         from.orientation.angularDistance(to.orientation) > kTurned;
}

}  // namespace

void ExplorationRecord::add(double time_s, std::span<const Pose3> robots) {
  for (std::size_t n = 0; n < robots.size(); ++n) {
    way_.add(n, time_s, robots[n].position.head<2>());
    if (looked_[n] && !moved(*looked_[n], robots[n])) continue;
    truth_.look(n, robots[n]);
    looked_[n] = robots[n];
  }
  const double share = truth_.share();
  for (std::size_t n = 0; n < result_.reached.size(); ++n)
    if (!result_.reached[n] && share >= ExplorationResult::kShares[n])
      result_.reached[n] = {time_s, way_.metres()};
  if (result_.curve.empty() || time_s >= result_.curve.back().time_s + 1 - 1e-9)
    result_.curve.push_back({time_s, way_.metres(), share});
}

ExplorationResult ExplorationRecord::result() const {
  ExplorationResult out = result_;
  out.share = truth_.share();
  out.volume = truth_.volume();
  out.metres = way_.metres();
  out.repeat = way_.share();
  out.overlap = truth_.overlap();
  return out;
}

}  // namespace adit::sim
