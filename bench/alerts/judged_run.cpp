// SPDX-License-Identifier: Apache-2.0
#include "bench/alerts/judged_run.hpp"

#include <algorithm>
#include <map>

#include "basestation/station/station.hpp"

namespace adit::bench {

Result<std::vector<JudgedOperator>> judged_run(const sim::Scenario& scenario,
                                               const std::shared_ptr<const sim::World>& world,
                                               std::uint64_t seed) {
  std::map<std::string, JudgedOperator> operators;
  for (const sim::StationSpec& station : scenario.stations) {
    operators[station.id].station = station.id;
    operators[station.id].judge = std::make_unique<AlertJudge>(station.id);
  }
  sim::RunParams params;
  params.seed = seed;
  params.workers = 1;
  params.make_agent = *sim::make_agent_factory("");
  params.on_frame = [&](const wire::SampleEvent& frame) {
    for (auto& [name, one] : operators) one.judge->truth().see(frame);
  };
  params.on_truth = [&](Duration now, const sim::Simulation& simulation) {
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      const Eigen::Vector2d at = simulation.truth(i).pose.position.head<2>();
      for (auto& [name, one] : operators) one.judge->truth().moved(scenario.robots[i].id, now, at);
    }
  };
  params.on_station = [&](Duration now, const station::Station& station) {
    const station::World seen = station.world();
    JudgedOperator& one = operators.at(seen.station);
    one.drives = one.drives || std::ranges::any_of(seen.robots, &station::Robot::mine);
    one.alerts.look(seen, seconds(now));
    one.judge->look(one.alerts.queue(), seen, now);
  };
  auto outcome = sim::rehearse(scenario, world, params);
  if (!outcome) return outcome.error();
  std::vector<JudgedOperator> out;
  for (auto& [name, one] : operators) {
    one.seed = seed;
    one.minutes = outcome->report.virtual_s / 60.0;
    one.faults = outcome->report.fault_count();
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace adit::bench
