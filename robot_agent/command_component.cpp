// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command_component.hpp"

#include <algorithm>
#include <cmath>

#include "core/time/random.hpp"
#include "nav/routing/known_stairs.hpp"
#include "robot_agent/behaviour/modes/external.hpp"
#include "robot_agent/common/console_answer.hpp"

namespace adit::agent {
namespace {

CommandParams command_params(const AgentParams& params, const Frames& frames, std::uint32_t instance) {
  CommandParams c{};
  c.robot = params.name;
  // A different value for each instance of the component. No epoch starts with zero, the value of an unset
  // field in a message.
  Random starts(params.seed);
  for (std::uint32_t i = 0; i < instance; ++i) (void)starts.next();
  c.epoch_start = starts.next() | 1u;
  c.lock_lease = params.lock_lease;
  c.home = {frames.T_map_start().x, frames.T_map_start().y, std::nan("")};
  c.protocol = kProtocolVersion;
  return c;
}

NavigationParams navigation_params(const AgentParams& params) {
  NavigationParams n{};
  n.platform = params.platform;
  return n;
}

constexpr Duration kBeat = 50ms;  // Tree, mux, follower and driver run at 20 Hz.
constexpr Duration kStatePeriod = 100ms;
constexpr Duration kStatusPeriod = 1s;
constexpr Duration kPulse = 50ms;
constexpr Duration kLookAhead = 1s;   // Between two updates of what stations should get first.
constexpr double kRouteAhead = 20.0;  // m of the route: right of way looks so far ahead.
constexpr double kBeaconAge = 1.0;    // s: an older beacon of a robot that moves does not say where it is.

/// The staircase in another frame.
Staircase moved(const Pose3& T, Staircase stairs) {
  stairs.foot = T * stairs.foot;
  stairs.heading = wrap_angle(stairs.heading + T.yaw());
  return stairs;
}

}  // namespace

Agent::CommandComponent::CommandComponent(const AgentParams& params, Executor& command,
                                          std::unique_ptr<Decider> decider, Context& context)
    : Component("command", command, Log(params.log, params.name), {.beat = kPulse}),
      params_(params),
      context_(context),
      frames_(params.start, params.platform, params.start_height),
      router_(command, log(), params_.platform, frames_, context.router.get(),
              {[this] { return navigation_.route_areas(); }, [this] { return team(now()); },
               [this](std::span<const Eigen::Vector3d> places) {
                 return nav::nearest_stairs(known_stairs(), places, nav::SurfaceMap::kMaxStairs);
               }}),
      navigation_(navigation_params(params), command, log(), frames_, context.planner, context.router.get(),
                  navigation_outputs()),
      mux_(navigation_),
      convoy_({params.name, params.platform.length, params.platform.max_speed}, convoy_inputs()),
      right_of_way_({params.name, params.platform.length, params.platform.width, params.platform.max_speed,
                     context.router && !params.platform.flies()},
                    context.peers, right_of_way_outputs()),
      behaviour_({}, std::move(decider), mux_, behaviour_inputs(), behaviour_outputs()),
      commands_(command_params(params, frames_, context.instances++), behaviour_, command_outputs()),
      map_commands_(commands_,
                    {[this](const auto&... goal) { check_goal(goal...); },
                     [this](const auto&... goal) { router_.find_route(goal...); }, [this] { return now(); }}),
      notices_(params.name, *context.notifier, log(), [this] { return commands_.authority().holder_name(); }),
      safeguards_(params.safeguards, params.name, frames_.T_map_start(),
                  {commands_.authority(), context.peers, behaviour_, frames_, notices_}),
      localiser_(params_, command, log(), frames_, context.place, notices_, localiser_outputs()),
      telemetry_({*context.radio, *context.wire, context.rate, *context.driver, *context.watch, frames_,
                  commands_, behaviour_}),
      rivals_(now()),
      topics_(
          used_topics(params.platform, params.velocity, params.detections.topics, params.reports.topics)) {}

void Agent::CommandComponent::battery(float charge) {
  protect([&] { safeguards_.battery(charge, now()); });
}

void Agent::CommandComponent::external(const Twist2& velocity, Time received) {
  protect([&] {
    if (now() - received < ExternalMode::kFresh) behaviour_.program(velocity, received);
  });
}

void Agent::CommandComponent::announcement_refused(const std::string& name, const std::string& why) {
  if (refusals_reported_.pass(0, now())) notices_.announcement_refused(name, why);
}

void Agent::CommandComponent::rival(const wire::ParticipantId& writer, Time received) {
  protect([&] {
    if (rivals_.heard(writer, received)) notices_.rival(writer);
  });
}

void Agent::CommandComponent::commands(const std::function<void(CommandInterface&)>& use) {
  protect([&] { use(commands_); });
}

void Agent::CommandComponent::handle(const Command& command, const MapCommands::Answered& answered) {
  protect([&] { map_commands_.handle(command, answered); });
}

bool Agent::CommandComponent::same_boot() const {
  const auto& snapshot = context_.restored.snapshot;
  return snapshot && snapshot->boot == params_.boot;
}

void Agent::CommandComponent::restore() {
  // A component that was restarted within this process continues from its last state in memory, otherwise
  // from the state on the disk.
  if (const auto& last = context_.keeper->given()) context_.restored = restored_from(*last);
  if (!context_.restored.snapshot) {
    if (!context_.restored.lost) return;
    // Somebody may have stopped the robot: rule 7.
    commands_.restore({.stops = {{StopLatches::kOthers, Id{}}}}, {}, started_);
    behaviour_.restore({}, true, false, context_.instances == 1);
    return;
  }
  const Snapshot& s = *context_.restored.snapshot;
  commands_.restore(s.authority, s.answers,
                    started_);  // listen_first() checks which stations were heard since.
  note_holder();
  if (s.place) localiser_.restore(*s.place, context_.instances == 1);
  // Without a stored pose it is unknown whether the odometry frame is still the same. With one, the first
  // odometry sample decides.
  const bool comparable = s.place && s.place->newest;
  const bool resume = params_.resume_after_restart && same_boot() && comparable && !context_.restored.hold;
  behaviour_.restore(s.behaviour, commands_.stops().any(), resume, context_.instances == 1);
  // A copy of this robot's disk in another computer proves nothing.
  if (context_.instances == 1 && s.authority.holder && same_boot()) context_.namesakes.held_before();
  safeguards_.restore(s.battery, started_);
}

Result<void> Agent::CommandComponent::on_start() {
  started_ = now();
  restore();
  for (Component* part : parts()) {
    part->on_failure([this](const ComponentFailure& f) { fail(f.component + ": " + f.text); });
    part->set_generation(generation());
    if (const auto started = part->start(); !started) {
      for (Component* each : parts()) each->stop();
      return started;
    }
  }
  offer(context_.scans, [this](LidarScan lidar, const Reply<void>& reply) {
    localiser_.scan(std::move(lidar));
    reply({});
  });
  offer(context_.frames.find,
        [this](MapFrameQuery, const Reply<MapFrame>& reply) { reply(frames_.map_frame()); });
  offer(context_.frames.correct, [this](const MapFrame& corrected, const Reply<MapFrame>& reply) {
    reply(localiser_.correct_map(corrected));
  });
  if (context_.shots)
    offer(context_.place_then,
          [this](const PlaceQuery& query, const Reply<PlaceThen>& reply) { reply(place_then(query)); });
  context_.command_component = this;
  context_.driver->write({});
  if (context_.instances == 1)
    context_.radio->send_capabilities(params_.platform, params_.id, kProtocolVersion, behaviour_.table());
  behaviour_.tick(now());
  notices_.restored(context_.restored, same_boot());
  if (const std::string& why = behaviour_.tree_refusal(); !why.empty()) notices_.tree_refused(why);
  keep();
  telemetry_.start(now(), started_);
  timers_.push_back(every(kBeat, [this] { beat(); }));
  timers_.push_back(every(kStatePeriod, [this] {
    telemetry_.send_state(now(), safeguards_.charge(), localiser_.health(now()), localiser_.sigma());
    telemetry_.send_route(now(), followed_route(now()));
    context_.directory.tick(now());
    send_beacon(now());
    if (cameras_active_) ask_cameras({});
  }));
  timers_.push_back(every(kStatusPeriod, [this] {
    commands_.tick(now());
    safeguards_.tick(now());
    watch_topics(now());
    telemetry_.send_periodic(now());
  }));
  return {};
}

void Agent::CommandComponent::on_stop() {
  context_.command_component = nullptr;
  timers_.clear();
  for (Component* part : parts()) part->stop();
  context_.driver->write({});
}

Localiser::Outputs Agent::CommandComponent::localiser_outputs() {
  return {[this](Reason why) { behaviour_.hold(why, now()); }, [this] { navigation_.clear(); },
          [this] { keep(); }, [this] { return navigation_.movers(now()); },
          [this](std::shared_ptr<Scan> scan, const LidarScan& lidar) { located(std::move(scan), lidar); }};
}

void Agent::CommandComponent::odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp,
                                       Time received) {
  localiser_.odometry(odom, twist, stamp, received);
}

void Agent::CommandComponent::located(std::shared_ptr<Scan> scan, const LidarScan& lidar) {
  if (lidar.odometry) watch_grip(*lidar.odometry, now());
  if (localiser_.recognised()) {
    add_to_map(scan);
    seek_stairs(scan);
    seek_objects(scan, lidar);
  }
  navigation_.set_stairs(known_stairs());
  navigation_.add_scan(std::move(scan), lidar.received, now(), team(now()));
}

void Agent::CommandComponent::beat() {
  const Time at = now();
  watch_driver();
  localiser_.watch(now());
  const RobotPlace place{frames_, localiser_.T_odom_driver(), localiser_.unknown_because(at)};
  context_.detections->tick(place, at);
  context_.reports->tick(place, at);
  watch_namesakes(at);
  listen_first(at);
  convoy_.tick(at);
  constexpr std::uint32_t kBeats = 4;  // Beats between two looks at the other robots.
  if (beats_++ % kBeats == 0) give_way(at);
  behaviour_.tick(at);
  navigation_.limit_speed(
      std::min(convoy_.speed_limit(behaviour_.mode().name == "convoy_follow"), right_of_way_.speed_limit()));
  navigation_.set_areas(behaviour_.areas(), localiser_.sigma());
  mux_.step(at);
  navigation_.step(at);
  keep();
  context_.keeper->tick();
  send_content();
}

// A mode that resumes after a restart must not move before a stop from the meantime arrives; stations repeat
// the stop until this agent answers it.
void Agent::CommandComponent::listen_first(Time at) {
  constexpr Duration min_wait = 1s, heard_for = 300ms, max_wait = 3s;
  if (!behaviour_.listens() || context_.namesakes.verdict() == Namesakes::Verdict::undecided) return;
  const auto& authority = commands_.authority();
  if (!holder_heard_ && authority.holder() && authority.heard() > started_) holder_heard_ = at;
  const bool heard = !authority.holder() || (holder_heard_ && at - *holder_heard_ >= heard_for);
  if (at - started_ >= (heard ? min_wait : max_wait)) behaviour_.go_on(at);
}

void Agent::CommandComponent::keep() {
  context_.keeper->save(
      {commands_.stored(), behaviour_.stored(), params_.boot, safeguards_.stored(), localiser_.stored(), {}},
      [this] { return commands_.stored_answers(); }, commands_.accepted());
}

void Agent::CommandComponent::check_goal(const Eigen::Vector3d& goal, bool replace,
                                         const RouterClient::Done<GoalReport>& done) {
  // Where the robot does not know its place, the map around it says nothing about the goal.
  const Reason unknown = localiser_.unknown_because(now());
  if (unknown != Reason::none) return done({unknown, "the goal is not judged"});
  router_.check_goal(goal, replace, done);
}

void Agent::CommandComponent::watch_driver() {
  if (telemetry_.driver_fell_silent(now())) notices_.driver_lost();
}

void Agent::CommandComponent::watch_topics(Time at) {
  context_.driver->look();
  context_.detections->look(*context_.robot_wire);
  context_.reports->look(*context_.robot_wire);
  bool velocities = false;
  for (const InputFault& clash : type_clashes(*context_.robot_wire, topics_)) {
    context_.inputs->report(clash, at);
    velocities = velocities || clash.topic == "cmd_vel";
  }
  // A driver that is just starting may find the agent's writer late.
  constexpr int kLooks = 3;
  disobeyed_ = frames_.alive(at) && !context_.driver->obeyed() ? disobeyed_ + 1 : 0;
  if (disobeyed_ >= kLooks && !velocities)
    context_.inputs->report(
        {"cmd_vel",
         "velocities_unread",
         Severity::error,
         {Reason::driver_silent,
          "nobody reads /cmd_vel, although odometry arrives: the robot will not move; does "
          "its driver read that topic on this domain?"}},
        at);
  context_.inputs->tick(at);
}

void Agent::CommandComponent::watch_namesakes(Time at) {
  Namesakes& namesakes = context_.namesakes;
  const Authority& authority = commands_.authority();
  namesakes.claim({authority.holder().has_value(), authority.epoch().start}, at);
  const auto other = namesakes.tick(at);
  const bool gives_way = namesakes.verdict() == Namesakes::Verdict::gives_way;
  if (other && namesakes_reported_.pass(gives_way, at)) notices_.namesake(*other, gives_way);
  if (gives_way != std::exchange(gives_way_, gives_way)) {
    context_.radio->send_claim(namesakes.announced());
    behaviour_.hold(gives_way ? Reason::name_taken : Reason::none, at);
  } else if (gives_way && behaviour_.mode().name != "hold") {
    behaviour_.hold(Reason::name_taken, at);
  }
}

void Agent::CommandComponent::send_beacon(Time at) {
  if (!frames_.initialised()) return;
  const wire::LinkProfile* link = context_.wire->sender().link;
  const bool often = convoy_.in() || right_of_way_.in_encounter();
  double rate = BeaconRate::rate(link ? link->bandwidth : 0.0, context_.peers.robots_present(), often);
  if (!often) rate /= context_.rate.stretch();  // A full link.
  if (!beacon_rate_.due(rate, at, kStatePeriod)) return;
  TeamBeacon beacon{};
  beacon.robot = params_.name;
  beacon.start = commands_.authority().epoch().start;
  beacon.seq = ++beacons_;
  beacon.pose = frames_.T_map_base();
  beacon.z = frames_.height();
  beacon.twist = frames_.twist();
  beacon.mode = behaviour_.mode().name;
  beacon.stopped = commands_.stops().any();
  beacon.holder = commands_.authority().holder_name();
  beacon.convoy = convoy_.part(beacon.seq);
  right_of_way_.say(beacon);
  context_.radio->send(beacon);
}

Facts Agent::CommandComponent::sense(Time now) const {
  Facts f{};
  f.driver_alive = frames_.alive(now);
  if (const Reason why = localiser_.unknown_because(now); why != Reason::none) f.unlocalised = why;
  f.localised = frames_.initialised() && localiser_.known(now);
  if (f.localised && navigation_.is_far_out()) {
    f.localised = false;
    f.unlocalised = Reason::outside_area;
  }
  f.terrain_fresh = navigation_.terrain_fresh(now);
  f.map_fresh = navigation_.map_fresh(now);
  return f;
}

void Agent::CommandComponent::note_holder() {
  const auto& holder = commands_.authority().holder();
  context_.peers.set_holder(holder ? holder->name : std::string{}, holder ? holder->id : Id{});
}

CommandInterface::Outputs Agent::CommandComponent::command_outputs() {
  return {[this](const Notice& notice) { notices_.send(notice); },
          [this] {
            note_holder();
            keep();
            context_.keeper->when_safe(guard([this] { telemetry_.send_authority(now()); }));
          },
          [this](const std::string& component) { return context_.watch->restart(component); },
          [this](const std::string& component, bool automatic) {
            return context_.watch->set_policy(component, automatic);
          },
          [this](const Epoch& epoch) { return context_.namesakes.obeys(epoch.start); },
          [this](const MessageSender& station) { context_.peers.accept_station(station, now()); }};
}

Behaviour::Inputs Agent::CommandComponent::behaviour_inputs() {
  Behaviour::Inputs inputs{[this](Time at) { return sense(at); },
                           [this](const Eigen::Vector2d& place) { return navigation_.goal_free(place); },
                           {}};
  // A flying robot keeps its height.
  if (params_.platform.flies()) inputs.height = [this] { return frames_.height(); };
  inputs.set_pose = [this](const Pose2& pose) { return localiser_.set_pose(pose); };
  inputs.pose = [this]() -> std::optional<Pose2> {
    if (!frames_.initialised()) return std::nullopt;
    return frames_.T_map_base();
  };
  if (context_.router && !params_.platform.flies())
    inputs.explore = [this](const NextPlaceQuery& asked, const auto& done) { router_.explore(asked, done); };
  inputs.holder_heard = [this] {
    constexpr Duration kHeard = 3s;
    const Authority& authority = commands_.authority();
    return authority.holder() && now() - authority.heard() < kHeard;
  };
  inputs.home = frames_.T_map_start().position();
  inputs.stopping = [this] {
    const double speed = std::hypot(frames_.twist().vx, frames_.twist().vy);
    return speed * (seconds(kBeat) + speed / (2 * params_.platform.max_acceleration));
  };
  inputs.convoy = &convoy_;
  inputs.right_of_way = &right_of_way_;
  inputs.body_permitted = [this](const nav::AreaSet& areas) {
    return !frames_.initialised() ||
           areas.permits(nav::outline(params_.platform, frames_.T_map_base()), frames_.height());
  };
  inputs.goal_permitted = [this](const nav::AreaSet& areas, const Eigen::Vector3d& goal) {
    const double z = std::isfinite(goal.z()) ? goal.z() : frames_.height();
    return areas.with_margin(Fence::margin(localiser_.sigma()))
        .permits({goal.x(), goal.y(), z}, nav::least_reach(params_.platform));
  };
  return inputs;
}

Convoy::Inputs Agent::CommandComponent::convoy_inputs() {
  return {context_.peers,
          [this]() -> std::optional<Eigen::Vector3d> {
            if (!frames_.initialised()) return std::nullopt;
            const Pose2 pose = frames_.T_map_base();
            return Eigen::Vector3d(pose.x, pose.y, frames_.height());
          },
          [this](const auto&... notice) { notices_.to_holder(notice...); },
          [this](const Eigen::Vector2d& place) { return navigation_.goal_free(place); }};
}

RightOfWay::Outputs Agent::CommandComponent::right_of_way_outputs() {
  return {[this](const nav::Corridor& corridor, const std::string& asker, auto done) {
            router_.find_clear_place(corridor, asker, std::move(done));
          },
          [this](Time at) { return behaviour_.clear_way(at); }, [this](Time at) { behaviour_.resume(at); },
          [this](const auto&... notice) { notices_.to_holder(notice...); }};
}

contract::Route Agent::CommandComponent::followed_route(Time at) const {
  const nav::RouteStep* step = navigation_.followed_route(at);
  if (!step || !frames_.initialised()) return {};
  contract::Route route{
      .goal_id = behaviour_.view().goal_id, .corners = step->corners, .unknown = step->unknown_ahead};
  for (const Eigen::Vector3d& point : step->ahead) route.points.push_back(frames_.to_map(point));
  return route;
}

void Agent::CommandComponent::give_way(Time at) {
  RightOfWay::Own own{};
  own.mode = behaviour_.mode().name;
  own.stopped = commands_.stops().any();
  if (frames_.initialised()) own.pose = frames_.T_map_base();
  if (context_.peers.robots_present() > 0) {
    own.drives = behaviour_.drives();
    own.members = convoy_.others();
    own.convoy = convoy_.in();
    if (const nav::RouteStep* step = own.drives ? navigation_.followed_route(at) : nullptr)
      for (const Eigen::Vector3d& point : nav::first_part(step->ahead, kRouteAhead))
        own.route.push_back(frames_.to_map(point).head<2>());
    const Progress clearing = behaviour_.clearing();
    own.blocked = clearing.blocked;
    own.arrived = clearing.arrived;
  }
  right_of_way_.tick(own, at);
}

std::vector<TeamRobot> Agent::CommandComponent::team(Time at) const {
  std::vector<TeamRobot> robots;
  if (!frames_.initialised() || context_.peers.robots_present() == 0) return robots;
  const Pose2 T_odom_map = frames_.T_map_odom().inverse();
  const std::vector<std::string> members = convoy_.others();
  for (const Peer& peer : context_.peers.all()) {
    if (!peer.present || !peer.heard_beacon) continue;
    const TeamBeacon& beacon = peer.heard_beacon->beacon;
    const double age = seconds(at - peer.heard_beacon->at);
    const bool stands = std::hypot(beacon.twist.vx, beacon.twist.vy) < RightOfWay::kStands;
    if (age > (stands ? seconds(RightOfWay::kHeard) : kBeaconAge)) continue;
    const Pose2 pose = beacon.pose * Pose2{beacon.twist.vx * age, beacon.twist.vy * age, 0.0};
    const bool member = std::find(members.begin(), members.end(), peer.name) != members.end();
    robots.push_back({peer.name, T_odom_map * pose,
                      frames_.to_odom(Eigen::Vector3d(pose.x, pose.y, beacon.z)).z(), peer.length, peer.width,
                      member ? 0.0 : right_of_way_.cost_of(peer)});
  }
  return robots;
}

Behaviour::Outputs Agent::CommandComponent::behaviour_outputs() {
  return {[this](const auto&... notice) { notices_.to_holder(notice...); },
          [this] { telemetry_.send_behaviour(now()); }};
}

Navigation::Outputs Agent::CommandComponent::navigation_outputs() {
  return {[this](const Twist2& velocity) {
            if (generation()->valid()) context_.driver->write(velocity);
          },
          [this](const Progress& progress) { behaviour_.set_progress(progress); },
          [this](Warning warning) {
            notices_.warning(warning,
                             params_.platform.manual_collision_stop || behaviour_.mode().name != "manual");
          }};
}

void Agent::CommandComponent::watch_grip(const OdometryReport& report, Time at) {
  if (std::exchange(modes_seen_, behaviour_.modes_begun()) != behaviour_.modes_begun()) grip_.begin_mode();
  const auto event = grip_.note(report.wheels_slip, report.T_local_base.position, at);
  if (event == GripWatch::Event::slips) notices_.wheels_slip(params_.platform.flies());
  if (event != GripWatch::Event::stuck || !behaviour_.mode().autonomous()) return;
  behaviour_.hold(Reason::stuck, at);
  notices_.stuck();
}

void Agent::CommandComponent::add_to_map(const std::shared_ptr<const Scan>& scan) {
  const Localisation health = localiser_.health(now());
  // A map made by a pose that is lost would be wrong for ever.
  if (!context_.map || health == Localisation::lost || health == Localisation::starting) return;
  auto job = context_.map->job(scan, team(now()), frames_.odom_epoch(), now());
  if (!job) return;
  call(context_.map_insertion, std::move(job), {.deadline = 2s},
       [this](const Result<MapStep>& step) { context_.map->taken(step, frames_.map_frame()); });
}

void Agent::CommandComponent::seek_stairs(const std::shared_ptr<const Scan>& scan) {
  const Localisation health = localiser_.health(now());
  if (!context_.stairs || scan->planar || health == Localisation::lost || health == Localisation::starting)
    return;
  auto job = std::make_shared<StairsJob>(StairsJob{scan, team(now()), frames_.odom_epoch(), now()});
  call(context_.stairs_search, std::shared_ptr<const StairsJob>(std::move(job)), {.deadline = 2s},
       [this](const Result<StairsStep>& step) {
         if (!step || step->odom_epoch != frames_.odom_epoch()) return;
         const Pose3 T_map_odom = frames_.map_frame().T_map_odom;
         for (const std::uint64_t id : step->withdrawn) context_.stairs->withdraw(id);
         for (StairsTracker::Tracked tracked : step->stairs) {
           tracked.stairs = moved(T_map_odom, tracked.stairs);
           if (const auto taken = context_.stairs->take(tracked, to_stamp(now())); !taken)
             context_.notifier->to_all(Severity::warning, "finding_refused", taken.reason(),
                                       "a staircase: " + taken.error().text);
         }
       });
}

std::vector<Staircase> Agent::CommandComponent::known_stairs() const {
  // Those of an earlier start have a place once the robot knows its own.
  if (!context_.stairs || !frames_.initialised() || !localiser_.recognised()) return {};
  const Pose3 T_odom_map = frames_.map_frame().T_map_odom.inverse();
  std::vector<Staircase> out = context_.stairs->all();
  for (Staircase& stairs : out) stairs = moved(T_odom_map, stairs);
  return out;
}

void Agent::CommandComponent::send_content() {
  if (context_.map && frames_.initialised()) {
    context_.map->follow(frames_.map_frame());
    if (context_.map->is_behind() && now() - looked_ahead_ >= kLookAhead) {
      looked_ahead_ = now();
      contract::Route route = followed_route(now());
      if (route.points.empty()) route.points.push_back(frames_.to_map(frames_.T_odom_base().position));
      context_.map->look_ahead(route.points);
    }
  }
  if (context_.content->needs_carriers(now()) && context_.peers.carrier_present())
    context_.radio->reach_carriers();
  send_pieces();
}

void Agent::CommandComponent::send_pieces() {
  protect([&] {
    const wire::SenderState link = context_.wire->sender();
    for (const transfer::Piece& piece : context_.content->due(now(), link))
      context_.radio->send(piece, context_.content->session());
    if (!context_.carrier) return;
    if (const auto receipts = context_.carrier->due(now(), link.link != nullptr ? link.link->bandwidth : 0.0))
      context_.radio->send(context_.carrier->id(), *receipts);
  });
}

std::string Agent::CommandComponent::at_console(const std::string& line) {
  if (line == "unlock") return commands_.unlock_at_console() ? "unlocked\n" : "there was no lock\n";
  if (line == "peers") return describe(context_.peers, now());
  if (line != "status")
    return refused_at_console("'" + line +
                              "' is no command of the console (status, unlock, peers, health, restart "
                              "COMPONENT, policy COMPONENT auto|manual)");
  const Authority& authority = commands_.authority();
  const contract::BehaviourState view = behaviour_.view();
  return params_.name + ": " +
         (authority.holder() ? "held by " + authority.holder_name() : "held by nobody") +
         (authority.locked() ? ", locked" : "") + (commands_.stops().any() ? ", stopped" : "") + ", mode " +
         view.mode + (view.reason == Reason::none ? "" : " (" + std::string(adit::name(view.reason)) + ")") +
         "\n";
}

}  // namespace adit::agent
