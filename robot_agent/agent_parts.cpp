#include "robot_agent/agent_parts.hpp"

#include "core/config/search.hpp"
#include "core/time/random.hpp"
#include "core/wire/component_io.hpp"

namespace adit::agent {
namespace {

/// A clean end waits so long for what is not on disk yet. The program ends itself after 3 s.
constexpr Duration kDiskDrain = 2s;

/// Runs the robot's tree, or holds because it was refused.
std::unique_ptr<Decider> decider_of(const AgentParams& params) {
  const ModeTable& table = params.modes ? *params.modes : ModeTable::shipped();
  const auto file = config::find_file(params.tree);
  if (!file) return Decider::refused(file.error(), table);
  auto decider = params.load_tree ? params.load_tree(*file) : Decider::load(*file, table);
  return decider ? std::move(*decider) : Decider::refused(decider.error(), table);
}

/// What lives on the seat opens its writers and readers by it: they end when its strand is left behind.
wire::ComponentIo io_of(const Seat& seat, wire::Wire& wire) { return {wire, *seat.strand, seat.generation}; }

}  // namespace

Agent::Parts::Parts(const AgentParams& agent_params, Runtime& agent_runtime)
    : params(agent_params),
      runtime(agent_runtime),
      command(agent_runtime, command_unit()),
      planner(agent_runtime, planner_unit()),
      router(agent_runtime, router_unit()),
      sensors(agent_runtime, sensors_unit()),
      watch_strand(agent_runtime.strand("supervisor")) {}

Agent::Parts::~Parts() {
  watch_strand->end();
  for (Unit* unit : {&command, &sensors, &planner, &router}) unit->end();
  end_disk();
  if (watch) watch->stop();
  if (edges && edges->radio) edges->radio->close();
  if (edges && edges->driver) edges->driver->close();
}

void Agent::Parts::end_disk() {
  if (!disk_strand) return;
  if (edges && edges->driver) edges->driver->write({});  // the disk must not delay the zero
  if (edges && edges->keeper) edges->keeper->flush();
  if (edges && edges->findings) edges->findings->flush();
  disk_strand->drain(kDiskDrain);  // one that does not answer must not keep the process from ending
}

UnitParams Agent::Parts::command_unit() {
  UnitParams unit{};
  unit.name = "command";
  unit.make = [this](Executor& strand) -> Result<std::unique_ptr<Component>> {
    return std::unique_ptr<Component>(std::make_unique<Core>(params, strand, decider_of(params), *edges));
  };
  return unit;
}

UnitParams Agent::Parts::planner_unit() {
  UnitParams unit{};
  unit.name = "planner";
  unit.heavy = true;
  unit.make = [this](Executor& strand) -> Result<std::unique_ptr<Component>> {
    return std::unique_ptr<Component>(
        std::make_unique<Planner>(PlannerParams{params.platform, params.planning, params.local_planner},
                                  strand, Log(params.log, params.name), edges->planner, library()));
  };
  return unit;
}

UnitParams Agent::Parts::router_unit() {
  UnitParams unit{};
  unit.name = "router";
  unit.heavy = true;
  unit.make = [this](Executor& strand) -> Result<std::unique_ptr<Component>> {
    RouterParams router_params{};
    router_params.platform = params.platform;
    return std::unique_ptr<Component>(std::make_unique<Router>(std::move(router_params), strand,
                                                               Log(params.log, params.name), *edges->router));
  };
  return unit;
}

UnitParams Agent::Parts::sensors_unit() {
  UnitParams unit{};
  unit.name = "sensors";
  unit.make = [this](Executor& strand) -> Result<std::unique_ptr<Component>> {
    return std::unique_ptr<Component>(std::make_unique<Scans>(strand, Log(params.log, params.name),
                                                              params.platform.lidar_height, edges->scans));
  };
  unit.fit = [this](const std::shared_ptr<Seat>& seat) -> Result<std::shared_ptr<void>> {
    auto readers = Scans::read(io_of(*seat, *robot_wire), [seat = std::weak_ptr<Seat>(seat)] {
      const auto taken = seat.lock();
      return taken ? static_cast<Scans*>(taken->component.get()) : nullptr;
    });
    if (!readers) return readers.error();
    return std::shared_ptr<void>(std::make_shared<Scans::Readers>(std::move(*readers)));
  };
  return unit;
}

Result<void> Agent::Parts::open(wire::Wire& radio, wire::Wire& robot) {
  robot_wire = &robot;
  if (const auto opened = command.open(); !opened) return opened.error();
  Executor& strand = command_strand();
  edges = std::make_unique<Edges>(strand, radio.id());
  Edges& e = *edges;
  auto notifier = Notifier::open(radio, params.name, strand);
  if (!notifier) return notifier.error();
  e.notifier = std::move(*notifier);
  auto radio_edge = RadioEdge::open(io_of(*command.seat(), radio), params.name);
  if (!radio_edge) return radio_edge.error();
  e.radio = std::move(*radio_edge);
  e.wire = &radio;

  e.restored = restore_state(params.disk);
  if (params.disk && !params.disk->instant()) disk_strand = runtime.strand("disk");
  e.keeper = std::make_unique<StateKeeper>(KeeperParams{}, params.disk, strand, disk_strand,
                                           e.restored.generation, keeper_outputs());

  e.findings =
      std::make_unique<FindingSync>(SyncParams{.robot = params.name,
                                               .most = params.findings,
                                               .seed = Random(params.seed).fork(kFindingsSalt).next()},
                                    params.disk, strand, disk_strand, findings_outputs());
  if (const std::string lost = e.findings->load().text(); !lost.empty())
    e.notifier->send(
        {{}, Severity::error, "findings_damaged", Reason::cannot_read, params.name + ": " + lost});

  const auto with_core = [&e](const auto& use) {
    if (e.core) use(*e.core);
  };
  Driver::Handlers handlers{};
  handlers.odometry = [with_core](const Pose3& odom, const Twist2& twist, std::uint64_t stamp,
                                  Time received) {
    with_core([&](Core& core) { core.odometry(odom, twist, stamp, received); });
  };
  handlers.battery = [with_core](float charge) { with_core([&](Core& core) { core.battery(charge); }); };
  handlers.external = [with_core](const Twist2& velocity, Time received) {
    with_core([&](Core& core) { core.external(velocity, received); });
  };
  handlers.rival = [with_core](const wire::ParticipantId& writer, Time received) {
    with_core([&](Core& core) { core.rival(writer, received); });
  };
  auto driver = Driver::open(io_of(*command.seat(), robot), params.velocity, std::move(handlers));
  if (!driver) return driver.error();
  e.driver = std::move(*driver);

  const bool routes_it = params.platform.router != "none";
  for (Unit* unit : {&planner, &router, &sensors})
    if (unit != &router || routes_it)
      if (const auto opened = unit->open(); !opened) return opened.error();
  if (routes_it) e.router = std::make_unique<RouteServices>();
  auto opened = Watch::open({params.name, params.supervision, Log(params.log, params.name), params.end,
                             params.alive, params.velocity},
                            *watch_strand, radio, robot, *e.notifier);
  if (!opened) return opened.error();
  watch = std::move(*opened);
  e.watch = watch.get();
  watch->watch(command, {.name = "command", .replaceable = false, .always = true});
  watch->watch(planner, {.name = "planner"});
  if (routes_it) watch->watch(router, {.name = "router"});
  watch->watch(sensors, {.name = "sensors"});
  if (params.disk) watch->note({.name = "store"});
  return e.radio->listen({e.directory, e.namesakes,
                          [with_core](const std::function<void(CommandInterface&)>& use) {
                            with_core([&](Core& core) { core.commands(use); });
                          },
                          [&e](Task task) {
                            if (e.core) e.core->keep();
                            e.keeper->when_safe(std::move(task));
                          },
                          [with_core](const Eigen::Vector3d& goal, const auto& done) {
                            with_core([&](Core& core) { core.find_route(goal, done); });
                          },
                          [&e, &strand](const Id& station, std::span<const std::uint64_t> ids) {
                            e.findings->acknowledged(station, ids, strand.now());
                          }});
}

std::shared_ptr<const nav::PlannerLibrary> Agent::Parts::library() {
  if (params.platform.planner != nav::planner_names().front()) return nullptr;  // no other planner has one
  {
    const std::lock_guard lock(mutex_);
    if (library_) return library_;
  }
  auto made =
      params.library ? params.library(params.platform) : nav::PlannerLibrary::build(params.platform, {});
  const std::lock_guard lock(mutex_);
  return library_ = std::move(made);
}

StateKeeper::Outputs Agent::Parts::keeper_outputs() {
  return {[this](bool failing, const std::string& text) {
    if (failing)
      edges->notifier->send({{},
                             Severity::error,
                             "store_failing",
                             Reason::cannot_write,
                             params.name + " cannot keep its state over a restart: " + text});
    else
      edges->notifier->send({{}, Severity::info, "store_works", Reason::none, params.name + ": " + text});
    ComponentRow row{.name = "store", .healthy = !failing};
    if (failing) {
      row.state = PartState::failed;
      row.text = "the disk does not keep the state";
    }
    watch->note(row);
  }};
}

FindingSync::Outputs Agent::Parts::findings_outputs() {
  const auto tell = [this](Severity severity, const char* code, const std::string& text) {
    edges->notifier->send({{}, severity, code, Reason::none, params.name + ": " + text});
  };
  return {[tell](const std::string& text) { tell(Severity::warning, "findings_full", text); },
          [tell](bool failing, const std::string& text) {
            tell(failing ? Severity::error : Severity::info, failing ? "store_failing" : "store_works", text);
          }};
}

Unit* Agent::Parts::find(const std::string& component) {
  for (Unit* unit : {&command, &planner, &router, &sensors})
    if (unit->name() == component && (unit != &router || edges->router)) return unit;
  return nullptr;
}

}  // namespace adit::agent
