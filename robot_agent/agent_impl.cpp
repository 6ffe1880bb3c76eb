// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/agent_impl.hpp"

#include "core/config/search.hpp"
#include "core/store/crc32c.hpp"
#include "core/time/random.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/motion/sensor_readers.hpp"

namespace adit::agent {
namespace {

/// Maximum wait of a clean end for pending disk writes. The program ends itself after 3 s.
constexpr Duration kDiskDrain = 2s;

/// Makes the decider of the robot's tree, or one that holds because the tree was refused.
std::unique_ptr<Decider> decider_of(const AgentParams& params) {
  const ModeTable& table = params.modes ? *params.modes : ModeTable::shipped();
  const auto file = config::find_file(params.tree);
  if (!file) return Decider::refused(file.error(), table);
  auto decider = params.load_tree ? params.load_tree(*file) : Decider::load(*file, table);
  return decider ? std::move(*decider) : Decider::refused(decider.error(), table);
}

/// Returns what a component on the slot needs to open its writers and readers: they end when its strand is
/// left behind.
wire::ComponentIo io_of(const ComponentSlot& slot, wire::Participant& wire) {
  return {wire, *slot.strand, slot.generation};
}

contract::ComponentHealth store_health(bool failing) {
  return {.name = "store",
          .state = failing ? PartState::failed : PartState::up,
          .healthy = !failing,
          .automatic = true,
          .text = failing ? "the disk does not keep the state" : ""};
}

}  // namespace

Agent::Impl::Impl(const AgentParams& agent_params, Runtime& agent_runtime)
    : params(agent_params),
      runtime(agent_runtime),
      command(agent_runtime, command_unit()),
      planner(agent_runtime, planner_unit()),
      router(agent_runtime, router_unit()),
      sensors(agent_runtime, sensors_unit()),
      map(agent_runtime, map_unit()),
      stairs(agent_runtime, stairs_unit()),
      cameras(agent_runtime, cameras_unit()),
      objects(agent_runtime, objects_unit()),
      watch_strand(agent_runtime.strand("supervisor")) {}

Agent::Impl::~Impl() {
  watch_strand->end();
  for (Unit* unit : {&command, &sensors, &planner, &router, &map, &stairs, &cameras, &objects}) unit->end();
  end_disk();
  if (watch) watch->stop();
  if (context && context->radio) context->radio->close();
  if (context && context->driver) context->driver->close();
  if (context && context->detections) context->detections->close();
  if (context && context->reports) context->reports->close();
}

void Agent::Impl::end_disk() {
  if (!disk_strand) return;
  if (context && context->driver) context->driver->write({});  // The disk must not delay the zero velocity.
  if (context && context->keeper) context->keeper->flush();
  if (context && context->findings) context->findings->flush();
  if (context && context->photos) context->photos->flush();
  if (context && context->map) context->map->flush();
  disk_strand->drain(kDiskDrain);  // A disk that does not answer must not prevent the end of the process.
}

UnitParams Agent::Impl::command_unit() {
  return {.name = "command", .make = [this](Executor& strand) -> std::unique_ptr<Component> {
            return std::make_unique<CommandComponent>(params, strand, decider_of(params), *context);
          }};
}

UnitParams Agent::Impl::planner_unit() {
  return {
      .name = "planner", .dedicated = true, .make = [this](Executor& strand) -> std::unique_ptr<Component> {
        const PlannerParams planner_params{params.platform, params.planning, params.local_planner,
                                           params.watch_maps};
        return std::make_unique<Planner>(planner_params, strand, Log(params.log, params.name),
                                         context->planner, library());
      }};
}

UnitParams Agent::Impl::router_unit() {
  return {
      .name = "router", .dedicated = true, .make = [this](Executor& strand) -> std::unique_ptr<Component> {
        return std::make_unique<Router>(params.platform, strand, Log(params.log, params.name),
                                        *context->router, params.watch_maps);
      }};
}

UnitParams Agent::Impl::map_unit() {
  return {.name = "map", .dedicated = true, .make = [this](Executor& strand) -> std::unique_ptr<Component> {
            return std::make_unique<MapPart>(MapParams{}, strand, Log(params.log, params.name),
                                             context->map_insertion);
          }};
}

UnitParams Agent::Impl::stairs_unit() {
  return {
      .name = "stairs", .dedicated = true, .make = [this](Executor& strand) -> std::unique_ptr<Component> {
        return std::make_unique<StairsPart>(
            StairsParams{.instance = ++context->stairs_searches, .eye = params.platform.lidar_origin()},
            strand, Log(params.log, params.name), context->stairs_search);
      }};
}

UnitParams Agent::Impl::cameras_unit() {
  UnitParams unit{.name = "cameras", .dedicated = true};
  unit.make = [this](Executor& strand) -> std::unique_ptr<Component> {
    Random runs = Random(params.seed).fork(kCameraSalt + (std::uint64_t{++context->camera_parts} << 8));
    return std::make_unique<CameraPart>(CameraParams{.robot = params.name,
                                                     .cameras = params.platform.cameras,
                                                     .run = static_cast<std::uint32_t>(runs.next()) | 1U},
                                        strand, Log(params.log, params.name), *camera_ends, context->cameras,
                                        context->place_then,
                                        [&inputs = *context->inputs, &strand](const InputFault& fault) {
                                          inputs.report(fault, strand.now());
                                        });
  };
  unit.open_io = [this](const std::shared_ptr<ComponentSlot>& slot) -> Result<std::shared_ptr<void>> {
    camera_ends =
        std::make_unique<CameraEnds>(CameraEnds{io_of(*slot, *context->wire), io_of(*slot, *robot_wire)});
    return std::shared_ptr<void>();
  };
  return unit;
}

UnitParams Agent::Impl::objects_unit() {
  UnitParams unit{.name = "objects"};  // Its work takes seconds: it goes to the pool, with its watchdog.
  unit.make = [this](Executor& strand) -> std::unique_ptr<Component> {
    return std::make_unique<ObjectsPart>(ObjectsPartParams{.cameras = params.platform.cameras,
                                                           .detector = params.objects->detector,
                                                           .make = params.make_detector,
                                                           .period = params.objects->period,
                                                           .instance = ++context->object_parts},
                                         strand, Log(params.log, params.name), *objects_io,
                                         context->objects_search,
                                         [&inputs = *context->inputs, &strand](const InputFault& fault) {
                                           inputs.report(fault, strand.now());
                                         });
  };
  unit.open_io = [this](const std::shared_ptr<ComponentSlot>& slot) -> Result<std::shared_ptr<void>> {
    objects_io = std::make_unique<wire::ComponentIo>(io_of(*slot, *robot_wire));
    return std::shared_ptr<void>();
  };
  return unit;
}

UnitParams Agent::Impl::sensors_unit() {
  UnitParams unit{.name = "sensors"};
  unit.make = [this](Executor& strand) -> std::unique_ptr<Component> {
    return std::make_unique<Scans>(
        strand, Log(params.log, params.name), params.platform, context->scans,
        [&inputs = *context->inputs, &strand](const InputFault& fault) {
          inputs.report(fault, strand.now());
        },
        context->static_frames->all(), params.perception == PerceptionLevel::off ? 0 : ++context->odometries,
        params.perception == PerceptionLevel::off ? nullptr : &context->place.found_place);
  };
  unit.open_io = [this](const std::shared_ptr<ComponentSlot>& slot) -> Result<std::shared_ptr<void>> {
    auto readers = read_sensors(
        io_of(*slot, *robot_wire), params.platform,
        [slot = std::weak_ptr<ComponentSlot>(slot)] {
          const auto taken = slot.lock();
          return taken ? static_cast<Scans*>(taken->component.get()) : nullptr;
        },
        context->odometry_source, context->static_frames);
    if (!readers) return readers.error();
    return std::shared_ptr<void>(std::make_shared<SensorReaders>(std::move(*readers)));
  };
  return unit;
}

Result<void> Agent::Impl::open(wire::Participant& radio, wire::Participant& robot) {
  robot_wire = &robot;
  if (const auto opened = command.open(); !opened) return opened.error();
  Executor& strand = command_strand();
  context = std::make_unique<Context>(strand, radio.id());
  Context& e = *context;
  auto notifier = Notifier::open(radio, params.name, strand);
  if (!notifier) return notifier.error();
  e.notifier = std::move(*notifier);
  auto radio_edge = RadioEdge::open(io_of(*command.slot(), radio), params.name);
  if (!radio_edge) return radio_edge.error();
  e.radio = std::move(*radio_edge);
  e.wire = &radio;
  e.robot_wire = &robot;

  e.restored = restore_state(params.disk);
  if (params.start_given)
    if (const auto stored = e.restored.place_at(params.start, params.start_height, params.disk); !stored)
      return Error{stored.reason(),
                   "the start's pose cannot replace the stored place: " + stored.error().text +
                       "; repair that, or start with another folder (--state)"};
  if (params.disk && !params.disk->instant()) disk_strand = runtime.strand("disk");
  e.keeper = std::make_unique<StateKeeper>(KeeperParams{}, params.disk, strand, disk_strand,
                                           e.restored.generation, keeper_outputs());

  e.findings =
      std::make_unique<FindingSource>(FindingParams{.robot = params.name,
                                                    .owner = params.id,
                                                    .max_findings = params.findings,
                                                    .seed = Random(params.seed).fork(kFindingsSalt).next()},
                                      params.disk, strand, disk_strand, findings_outputs());
  if (const std::string lost = e.findings->load().text(); !lost.empty())
    e.notifier->to_all(Severity::error, "findings_damaged", Reason::cannot_read, params.name + ": " + lost);

  e.photos = std::make_unique<findings::PhotoStore>(findings::PhotoStoreParams{}, params.disk, strand,
                                                    disk_strand, photos_outputs());
  if (const std::string lost = e.photos->load(); !lost.empty())
    e.notifier->to_all(Severity::error, "findings_damaged", Reason::cannot_read, params.name + ": " + lost);
  e.photo_sources = std::make_unique<findings::PhotoSources>(*e.photos, params.disk, strand, disk_strand);
  e.photo_sources->ledger.load();

  if (params.perception != PerceptionLevel::off) {
    e.place.keyframes = std::make_unique<KeyframeStore>(params.disk, strand, disk_strand);
    e.place.keyframes->load();
    if (const std::string lost = e.place.keyframes->text(); !lost.empty())
      e.notifier->to_all(Severity::error, "keyframes_damaged", Reason::cannot_read,
                         params.name + ": " + lost);
  }

  const auto with_command = [&e](const auto& use) {
    if (e.command_component) use(*e.command_component);
  };
  Driver::Handlers handlers{};
  handlers.odometry = [with_command](const Pose3& odom, const Twist2& twist, std::uint64_t stamp,
                                     Time received) {
    with_command([&](CommandComponent& component) { component.odometry(odom, twist, stamp, received); });
  };
  handlers.battery = [with_command](float charge) {
    with_command([&](CommandComponent& component) { component.battery(charge); });
  };
  handlers.external = [with_command](const Twist2& velocity, Time received) {
    with_command([&](CommandComponent& component) { component.external(velocity, received); });
  };
  handlers.rival = [with_command](const wire::ParticipantId& writer, Time received) {
    with_command([&](CommandComponent& component) { component.rival(writer, received); });
  };
  handlers.fault = [&e, &strand](const InputFault& fault) {
    if (e.command_component) e.inputs->report(fault, strand.now());
  };
  e.inputs = std::make_unique<InputFaults>(
      params.name, InputFaults::Outputs{[notifier = e.notifier.get(),
                                         log = Log(params.log, params.name, &strand)](const Notice& notice) {
                                          log.warn(notice.code + ": " + notice.text);
                                          notifier->send(notice);
                                        },
                                        [&e](const contract::ComponentHealth& row) {
                                          if (e.watch) e.watch->note(row);
                                        }});
  auto driver =
      Driver::open(io_of(*command.slot(), robot), params.velocity, std::move(handlers), e.odometry_source);
  if (!driver) return driver.error();
  e.driver = std::move(*driver);

  e.detections = std::make_unique<DetectionInput>(
      params.detections, params.name, params.platform, e.static_frames, *e.findings,
      DetectionInput::Outputs{
          [&e, &strand](const InputFault& fault) { e.inputs->report(fault, strand.now()); }});
  if (auto opened = e.detections->open(io_of(*command.slot(), robot)); !opened) return opened.error();

  e.reports = std::make_unique<ReportInput>(
      params.reports, params.platform, e.static_frames, *e.findings, *e.photos, strand,
      [&e, &strand](const InputFault& fault) { e.inputs->report(fault, strand.now()); });
  if (auto opened = e.reports->open(io_of(*command.slot(), robot)); !opened) return opened.error();

  const bool routes_it = has(router), maps_it = has(map);
  e.stairs =
      has(stairs)
          ? std::make_unique<StairsReporter>(
                params.name, *e.findings,
                StairsReporter::Submaps{[&e](const findings::Anchor& anchor) -> std::optional<Pose3> {
                                          return e.map ? e.map->submap_pose(anchor.start, anchor.submap)
                                                       : std::nullopt;
                                        },
                                        [&e] { return e.map ? e.map->pose_changes() : std::uint64_t{0}; }})
          : nullptr;
  if (has(objects)) {
    DetectionParams report = params.objects->report;
    // Each camera has its turn: sightings of one object come once a round.
    const auto round = static_cast<int>(params.platform.cameras.size()) * params.objects->period;
    report.lapse = std::max<Duration>(report.lapse, 3 * round);
    e.objects = std::make_unique<DetectionReporter>(
        std::move(report), params.name, *e.findings,
        [&e](const findings::Photo& photo, std::uint8_t importance) -> std::optional<findings::PhotoRef> {
          if (!e.photos->put(photo, importance)) return std::nullopt;
          return findings::ref_of(photo);
        });
  }
  if (has(cameras)) e.shots = std::make_unique<ShotSource>();
  for (Unit* unit : {&planner, &router, &sensors, &map, &stairs, &cameras, &objects})
    if (has(*unit))
      if (const auto opened = unit->open(); !opened) return opened.error();
  if (maps_it) open_map();
  if (params.carry_maps) e.carrier = std::make_unique<Carrier>(Random(params.seed).fork(kCarrySalt).next());
  e.content = std::make_unique<ContentSender>(Random(params.seed).fork(kContentSalt).next(), *e.findings,
                                              *e.photo_sources, e.map.get(), e.carrier.get(), e.shots.get());
  const Task send_pieces = [&e] {
    if (e.command_component) e.command_component->send_pieces();
  };
  if (e.map) e.map->encode_on(strand, send_pieces);
  if (e.carrier) e.carrier->compute_on(strand, send_pieces);
  if (routes_it) e.router = std::make_unique<RouteServices>();
  auto opened = AgentSupervisor::open({params.name, params.supervision, Log(params.log, params.name),
                                       params.end, params.alive, params.velocity},
                                      *watch_strand, radio, robot, *e.notifier);
  if (!opened) return opened.error();
  watch = std::move(*opened);
  e.watch = watch.get();
  watch->watch(command, {.name = "command", .replaceable = false, .always = true});
  watch->watch(planner, {.name = "planner"});
  if (routes_it) watch->watch(router, {.name = "router"});
  watch->watch(sensors, {.name = "sensors"});
  if (maps_it) watch->watch(map, {.name = "map"});
  if (e.stairs) watch->watch(stairs, {.name = "stairs"});
  if (e.shots) watch->watch(cameras, {.name = "cameras"});
  if (e.objects) watch->watch(objects, {.name = "objects"});
  if (params.disk) watch->note(store_health(false));
  return e.radio->listen(
      {e.directory, e.namesakes,
       [with_command](const std::function<void(CommandInterface&)>& use) {
         with_command([&](CommandComponent& component) { component.commands(use); });
       },
       [&e](Task task) {
         if (e.command_component) e.command_component->keep();
         e.keeper->when_safe(std::move(task));
       },
       [with_command](const Command& received, const auto& answered) {
         with_command([&](CommandComponent& component) { component.handle(received, answered); });
       },
       [&e](const std::optional<TeamBeacon>& beacon, const wire::ParticipantId& from, Time received) {
         if (beacon)
           e.peers.hear_beacon(*beacon, from, received);
         else
           e.peers.refuse_beacon(BeaconFault::malformed);
       },
       [&e, &strand, with_command](const std::string& station, const transfer::Ack& ack,
                                   const wire::ParticipantId& from) {
         if (ack.carrier) {
           if (e.peers.is_robot(station, from)) e.content->acknowledged(ack, strand.now());
           return;
         }
         with_command([&](CommandComponent& component) {
           component.commands([&](CommandInterface& interface) {
             // Only the participant that is bound to the station speaks for it.
             const Station* known = interface.stations().by_participant(from);
             if (known && known->name == station && known->id == ack.peer)
               e.content->acknowledged(ack, strand.now());
           });
         });
       },
       pieces_to_carry(), views_of_cameras(),
       [with_command](const std::string& name, const std::string& why) {
         with_command([&](CommandComponent& component) { component.announcement_refused(name, why); });
       }});
}

std::function<void(const contract::CameraViews&, const wire::ParticipantId&)>
Agent::Impl::views_of_cameras() {
  if (!context->shots) return {};
  return [this](const contract::CameraViews& views, const wire::ParticipantId& from) {
    CommandComponent* component = context->command_component;
    if (component == nullptr) return;
    component->commands([&](CommandInterface& interface) {
      // Only the participant that is bound to the station speaks for it.
      const Station* known = interface.stations().by_participant(from);
      if (known && known->name == views.station && known->id == views.station_id)
        component->look(views.station_id, views.views);
    });
  };
}

std::function<void(const contract::BulkPiece&, const wire::ParticipantId&)> Agent::Impl::pieces_to_carry() {
  if (!context->carrier) return {};
  return [this](const contract::BulkPiece& piece, const wire::ParticipantId& from) {
    // Only the robot itself says what its map is.
    if (context->peers.is_robot(piece.robot, from))
      (void)context->carrier->take(piece, command_strand().now());
  };
}

void Agent::Impl::open_map() {
  Context& e = *context;
  std::unique_ptr<MapDisk> disk{};
  if (params.disk)
    disk = std::make_unique<MapDisk>(
        MapDiskParams{.robot = params.name}, params.disk, command_strand(), disk_strand,
        [this](bool failing, const std::string& text) {
          if (failing)
            context->notifier->to_all(Severity::error, "map_not_stored", Reason::cannot_write,
                                      params.name + " cannot keep its map over a restart: " + text);
          else
            context->notifier->to_all(Severity::info, "map_stored", Reason::none, params.name + ": " + text);
        });
  e.map = std::make_unique<MapKeeper>(MapKeeperParams{.robot = params.name,
                                                      .seed = Random(params.seed).fork(kMapSalt).next(),
                                                      .owner = crc32c(params.id),
                                                      .origin = params.platform.lidar_origin()},
                                      std::move(disk));
  const LoadedMap loaded = e.map->load();
  if (const std::string lost = loaded.text(); !lost.empty())
    e.notifier->to_all(Severity::error, "map_damaged", loaded.reason, params.name + ": " + lost);
}

std::shared_ptr<const nav::PlannerLibrary> Agent::Impl::library() {
  if (params.platform.planner != nav::planner_names().front())
    return nullptr;  // No other planner has a library.
  {
    const std::lock_guard lock(mutex_);
    if (library_) return library_;
  }
  auto made = params.library ? params.library(params.platform) : nav::PlannerLibrary::build(params.platform);
  const std::lock_guard lock(mutex_);
  return library_ = std::move(made);
}

StateKeeper::Outputs Agent::Impl::keeper_outputs() {
  return {[this](bool failing, const std::string& text) {
    if (failing)
      context->notifier->to_all(Severity::error, "store_failing", Reason::cannot_write,
                                params.name + " cannot keep its state over a restart: " + text);
    else
      context->notifier->to_all(Severity::info, "store_works", Reason::none, params.name + ": " + text);
    watch->note(store_health(failing));
  }};
}

FindingSource::Outputs Agent::Impl::findings_outputs() {
  const auto notify = [this](Severity severity, const char* code, const std::string& text) {
    context->notifier->to_all(severity, code, Reason::none, params.name + ": " + text);
  };
  return {[notify](const std::string& text) { notify(Severity::warning, "findings_full", text); },
          [notify](bool failing, const std::string& text) {
            notify(failing ? Severity::error : Severity::info, failing ? "store_failing" : "store_works",
                   text);
          },
          [this](const std::array<double, 3>& place) { return anchor_of(place); }};
}

findings::PhotoStore::Outputs Agent::Impl::photos_outputs() {
  return {[this](bool failing, const std::string& text) {
            context->notifier->to_all(failing ? Severity::error : Severity::info,
                                      failing ? "store_failing" : "store_works", Reason::none,
                                      params.name + ": " + text);
          },
          [this](const std::string& text) {
            context->notifier->to_all(Severity::warning, "findings_full", Reason::none,
                                      params.name + ": " + text);
          }};
}

std::optional<findings::Anchor> Agent::Impl::anchor_of(const std::array<double, 3>& place) const {
  if (!context->map) return std::nullopt;
  const auto in = context->map->place_in_submap({place[0], place[1], place[2]});
  if (!in || in->offset.norm() > double{findings::Anchor::kFarthest}) return std::nullopt;
  const Eigen::Vector3f offset = in->offset.cast<float>();
  return findings::Anchor{
      in->start, in->index, {offset.x(), offset.y(), offset.z()}, static_cast<float>(in->yaw)};
}

void Agent::Impl::with_findings(std::function<Result<void>(FindingSource& source, Time now)> work) {
  Executor& strand = command_strand();
  strand.post([context = context.get(), &strand, work = std::move(work)] {
    if (const auto done = work(*context->findings, strand.now()); !done)
      context->notifier->to_all(Severity::warning, "finding_refused", done.reason(),
                                "a finding: " + done.error().text);
  });
}

bool Agent::Impl::has(const Unit& unit) const {
  if (&unit == &router) return params.platform.router != "none";
  if (&unit == &map) return params.perception == PerceptionLevel::slam;
  if (&unit == &stairs) return params.perception != PerceptionLevel::off;
  if (&unit == &cameras) return !params.platform.cameras.empty();
  if (&unit == &objects) return params.objects && !params.platform.cameras.empty();
  return true;
}

Unit* Agent::Impl::find(const std::string& component) {
  for (Unit* unit : {&command, &planner, &router, &sensors, &map, &stairs, &cameras, &objects})
    if (unit->name() == component && has(*unit)) return unit;
  return nullptr;
}

}  // namespace adit::agent
