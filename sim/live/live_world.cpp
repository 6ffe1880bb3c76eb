// SPDX-License-Identifier: Apache-2.0
#include "sim/live/live_world.hpp"

#include <algorithm>

#include "core/command/parse.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"

namespace adit::sim {
namespace {

constexpr Duration kLongestLag{200ms};  // beyond it the world goes slow instead of jumping

// What truth answers: places to be reached before the end, contacts, distances.
Scenario judged_by_truth(const Scenario& scenario) {
  Scenario out = scenario;
  out.expectations.clear();
  for (Expectation e : scenario.expectations) {
    // Of what is expected together, the place is truth.
    if (const auto* state = std::get_if<StateExpectation>(&e.what); state && state->near)
      e.what = NearExpectation(*state->near);
    const auto* least = std::get_if<AtLeast>(&e.what);
    const bool counted = least && (least->what == "distance" || least->what == "moving");
    const bool near = std::holds_alternative<NearExpectation>(e.what) && e.when == Expectation::When::by;
    if (!counted && !near && !std::holds_alternative<NoCollision>(e.what)) continue;
    // The script is started by somebody else, later: its times are not ours.
    if (near) e.time = Duration::max();
    out.expectations.push_back(std::move(e));
  }
  return out;
}

std::vector<Goal> goals_of(const Scenario& scenario) {
  std::vector<Goal> out;
  for (const ScriptLine& line : scenario.script) {
    const auto request = command::parse(line.command);
    if (!request || request->verb != command::verb("goto") || request->robots.empty()) continue;
    out.push_back({request->robots.front(), {request->number("X"), request->number("Y")}});
  }
  return out;
}

/// The domain of the robot with that index.
std::uint32_t domain_of(const LiveWorldParams& params, std::size_t i) {
  return params.domain_base + 1 + static_cast<std::uint32_t>(i);
}

LiveParams live_params() {
  LiveParams params;
  params.compute_threads = 2;
  return params;
}

}  // namespace

LiveWorld::LiveWorld(const Scenario& scenario, Simulation simulation, const LiveWorldParams& params)
    : judged_(judged_by_truth(scenario)),
      params_(params),
      simulation_(std::move(simulation)),
      expectations_(judged_),
      runtime_(live_params()),
      strand_(runtime_.strand("world")) {}

LiveWorld::~LiveWorld() {
  on_strand([this] {
    step_.cancel();
    observe_.cancel();
    drivers_.clear();
  });
  strand_.reset();
}

Result<std::unique_ptr<LiveWorld>> LiveWorld::open(const Scenario& scenario,
                                                   std::shared_ptr<const World> world,
                                                   const LiveWorldParams& params) {
  std::vector<DomainClaim> claims;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    auto claim = DomainClaim::take(domain_of(params, i), scenario.robots[i].id);
    if (!claim) return claim.error();
    claims.push_back(std::move(*claim));
  }
  auto simulation = Simulation::create(std::move(world), make_starts(scenario),
                                       make_simulation_params(scenario, params.seed));
  if (!simulation) return simulation.error();
  std::unique_ptr<LiveWorld> out(new LiveWorld(scenario, std::move(*simulation), params));
  out->claims_ = std::move(claims);
  for (std::size_t i = 0; i < out->simulation_.size(); ++i) {
    wire::FastDdsParams dds;
    dds.domain = domain_of(params, i);
    dds.name = out->simulation_.id(i) + " driver";
    dds.large_samples = true;
    auto opened = wire::open_fastdds(dds);
    if (!opened) return opened.error();
    out->wires_.push_back(std::move(*opened));
  }
  return out;
}

void LiveWorld::on_strand(const Task& task) {
  std::promise<void> done;
  strand_->post([&] {
    task();
    done.set_value();
  });
  done.get_future().wait();
}

Result<void> LiveWorld::start() {
  Result<void> result;
  on_strand([&] {
    started_ = strand_->now();
    if (!params_.await_script) script_began_ = Duration{0};
    for (std::size_t i = 0; i < wires_.size() && result; ++i) {
      DriverParams params = make_driver_params(judged_.robots[i]);
      params.first_scan = 100ms + 30ms * static_cast<int>(i);
      params.catch_up = [this] { step(); };
      drivers_.push_back(std::make_unique<RobotDriver>(simulation_, i, *strand_, *wires_[i], params));
      result = drivers_.back()->start();
    }
    step_ = strand_->every(simulation_.params().step, [this] { step(); });
    observe_ = strand_->every(Trail::kPeriod, [this] { observe(); });
  });
  return result;
}

void LiveWorld::begin_script() {
  on_strand([this] { script_began_ = simulation_.now(); });
}

// A late timer is made up for, so that the world keeps pace with the clock of the agents. On a busy machine a
// driver may measure before that timer: an old pose with a new stamp, and a moment later the next one, is a
// jump.
void LiveWorld::step() {
  const Duration due = strand_->now() - started_;
  if (due - simulation_.now() > kLongestLag) started_ += due - simulation_.now() - kLongestLag;
  while (simulation_.now() + simulation_.params().step <= strand_->now() - started_) simulation_.step();
}

void LiveWorld::observe() {
  for (std::size_t i = 0; i < simulation_.size(); ++i)
    trails_[simulation_.id(i)].poses.push_back(simulation_.truth(i).pose.planar());
  add_people(simulation_, people_);
  if (script_began_) expectations_.judge(simulation_.now() - *script_began_, evidence());
}

Evidence LiveWorld::evidence() const {
  const auto truth = [this](const std::string& robot) -> const Truth& {
    return simulation_.truth(simulation_.find(robot).value());
  };
  Evidence out;
  out.pose = [truth](const std::string& robot) { return truth(robot).pose.planar(); };
  out.collisions = [truth](const std::string& robot) { return static_cast<int>(truth(robot).collisions); };
  out.caused = [truth](const std::string& robot) { return static_cast<int>(truth(robot).caused); };
  return out;
}

RunOutcome LiveWorld::finish() {
  RunOutcome out;
  on_strand([&] {
    step_.cancel();
    observe_.cancel();
    drivers_.clear();
    RunReport& report = out.report;
    report.scenario = judged_.file.string();
    report.seed = params_.seed;
    report.virtual_s = seconds(simulation_.now());
    report.wall_s = seconds(strand_->now() - started_);
    for (std::size_t i = 0; i < simulation_.size(); ++i) {
      const Truth& truth = simulation_.truth(i);
      report.robots[simulation_.id(i)] = {truth.distance,
                                          static_cast<int>(truth.collisions),
                                          static_cast<int>(truth.caused),
                                          truth.min_clearance,
                                          seconds(truth.moving) / std::max(report.virtual_s, 1e-3),
                                          {}};
    }
    report.expectations = expectations_.finish(evidence(), report);
    out.trails = std::move(trails_);
    out.people = std::move(people_);
    out.goals = goals_of(judged_);
    out.collisions = simulation_.collisions();
  });
  return out;
}

}  // namespace adit::sim
