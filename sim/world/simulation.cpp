#include "sim/world/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/world/noise.hpp"

namespace adit::sim {

Simulation::Simulation(std::shared_ptr<const World> world, const SimulationParams& params)
    : world_(std::move(world)), params_(params), lidar_(std::make_shared<const LidarPattern>(params.lidar)) {}

Result<Simulation> Simulation::create(std::shared_ptr<const World> world, std::vector<RobotStart> robots,
                                      const SimulationParams& params) {
  if (!world) return {Reason::bad_argument, "a simulation needs a world"};
  Simulation simulation(std::move(world), params);
  for (const RobotStart& start : robots)
    if (const Result<void> added = simulation.add(start); !added) return added.error();
  if (params.people.size() > 100) return {Reason::bad_argument, "people: at most 100"};
  for (const PersonSpec& person : params.people) {
    if (person.path.size() < 2 || person.path.size() > 100 || !(person.speed > 0.0 && person.speed <= 3.0))
      return {Reason::bad_argument, "people: expected a path of 2 to 100 places and a speed of 0 to 3 m/s"};
    simulation.people_.emplace_back(person);
  }
  for (std::size_t n = 0; n < simulation.size(); ++n) {
    simulation.robots_[n].truth.min_clearance = std::numeric_limits<double>::infinity();
    simulation.measure(n);
  }
  return simulation;
}

Rectangle Simulation::footprint(const Platform& platform, const Pose2& pose) {
  return {pose, platform.length, platform.width};
}

Result<void> Simulation::add(const RobotStart& start) {
  const Platform& platform = start.platform;
  const auto where = [&] {
    return fmt::format("{}: start at ({:.2f}, {:.2f})", start.id, start.pose.x, start.pose.y);
  };
  if (find(start.id)) return {Reason::bad_argument, start.id + ": two robots have this id"};
  if (!std::isfinite(start.pose.x) || !std::isfinite(start.pose.y) || !std::isfinite(start.pose.yaw) ||
      std::abs(start.pose.x) > 1e5 || std::abs(start.pose.y) > 1e5)
    return {Reason::bad_argument, start.id + ": the start pose is outside the world"};
  std::shared_ptr<const StandingMap> ground;
  std::shared_ptr<const World> seen = world_;
  for (const Robot& robot : robots_)
    if (robot.body.platform().height == platform.height && robot.body.platform().step == platform.step) {
      ground = robot.ground;
      seen = robot.seen;
    }
  if (!ground) {
    ground = std::make_shared<const StandingMap>(*world_, platform.height, platform.step);
    if (params_.lidar.profile) seen = std::make_shared<const World>(world_->name(), ground->profile());
  }
  const Rectangle body = footprint(platform, start.pose);
  if (ground->touches(body) || std::isnan(ground->ground(start.pose.x, start.pose.y)))
    return {Reason::bad_argument, where() + " is in a wall or has no ground; choose a free place"};
  for (const Robot& robot : robots_)
    if (overlap(body, footprint(robot.body.platform(), robot.body.pose())))
      return {Reason::bad_argument, where() + " overlaps " + robot.id};
  const std::uint64_t seed = derive_seed(params_.seed, 2 * robots_.size() + 1);
  OdometryParams odometry = params_.odometry;
  odometry.turn = std::max(odometry.turn, platform.turn_error);
  robots_.push_back({start.id, Body(platform, start.pose, params_.watchdog), Odometry(odometry, seed),
                     std::move(ground), std::move(seen)});
  Robot& robot = robots_.back();
  robot.truth.pose = Pose3::level(start.pose, robot.ground->ground(start.pose.x, start.pose.y));
  return {};
}

std::optional<std::size_t> Simulation::find(const std::string& id) const {
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (robots_[n].id == id) return n;
  return std::nullopt;
}

std::optional<std::size_t> Simulation::contact(std::size_t robot, const Rectangle& body) const {
  if (robots_[robot].ground->touches(body)) return robots_.size();
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (n != robot && overlap(body, footprint(robots_[n].body.platform(), robots_[n].body.pose()))) return n;
  for (const Person& person : people_)
    if (overlap(body, person.body())) return robots_.size() + 1;
  return std::nullopt;
}

void Simulation::record(std::size_t robot, std::size_t partner) {
  constexpr std::size_t limit = 1000;
  robots_[robot].contact = robots_[robot].body.pose();
  robots_[robot].truth.collisions++;
  if (partner < robots_.size()) {
    robots_[partner].truth.collisions++;
    robots_[partner].truth.min_clearance = 0.0;
  }
  robots_[robot].truth.min_clearance = 0.0;
  if (collisions_.size() < limit)
    collisions_.push_back({now_, robots_[robot].id, partner_name(partner), robots_[robot].body.pose()});
}

std::string Simulation::partner_name(std::size_t partner) const {
  if (partner < robots_.size()) return robots_[partner].id;
  return partner == robots_.size() ? "world" : "a person";
}

void Simulation::walk(Person& person) {
  const double dt = seconds(params_.step);
  const Rectangle next = person.next(dt);
  for (const Robot& robot : robots_) {
    const Rectangle body = footprint(robot.body.platform(), robot.body.pose());
    const double then = distance(next, body);
    if (then < Person::respect && then <= distance(person.body(), body)) return;
  }
  person.take(dt);
}

void Simulation::move(std::size_t index) {
  Robot& robot = robots_[index];
  const double dt = seconds(params_.step);
  const Pose2 before = robot.body.pose();
  Pose2 after = robot.body.advance(dt);
  if (robot.jams > 0) {
    robot.body.halt();
    after = before;
  }
  if (after == before) {
    robot.odometry.move(before, before, dt);
    robot.truth.twist = robot.body.twist();
    return;
  }
  const std::optional<std::size_t> partner = contact(index, footprint(robot.body.platform(), after));
  if (partner) {
    robot.body.halt();
    if (robot.partner != partner) record(index, *partner);
    robot.partner = partner;
  } else {
    robot.body.take(after);
    const Pose2 away = robot.contact.inverse() * after;
    if (std::hypot(away.x, away.y) > 0.05 || std::abs(away.yaw) > 0.1) robot.partner.reset();
  }
  const Pose2 now = robot.body.pose();
  robot.odometry.move(before, now, dt);
  Truth& truth = robot.truth;
  truth.twist = robot.body.twist();
  truth.distance += (now.position() - before.position()).norm();
  if (std::hypot(truth.twist.vx, truth.twist.vy) > 0.05 || std::abs(truth.twist.wz) > 0.1)
    truth.moving += params_.step;
  const double ground = robot.ground->ground(now.x, now.y);
  truth.pose = Pose3::level(now, std::isnan(ground) ? truth.pose.position.z() : ground);
}

void Simulation::measure(std::size_t index) {
  Robot& robot = robots_[index];
  const Rectangle body = footprint(robot.body.platform(), robot.body.pose());
  double clearance = std::min(robot.truth.min_clearance, robot.ground->clearance(body));
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (n != index)
      clearance =
          std::min(clearance, distance(body, footprint(robots_[n].body.platform(), robots_[n].body.pose())));
  for (const Person& person : people_) clearance = std::min(clearance, distance(body, person.body()));
  robot.truth.min_clearance = clearance;
}

void Simulation::step() {
  now_ += params_.step;
  ++steps_;
  for (Person& person : people_) walk(person);
  for (std::size_t n = 0; n < robots_.size(); ++n) move(n);
  for (std::size_t n = 0; n < robots_.size(); ++n) measure(n);
}

Simulation::ScanJob Simulation::scan(std::size_t index) const {
  const double height = robots_[index].body.platform().lidar_height;
  ScanJob job{robots_[index].seen, lidar_, {}, robots_[index].truth.pose, height, 0};
  for (std::size_t n = 0; n < robots_.size(); ++n) {
    if (n == index) continue;
    const Platform& platform = robots_[n].body.platform();
    BodyBox box{robots_[n].body.pose(), robots_[n].truth.pose.position.z(), platform.length, platform.width,
                platform.height};
    // In the ring's plane, however low it is.
    if (params_.lidar.profile) box = {box.pose, job.base.position.z(), box.length, box.width, 2.0 * height};
    job.others.push_back(box);
  }
  for (const Person& person : people_) {
    const Rectangle body = person.body();
    const double ground = robots_[index].ground->ground(body.pose.x, body.pose.y);
    BodyBox box{body.pose, std::isnan(ground) ? job.base.position.z() : ground, body.length, body.width,
                Person::height};
    if (params_.lidar.profile) box.ground = job.base.position.z();
    job.others.push_back(box);
  }
  job.seed = derive_seed(params_.seed ^ (steps_ << 8), 2 * index + 2);
  return job;
}

}  // namespace adit::sim
