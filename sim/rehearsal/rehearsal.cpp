// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/rehearsal.hpp"

#include <algorithm>
#include <chrono>

#include "basestation/map/chunk_store.hpp"
#include "basestation/map/ground_area.hpp"
#include "core/record/frame_recorder.hpp"
#include "core/wire/topics.hpp"
#include "sim/rehearsal/expectations.hpp"
#include "sim/rehearsal/fault_player.hpp"
#include "sim/rehearsal/radio_walls.hpp"
#include "sim/rehearsal/random_faults.hpp"
#include "sim/rehearsal/random_script.hpp"
#include "sim/rehearsal/trajectories.hpp"

namespace adit::sim {
namespace {

constexpr Duration kTruthPeriod{20ms};

std::vector<RobotFacts> facts_of(const Scenario& scenario, const Simulation& simulation) {
  std::vector<RobotFacts> out;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Platform& platform = simulation.platform(i);
    out.push_back({simulation.id(i), platform.max_acceleration, platform.max_turn_acceleration,
                   seconds(scenario.robots[i].settings.lock_lease), platform.length, platform.width,
                   scenario.noise == 0.0});
  }
  return out;
}

template <class Spec>
std::vector<std::string> ids_of(const std::vector<Spec>& specs) {
  std::vector<std::string> out;
  for (const Spec& spec : specs) out.push_back(spec.id);
  return out;
}

wire::SimulatedNetworkParams network_params(const Scenario& scenario, std::uint64_t seed) {
  wire::SimulatedNetworkParams params;
  params.seed = seed;
  params.radio_domain = Witness::kRadioDomain;
  params.link = scenario.link;
  return params;
}

VirtualParams scheduler_params(const RunParams& params) {
  VirtualParams out;
  out.seed = params.seed;
  out.workers = params.workers;
  out.on_use = params.on_use;
  return out;
}

TimedEvent event_of(const Collision& contact) {
  return {contact.at, contact.robot,
          (contact.caused ? "runs into " : "is touched by ") + contact.partner +
              (contact.caused && contact.by_partner ? " that comes towards it" : "")};
}

/// One run: the stage, the machines on it, and the loop through virtual time.
class Run {
 public:
  Run(const Scenario& scenario, Simulation simulation, const RunParams& params)
      : scenario_(scenario),
        params_(params),
        random_(params.seed),
        simulation_(std::move(simulation)),
        scheduler_(scheduler_params(params)),
        network_(scheduler_, network_params(scenario, random_.next())),
        checker_(facts_of(scenario, simulation_)),
        witness_(checker_, ids_of(scenario.robots), ids_of(scenario.stations)),
        stage_{scenario_, scheduler_,         network_,           simulation_,
               witness_,  params_.make_agent, params_.parent_wire},
        expectations_(scenario) {}

  Result<RunOutcome> go() {
    if (auto ready = set_up(); !ready) return ready.error();
    const auto begin = std::chrono::steady_clock::now();  // for people: nothing depends on it
    for (const Duration instant : instants()) {
      scheduler_.run_until(instant);
      observe(instant);
      if (params_.ended && instant % Trail::kPeriod == 0ns &&
          params_.ended(
              {instant, simulation_, witness_, instant >= last_event_ && expectations_.all_settled()}))
        break;
    }
    RunOutcome out;
    if (auto healthy = health(); !healthy) return healthy.error();
    if (recorder_)
      if (auto recorded = recorder_->close(); !recorded) return recorded.error();
    if (trajectories_) {
      auto files = trajectories_->close();
      if (!files) return files.error();
      trajectory_files_ = std::move(*files);
    }
    out.report = report(seconds(std::chrono::steady_clock::now() - begin));
    out.trails = std::move(trails_);
    out.people = std::move(people_);
    out.goals = witness_.goals();
    out.collisions = simulation_.collisions();
    return out;
  }

 private:
  Result<void> set_up() {
    if (!params_.record.empty()) {
      auto recorder = record::FrameRecorder::open(
          {.file = params_.record,
           .radio_domain = Witness::kRadioDomain,
           .about = {{"scenario", scenario_.name}, {"seed", std::to_string(params_.seed)}}});
      if (!recorder) return recorder.error();
      recorder_ = std::move(*recorder);
    }
    if (!params_.trajectories.empty()) {
      auto opened = Trajectories::open(params_.trajectories, ids_of(scenario_.robots));
      if (!opened) return opened.error();
      trajectories_ = std::move(*opened);
    }
    if (scenario_.explores()) {
      auto truth = explorers();
      if (!truth) return truth.error();
      exploration_ = std::make_unique<ExplorationRecord>(std::move(*truth), scenario_.robots.size());
    }
    if (scenario_.judges_maps()) {
      std::vector<Platform> platforms;
      for (std::size_t i = 0; i < simulation_.size(); ++i) platforms.push_back(simulation_.platform(i));
      surface_ = std::make_unique<SeenSurfaceRecord>(SeenSurface(simulation_.shared_world(), platforms));
    }
    network_.set_tap([this](const wire::SampleEvent& frame) {
      witness_.see(frame);
      if (recorder_) recorder_->see(frame);
      if (params_.on_frame) params_.on_frame(frame);
    });
    if (scenario_.link.wall > 0.0)
      network_.set_attenuation(
          [walls = std::make_shared<RadioWalls>(simulation_.world(), scenario_.link.wall)](
              const wire::Position& a, const wire::Position& b) { return (*walls)(a, b); });
    world_runtime_ = scheduler_.machine("world", 0ns);
    world_ = world_runtime_->strand("world");
    step_ = world_->every(simulation_.params().step, [this] { simulation_.step(); });
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const RobotSpec& spec = scenario_.robots[i];
      robots_[spec.id] = std::make_unique<RobotMachine>(stage_, i, spec, random_.fork(100 + i));
      witness_.obeys(spec.id, spec.settings.velocity);
      network_.set_position(spec.id, spec.pose.x, spec.pose.y, simulation_.truth(i).pose.position.z());
      if (auto started = robots_[spec.id]->start(); !started) return started;
    }
    for (std::size_t i = 0; i < scenario_.stations.size(); ++i) {
      const StationSpec& spec = scenario_.stations[i];
      stations_[spec.id] = std::make_unique<StationMachine>(stage_, spec, random_.fork(1000 + i));
      if (auto started = stations_[spec.id]->start(); !started) return started;
    }
    schedule(scenario_.script);
    const Draws drawn = draw(scenario_, params_.seed);
    schedule(drawn.script);
    for (const std::vector<Fault>* faults : {&scenario_.faults, &drawn.faults})
      for (const Fault& fault : *faults) {
        faults_.schedule(fault);
        Fault copy = fault;
        const Duration* lasts = duration_of(copy);
        last_event_ = std::max(last_event_, fault.at + (lasts ? *lasts : Duration{}));
      }
    return {};
  }

  Result<ExplorationTruth> explorers() const {
    std::vector<ExplorationRobot> robots;
    for (std::size_t i = 0; i < simulation_.size(); ++i)
      robots.push_back({simulation_.platform(i), scenario_.robots[i].pose});
    auto truth = ExplorationTruth::create(simulation_.shared_world(), robots);
    if (!truth) return Error{truth.error().reason, scenario_.file.string() + ": " + truth.error().text};
    return truth;
  }

  void explore(Duration now) {
    std::vector<Pose3> poses;
    for (std::size_t i = 0; i < simulation_.size(); ++i) poses.push_back(simulation_.truth(i).pose);
    exploration_->add(seconds(now), poses);
  }

  std::optional<MapJudgement> judged_map(const std::string& by) const {
    const auto station = stations_.find(by);
    if (!surface_ || station == stations_.end()) return std::nullopt;
    const std::shared_ptr<const MapVoxels> map = station->second->map();
    if (!map) return std::nullopt;
    return judge_map(*map, surface_->surface().points(), simulation_.world());
  }

  void schedule(const std::vector<ScriptLine>& lines) {
    for (const ScriptLine& line : lines) {
      scheduler_.at(line.at, [this, line] { stations_.at(line.by)->type(line.command); });
      last_event_ = std::max(last_event_, line.at);
    }
  }

  // 50 Hz, and whenever an expectation wants to be judged.
  std::vector<Duration> instants() const {
    std::vector<Duration> out = expectations_.instants();
    for (Duration t = kTruthPeriod; t < scenario_.duration; t += kTruthPeriod) out.push_back(t);
    out.push_back(scenario_.duration);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  void observe(Duration now) {
    for (std::size_t i = 0; i < simulation_.size(); ++i) {
      const std::string& id = simulation_.id(i);
      const Truth& truth = simulation_.truth(i);
      const Pose2 pose = truth.pose.planar();
      witness_.truth(id, now, {pose, truth.twist});
      if (now % Trail::kPeriod == 0ns) {
        trails_[id].poses.push_back(pose);
        network_.set_position(id, pose.x, pose.y, truth.pose.position.z());
      }
      const std::string& mode = witness_.word(id).mode;
      mode_seconds_[id][mode.empty() ? "none" : mode] += seconds(now - observed_);
    }
    if (now % Trail::kPeriod == 0ns) add_people(simulation_, people_);
    checker_.advance(now);
    if (params_.on_truth && now % kTruthPeriod == 0ns) params_.on_truth(now, simulation_);
    if (params_.on_station && now % Trail::kPeriod == 0ns)
      for (const auto& [id, machine] : stations_)
        if (const station::Station* station = machine->station()) params_.on_station(now, *station);
    if (trajectories_ && now % kTruthPeriod == 0ns) trajectories_->add(simulation_, witness_, now);
    if (surface_ && now % SeenSurfaceRecord::kPeriod == 0ns) {
      for (std::size_t i = 0; i < simulation_.size(); ++i) surface_->look(i, simulation_.truth(i).pose);
    }
    if (exploration_ && now % from_seconds(ExplorationRecord::kPeriod) == 0ns) explore(now);
    expectations_.judge(now, evidence());
    observed_ = now;
    if (params_.progress && now % 1s == 0ns) params_.progress(now);
  }

  Evidence evidence() const {
    Evidence out;
    out.word = [this](const std::string& robot) -> const RobotWord& { return witness_.word(robot); };
    out.pose = [this](const std::string& robot) { return truth(robot).pose.planar(); };
    out.collisions = [this](const std::string& robot) { return static_cast<int>(truth(robot).collisions); };
    out.caused = [this](const std::string& robot) { return static_cast<int>(truth(robot).caused); };
    out.exploration = exploration_.get();
    out.index = [this](const std::string& robot) { return simulation_.find(robot).value(); };
    out.notified = [this](const std::string& by, const std::string& code, const std::string& robot) {
      return witness_.notified(by, code, robot);
    };
    out.reported = [this](const std::string& robot, Reason reason) {
      return witness_.reported(robot, reason);
    };
    out.map = [this](const std::string& by) { return judged_map(by); };
    for (const auto& [id, station] : stations_) {
      if (const auto answer = station->last_answer()) out.last_answer[id] = *answer;
      if (const auto findings = station->findings()) out.findings[id] = *findings;
      if (const station::Station* running = station->station()) {
        out.photos[id] = running->photos();
        out.pictures[id] = running->cameras().pictures();
      }
    }
    return out;
  }

  const Truth& truth(const std::string& robot) const {
    return simulation_.truth(simulation_.find(robot).value());
  }

  Result<void> health() const {
    for (const auto& [id, robot] : robots_)
      if (!robot->health()) return robot->health();
    for (const auto& [id, station] : stations_)
      if (!station->health()) return station->health();
    return faults_.health();
  }

  std::optional<MapResult> map_result() const {
    const bool any = std::any_of(
        scenario_.robots.begin(), scenario_.robots.end(),
        [](const RobotSpec& robot) { return robot.settings.perception == PerceptionLevel::slam; });
    if (!any) return std::nullopt;
    MapResult out;
    for (const std::string_view topic : {wire::topics::kBulk.name, wire::topics::kBulkAck.name})
      if (const auto found = witness_.topics().find(topic); found != witness_.topics().end())
        out.bytes += found->second.bytes;
    for (const auto& [id, station] : stations_)
      if (const station::ChunkStore* map = station->chunks())
        out.m2 = std::max(out.m2, station::ground_area(*map, Time{}).m2);
    return out;
  }

  RunReport report(double wall) {
    RunReport out;
    out.scenario = scenario_.file.string();
    out.seed = params_.seed;
    out.digest = witness_.digest();
    out.virtual_s = seconds(observed_);
    out.wall_s = wall;
    out.topics = witness_.topics();
    out.commands = witness_.commands();
    out.events = witness_.events();
    for (const Collision& contact : simulation_.collisions()) out.events.push_back(event_of(contact));
    std::stable_sort(out.events.begin(), out.events.end(),
                     [](const TimedEvent& a, const TimedEvent& b) { return a.at < b.at; });
    out.faults = faults_.counts();
    out.failures = scheduler_.failures();
    for (const int rule : Checker::kNumbers) {
      RuleResult result{rule, Checker::title(rule), checker_.count(rule), {}};
      for (const Violation& violation : checker_.violations())
        if (violation.rule == rule) result.first.push_back(violation);
      out.rules.push_back(std::move(result));
    }
    for (const RobotSpec& robot : scenario_.robots) {
      const Truth& is = truth(robot.id);
      out.robots[robot.id] = {
          is.distance,      static_cast<int>(is.collisions),    static_cast<int>(is.caused),
          is.min_clearance, seconds(is.moving) / out.virtual_s, mode_seconds_[robot.id]};
    }
    if (exploration_) out.exploration = exploration_->result();
    out.trajectories = trajectory_files_;
    out.map = map_result();
    for (const auto& [id, station] : stations_) {
      if (!out.map || out.map->judged) break;
      if ((out.map->judged = judged_map(id))) out.map->by = id;
    }
    out.expectations = expectations_.finish(evidence(), out);
    return out;
  }

  const Scenario& scenario_;
  const RunParams& params_;
  Random random_;
  Simulation simulation_;
  VirtualScheduler scheduler_;
  wire::SimulatedNetwork network_;
  Checker checker_;
  Witness witness_;
  Stage stage_;
  Expectations expectations_;
  std::unique_ptr<record::FrameRecorder> recorder_{};
  std::unique_ptr<Runtime> world_runtime_{};
  std::shared_ptr<Executor> world_{};
  Timer step_{};
  RobotMachines robots_{};
  StationMachines stations_{};
  FaultPlayer faults_{stage_, robots_, stations_};
  std::unique_ptr<ExplorationRecord> exploration_{};
  std::unique_ptr<SeenSurfaceRecord> surface_{};
  std::unique_ptr<Trajectories> trajectories_{};
  std::map<std::string, TrajectoryFiles> trajectory_files_{};
  std::map<std::string, Trail> trails_{};
  std::vector<Trail> people_{};
  std::map<std::string, std::map<std::string, double>> mode_seconds_{};
  Duration observed_{};
  Duration last_event_{};  ///< When the last line of the script is typed and the last fault has ended.
};

}  // namespace

void add_people(const Simulation& simulation, std::vector<Trail>& trails) {
  const std::vector<Person>& people = simulation.people();
  trails.resize(people.size());
  for (std::size_t n = 0; n < people.size(); ++n) trails[n].poses.push_back(people[n].body().pose);
}

Draws draw(const Scenario& scenario, std::uint64_t seed) {
  Random random(seed);
  const Random script = random.fork(7), faults = random.fork(8);
  Draws out;
  if (scenario.random) out.script = draw_script(*scenario.random, scenario, script);
  if (scenario.random_faults) out.faults = draw_faults(*scenario.random_faults, scenario, faults);
  return out;
}

Result<std::shared_ptr<const World>> make_world(const WorldSpec& spec) {
  auto world = !spec.map.empty()          ? load_octomap(spec.map)
               : !spec.floor_plan.empty() ? load_floor_plan(spec.floor_plan, spec.ceiling)
                                          : make_box_world(spec.boxes, spec.floor, spec.ceiling);
  if (!world) return world.error();
  return std::shared_ptr<const World>(std::make_shared<World>(std::move(*world)));
}

std::vector<RobotStart> make_starts(const Scenario& scenario) {
  std::vector<RobotStart> out;
  for (const RobotSpec& spec : scenario.robots) out.push_back({spec.id, spec.settings.platform, spec.pose});
  return out;
}

DriverParams make_driver_params(const RobotSpec& spec) {
  DriverParams out;
  out.charge = spec.charge;
  out.drain = spec.drain;
  out.velocity = spec.settings.velocity;
  return out;
}

SimulationParams make_simulation_params(const Scenario& scenario, std::uint64_t seed) {
  SimulationParams out;
  if (scenario.lidar == LidarKind::planar) out.lidar = LidarParams::planar();
  out.realistic = scenario.lidar == LidarKind::full;
  out.noise = scenario.noise;
  out.dust = scenario.world.dust;
  out.dropouts = scenario.dropouts;
  out.odometry = (out.realistic ? OdometryParams::realistic() : OdometryParams{}).scaled(scenario.noise);
  if (!out.realistic) out.lidar.range_noise *= scenario.noise;  // A sweep scales its noise itself.
  out.seed = seed;
  out.people = scenario.people;
  return out;
}

Result<RunOutcome> rehearse(const Scenario& scenario, std::shared_ptr<const World> world,
                            const RunParams& params) {
  Random random(params.seed);
  auto simulation = Simulation::create(std::move(world), make_starts(scenario),
                                       make_simulation_params(scenario, random.fork(3).next()));
  if (!simulation)
    return Error{simulation.error().reason, scenario.file.string() + ": " + simulation.error().text};
  Run run(scenario, std::move(*simulation), params);
  return run.go();
}

}  // namespace adit::sim
