#include "robot_agent/agent_core.hpp"

#include <cmath>

#include "core/time/random.hpp"

namespace adit::agent {
namespace {

CommandParams command_params(const AgentParams& params) {
  CommandParams c{};
  c.robot = params.name;
  // Zero is what a message holds that nobody filled in: no epoch starts with it.
  c.epoch_start = Random(params.seed).next() | 1u;
  c.lock_lease = params.lock_lease;
  c.protocol = kProtocolVersion;
  c.defects = params.defects;
  return c;
}

MuxParams mux_params(const AgentParams& params) {
  MuxParams m{};
  m.defects = params.defects;
  return m;
}

BehaviourParams behaviour_params(const AgentParams& params) {
  BehaviourParams b{};
  b.defects = params.defects;
  return b;
}

NavigationParams navigation_params(const AgentParams& params) {
  NavigationParams n{};
  n.platform = params.platform;
  n.planning = params.planning;
  return n;
}

KeeperParams keeper_params(const AgentParams& params) {
  KeeperParams k{};
  if (params.defects.has(Defect::acknowledged_lost)) k.lazy = 5s;
  return k;
}

constexpr Duration kBeat = 50ms;  // tree, mux, follower and driver: 20 Hz
constexpr Duration kStatePeriod = 100ms;
constexpr Duration kStatusPeriod = 1s;
constexpr Duration kLinkPeriod = 2s;
constexpr Duration kHealthPeriod = 5s;

}  // namespace

Agent::Core::Core(const AgentParams& params, Executor& command, std::unique_ptr<Decider> decider,
                  std::unique_ptr<RadioEdge> radio, std::shared_ptr<Executor> disk_strand)
    : Component("command", command, Log(params.log, params.name)),
      params_(params),
      radio_(std::move(radio)),
      localisation_(params.start),
      navigation_(navigation_params(params), command, log(), localisation_, navigation_outputs()),
      mux_(navigation_, mux_params(params)),
      behaviour_(behaviour_params(params), std::move(decider), mux_, behaviour_inputs(), behaviour_outputs()),
      commands_(command_params(params), behaviour_, command_outputs()),
      directory_(command),
      restored_(restore_state(params.disk)),
      keeper_(keeper_params(params), params.disk, command, std::move(disk_strand), restored_.generation,
              keeper_outputs()) {
  if (!restored_.snapshot) return;
  const Snapshot& s = *restored_.snapshot;
  commands_.restore(s.authority, s.answers, command.now());
  // Where its driver's odometry began anew, the goal's place is no longer known for sure.
  const bool resume = params.resume_after_restart && s.boot == params.boot;
  behaviour_.restore(s.behaviour, commands_.stops().any(), resume);
}

Result<void> Agent::Core::open(wire::Wire& robot, Executor& sensors) {
  Driver::Handlers handlers{};
  handlers.odometry = [this](const Pose3& odom, const Twist2& twist, std::uint64_t stamp) {
    localisation_.update(odom, twist, stamp, now());
  };
  handlers.points = [this](std::shared_ptr<PointCloud> points, std::uint64_t stamp) {
    if (!running() || !localisation_.initialised()) return;
    auto scan = std::make_shared<Scan>();
    scan->points = std::move(*points);
    scan->body = localisation_.odom_at(stamp);
    navigation_.add_scan(std::move(scan), now());
  };
  handlers.battery = [this](float charge) { battery_ = std::isfinite(charge) ? charge : -1.0f; };
  auto driver = Driver::open(robot, executor(), sensors, std::move(handlers));
  if (!driver) return driver.error();
  driver_ = std::move(*driver);
  return radio_->listen({commands_, directory_, [this](Task task) {
                           keep();
                           keeper_.when_safe(std::move(task));
                         }});
}

void Agent::Core::close() {
  radio_->close();
  if (driver_) driver_->close();
}

Result<void> Agent::Core::on_start() {
  started_ = now();
  const auto failed = [this](const ComponentFailure& f) {
    tell({{}, Severity::error, "component_failed", Reason::internal, f.component + ": " + f.text});
  };
  on_failure(failed);
  navigation_.on_failure(failed);
  if (const auto started = navigation_.start(); !started) return started;
  driver_->write({});
  radio_->send_capabilities(params_.platform, params_.id, kProtocolVersion);
  behaviour_.tick(now());
  tell_restored();
  keep();
  send_status();
  send_health();
  timers_.push_back(every(kBeat, [this] { beat(); }));
  timers_.push_back(every(kStatePeriod, [this] {
    send_state();
    directory_.tick(now());
  }));
  timers_.push_back(every(kStatusPeriod, [this] {
    commands_.tick(now());
    send_status();
  }));
  timers_.push_back(every(kLinkPeriod, [this] { radio_->send_link_report(now(), driver_->malformed()); }));
  timers_.push_back(every(kHealthPeriod, [this] { send_health(); }));
  return {};
}

void Agent::Core::on_stop() {
  timers_.clear();
  navigation_.stop();
}

void Agent::Core::beat() {
  const Time at = now();
  watch_driver();
  behaviour_.tick(at);
  mux_.step(at);
  navigation_.step(at);
  keep();
  keeper_.tick();
}

void Agent::Core::keep() {
  keeper_.save({commands_.kept(), behaviour_.kept(), params_.boot, 0, {}},
               [this] { return commands_.kept_answers(); });
}

void Agent::Core::tell_restored() {
  if (restored_.lost)
    tell({{},
          Severity::error,
          "state_lost",
          Reason::cannot_read,
          params_.name + " started and holds: its state was lost (" + restored_.text + ")"});
  else if (restored_.snapshot)
    tell({{},
          Severity::warning,
          "restarted",
          Reason::none,
          params_.name + " was restarted: " + describe(*restored_.snapshot) +
              (restored_.snapshot->boot == params_.boot ? "" : "; with its computer, so it holds")});
}

void Agent::Core::watch_driver() {
  const bool alive = localisation_.alive(now());
  if (driver_was_alive_ && !alive)
    tell_holder({{},
                 Severity::error,
                 "driver_lost",
                 Reason::driver_silent,
                 "the driver of " + params_.name + " is silent"});
  if (driver_was_alive_ != alive) {
    driver_was_alive_ = alive;
    send_health();
  }
}

void Agent::Core::send_state() {
  const std::uint64_t stamp = to_stamp(now());
  commands_.sent_stamp(stamp);
  const bool known = localisation_.initialised();
  radio_->send_state(
      {localisation_.pose(), localisation_.z(), known ? localisation_.twist() : Twist2{}, battery_}, stamp);
}

void Agent::Core::send_status() {
  radio_->send_authority(commands_, now());
  send_behaviour();
}

void Agent::Core::send_behaviour() { radio_->send_behaviour(behaviour_.view(), behaviour_.options(now())); }

void Agent::Core::send_health() {
  std::vector<ComponentHealth> parts{health(), navigation_.health()};
  ComponentHealth driver{};
  driver.name = "driver";
  driver.running = driver.healthy = localisation_.alive(now());
  driver.beat_age = localisation_.silence(now(), started_);
  if (!driver.healthy) driver.last_failure = "no odometry";
  parts.push_back(driver);
  if (params_.disk) {
    ComponentHealth store{};
    store.name = "store";
    store.running = true;
    store.healthy = !keeper_.failing();
    if (!store.healthy) store.last_failure = "the disk does not keep the state";
    parts.push_back(store);
  }
  radio_->send_health(parts);
}

void Agent::Core::tell(Notice notice) {
  if (log().on(LogLevel::info))
    log().info("tells " + (notice.operator_name.empty() ? "everybody" : notice.operator_name) + " " +
               notice.code + ": " + notice.text);
  radio_->send(notice);
}

void Agent::Core::tell_holder(Notice notice) {
  notice.operator_name = commands_.authority().holder_name();
  if (!notice.operator_name.empty()) tell(std::move(notice));
}

Facts Agent::Core::sense(Time now) const {
  Facts f{};
  f.driver_alive = localisation_.alive(now);
  f.localised = localisation_.initialised();
  f.terrain_fresh = navigation_.terrain_fresh(now);
  return f;
}

CommandInterface::Outputs Agent::Core::command_outputs() {
  return {[this](const Notice& notice) { tell(notice); },
          [this] {
            keep();
            keeper_.when_safe([this] { radio_->send_authority(commands_, now()); });
          }};
}

Behaviour::Inputs Agent::Core::behaviour_inputs() {
  return {[this](Time at) { return sense(at); },
          [this](const Eigen::Vector2d& place) { return navigation_.goal_free(place); }};
}

Behaviour::Outputs Agent::Core::behaviour_outputs() {
  return {[this](const Notice& notice) { tell_holder(notice); }, [this] { send_behaviour(); }};
}

Navigation::Outputs Agent::Core::navigation_outputs() {
  return {[this](const Twist2& velocity) { driver_->write(velocity); },
          [this](const Progress& progress) { behaviour_.set_progress(progress); }};
}

StateKeeper::Outputs Agent::Core::keeper_outputs() {
  return {[this](bool failing, const std::string& text) {
    if (failing)
      tell({{},
            Severity::error,
            "store_failing",
            Reason::cannot_write,
            params_.name + " cannot keep its state over a restart: " + text});
    else
      tell({{}, Severity::info, "store_works", Reason::none, params_.name + ": " + text});
    send_health();
  }};
}

std::string Agent::Core::at_console(const std::string& line) {
  if (line == "unlock") return commands_.unlock_at_console() ? "unlocked\n" : "there was no lock\n";
  if (line != "status") return "unknown: " + line + " (status, unlock)\n";
  const Authority& authority = commands_.authority();
  const BehaviourView view = behaviour_.view();
  return params_.name + ": " +
         (authority.holder() ? "held by " + authority.holder_name() : "held by nobody") +
         (authority.locked() ? ", locked" : "") + (commands_.stops().any() ? ", stopped" : "") + ", mode " +
         std::string(view.mode) +
         (view.reason == Reason::none ? "" : " (" + std::string(adit::name(view.reason)) + ")") + "\n";
}

}  // namespace adit::agent
