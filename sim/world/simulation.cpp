// SPDX-License-Identifier: Apache-2.0
#include "sim/world/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

constexpr double kStands = 0.05;  // m/s: who comes nearer no faster than that stands

}  // namespace

Simulation::Simulation(std::shared_ptr<const World> world, const SimulationParams& params)
    : world_(std::move(world)), space_(world_), params_(params) {}

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
  simulation.touching_.resize(simulation.people_.size());
  if (params.realistic)
    for (const Person& person : simulation.people_)
      simulation.walked_.emplace_back(simulation.sweep_steps() + 1, person.body().pose);
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
  for (const Robot& robot : robots_)
    if (robot.body.platform().height == platform.height && robot.body.platform().step == platform.step &&
        robot.body.platform().flies() == platform.flies())
      ground = robot.ground;
  if (!ground) {
    // Whatever rises or falls below it does not stop what flies.
    constexpr double any_step = 1e6;
    ground = std::make_shared<const StandingMap>(*world_, platform.height,
                                                 platform.flies() ? any_step : platform.step);
  }
  const Rectangle body = footprint(platform, start.pose);
  const double floor = ground->ground(start.pose.x, start.pose.y);
  const double z = floor + (platform.flies() ? platform.hover_height : 0.0);
  if (std::isnan(floor) ||
      (platform.flies() ? space_.touches(body, z, z + platform.height) : ground->touches(body)))
    return {Reason::bad_argument, where() + " is in a wall or has no ground; choose a free place"};
  for (const Robot& robot : robots_)
    if (overlap(body, footprint(robot.body.platform(), robot.body.pose())))
      return {Reason::bad_argument, where() + " overlaps " + robot.id};
  const std::uint64_t seed = derive_seed(params_.seed, 2 * robots_.size() + 1);
  OdometryParams odometry = params_.odometry;
  odometry.turn = std::max(odometry.turn, params_.noise * platform.turn_error);
  robots_.push_back({start.id, Body(platform, start.pose, params_.watchdog), Odometry(odometry, seed),
                     std::move(ground), lidar_of(platform, platform.lidar())});
  Robot& robot = robots_.back();
  robot.truth.pose = Pose3::level(start.pose, z);
  robot.start_ground = floor;
  equip(start);
  return {};
}

std::optional<std::size_t> Simulation::find(const std::string& id) const {
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (robots_[n].id == id) return n;
  return std::nullopt;
}

double Simulation::altitude(std::size_t robot) const {
  const Robot& r = robots_[robot];
  return r.body.platform().flies() ? r.truth.pose.position.z() - r.start_ground + r.odometry.altimeter_error()
                                   : r.odometry.height();
}

bool Simulation::level(std::size_t a, std::size_t b) const {
  const Platform &pa = robots_[a].body.platform(), &pb = robots_[b].body.platform();
  if (!pa.flies() && !pb.flies()) return true;
  const double za = robots_[a].truth.pose.position.z(), zb = robots_[b].truth.pose.position.z();
  return za < zb + pb.height && zb < za + pa.height;
}

bool Simulation::level(std::size_t robot, const Person& person) const {
  const Robot& r = robots_[robot];
  if (!r.body.platform().flies()) return true;
  const Pose2 at = person.body().pose;
  const double floor = r.ground->ground(at.x, at.y);
  return std::isnan(floor) || r.truth.pose.position.z() < floor + Person::kHeight;
}

std::pair<double, double> Simulation::extent(const Robot& robot) {
  const Platform& platform = robot.body.platform();
  const double z = robot.truth.pose.position.z();
  const Eigen::Quaterniond& q = robot.truth.pose.orientation;
  const double ahead = 2.0 * (q.x() * q.z() - q.w() * q.y()), left = 2.0 * (q.y() * q.z() + q.w() * q.x());
  const double lean = 0.5 * (platform.length * std::abs(ahead) + platform.width * std::abs(left));
  return {z - lean, z + platform.height + lean};
}

std::size_t Simulation::close(const Box& box) {
  shutters_.push_back({box, true, false});
  return shutters_.size() - 1;
}

// What is no higher than a step stops no robot that drives.
bool Simulation::level(const Robot& robot, const Shutter& shutter) const {
  const Platform& platform = robot.body.platform();
  const double z = robot.truth.pose.position.z();
  const auto [low, high] =
      platform.flies() ? extent(robot) : std::pair(z + platform.step, z + platform.height);
  return shutter.box[4] < high && shutter.box[5] > low;
}

bool Simulation::is_clear(const Shutter& shutter) const {
  constexpr double kNotices = 0.5, kStep = 0.1;  // s
  const Rectangle outline = shutter.outline();
  for (const Person& person : people_)
    if (overlap(person.body(), outline)) return false;
  return std::none_of(robots_.begin(), robots_.end(), [&](const Robot& robot) {
    if (!level(robot, shutter)) return false;
    const Platform& platform = robot.body.platform();
    const Twist2& twist = robot.body.twist();
    const double stops = kNotices + std::hypot(twist.vx, twist.vy) / platform.max_acceleration;
    for (double ahead = 0; ahead < stops; ahead += kStep)
      if (overlap(footprint(platform, robot.body.pose() * arc(twist, ahead)), outline)) return true;
    return false;
  });
}

std::vector<BodyBox> Simulation::shutter_bodies() const {
  std::vector<BodyBox> bodies;
  for (const Shutter& shutter : shutters_) {
    if (!shutter.stands) continue;
    const Rectangle outline = shutter.outline();
    bodies.push_back(
        {outline.pose, shutter.box[4], outline.length, outline.width, shutter.box[5] - shutter.box[4]});
  }
  return bodies;
}

bool Simulation::touches_world(const Robot& robot, const Rectangle& body) const {
  for (const Shutter& shutter : shutters_)
    if (shutter.stands && level(robot, shutter) && overlap(body, shutter.outline())) return true;
  if (!robot.body.platform().flies()) return robot.ground->touches(body);
  const auto [low, high] = extent(robot);
  return space_.touches(body, low, high);
}

void Simulation::lift(Robot& robot) {
  const Pose2 at = robot.body.pose();
  Eigen::Vector3d& position = robot.truth.pose.position;
  const Rectangle body = footprint(robot.body.platform(), at);
  const double ground = robot.ground->ground(at.x, at.y);
  if (std::isnan(ground)) return;
  position.z() =
      robot.body.climb(position.z(), ground, space_.ceiling(body, position.z()), seconds(params_.step));
}

std::optional<std::size_t> Simulation::contact(std::size_t robot, const Rectangle& body) const {
  if (touches_world(robots_[robot], body)) return robots_.size();
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (n != robot && level(robot, n) &&
        overlap(body, footprint(robots_[n].body.platform(), robots_[n].body.pose())))
      return n;
  for (std::size_t n = 0; n < people_.size(); ++n)
    if (level(robot, people_[n]) && overlap(body, people_[n].body())) return robots_.size() + 1 + n;
  return std::nullopt;
}

double Simulation::approach(std::size_t robot, const Rectangle& body) const {
  const Body& own = robots_[robot].body;
  const double dt = seconds(params_.step);
  const Twist2& twist = own.twist();
  const Pose2 next = own.pose() * Pose2{twist.vx * dt, twist.vy * dt, twist.wz * dt};
  return (separation(footprint(own.platform(), own.pose()), body) -
          separation(footprint(own.platform(), next), body)) /
         dt;
}

double Simulation::approach(const Person& person, const Rectangle& body) const {
  // Of one who would walk on what his step would do, though he is held.
  const double dt = seconds(params_.step);
  const double walked = separation(person.before(), body) - separation(person.body(), body);
  const double would = separation(person.body(), body) - separation(person.next(dt), body);
  return (person.yields() ? walked : std::max(walked, would)) / dt;
}

void Simulation::record(std::size_t index, std::size_t partner) {
  constexpr std::size_t limit = 1000;
  Robot& robot = robots_[index];
  const Rectangle body = footprint(robot.body.platform(), robot.body.pose());
  double own = std::numeric_limits<double>::infinity(), other = 0.0;  // a wall does nothing
  if (partner < robots_.size()) {
    own = approach(index, footprint(robots_[partner].body.platform(), robots_[partner].body.pose()));
    other = approach(partner, body);
  } else if (partner > robots_.size()) {
    const Person& person = people_[partner - robots_.size() - 1];
    own = approach(index, person.body());
    other = approach(person, body);
  }
  const bool caused = own > kStands || own >= other, by_partner = other > kStands || other > own;
  robot.truth.collisions++;
  robot.truth.caused += caused;
  robot.truth.min_clearance = 0.0;
  // It is one contact for both, and for as long as it lasts.
  robot.partner = partner;
  robot.contact = robot.body.pose();
  if (partner > robots_.size()) touching_[partner - robots_.size() - 1] = index;
  if (partner < robots_.size()) {
    robots_[partner].partner = index;
    robots_[partner].contact = robots_[partner].body.pose();
    Truth& truth = robots_[partner].truth;
    truth.collisions++;
    truth.caused += by_partner;
    truth.min_clearance = 0.0;
  }
  if (collisions_.size() < limit)
    collisions_.push_back({now_, robot.id, partner_name(partner), robot.body.pose(), caused, by_partner});
}

std::string Simulation::partner_name(std::size_t partner) const {
  if (partner < robots_.size()) return robots_[partner].id;
  return partner == robots_.size() ? "world" : "a person";
}

void Simulation::walk(std::size_t index) {
  constexpr double apart = 0.05;  // m: the contact is over
  const double dt = seconds(params_.step);
  Person& person = people_[index];
  std::optional<std::size_t>& touching = touching_[index];
  if (touching) {
    const Body& body = robots_[*touching].body;
    if (distance(person.body(), footprint(body.platform(), body.pose())) > apart) touching.reset();
  }
  const Rectangle next = person.next(dt);
  for (const Shutter& shutter : shutters_)
    if (shutter.stands && overlap(next, shutter.outline())) return person.wait();
  for (std::size_t n = 0; n < robots_.size(); ++n) {
    if (!level(n, person)) continue;
    const Rectangle body = footprint(robots_[n].body.platform(), robots_[n].body.pose());
    const double then = distance(next, body);
    if (person.yields() && then < Person::kRespect && then <= distance(person.body(), body))
      return person.wait();
    if (!person.yields() && overlap(next, body)) {
      const std::size_t self = robots_.size() + 1 + index;
      if (touching != n && robots_[n].partner != self) record(n, self);
      return person.lean(dt);
    }
  }
  person.take(dt);
}

void Simulation::move(std::size_t index) {
  Robot& robot = robots_[index];
  const Twist2 twist = robot.truth.twist;
  const Pose2 before = robot.body.pose();
  drive(index);
  if (robot.real) settle(robot, twist, robot.body.pose() != before);
}

Pose2 Simulation::counted(const Robot& robot, const Pose2& before, const Pose2& after) const {
  const double dt = seconds(params_.step);
  if (const auto spin = robot.traction.spin()) return before * arc(*spin, dt);
  return robot.traction.turn_share() < 1.0 ? before * arc(robot.body.wheels(), dt) : after;
}

void Simulation::drive(std::size_t index) {
  Robot& robot = robots_[index];
  const double dt = seconds(params_.step);
  if (robot.body.platform().flies()) lift(robot);
  const Pose2 before = robot.body.pose();
  robot.body.set_turn_share(robot.traction.turn_share());
  Pose2 after = robot.body.advance(dt);
  if (robot.traction.holds()) {
    robot.body.halt();
    after = before;
  }
  if (after == before) {
    robot.odometry.move(before, counted(robot, before, before), dt);
    robot.truth.twist = robot.body.twist();
    return;
  }
  const std::optional<std::size_t> partner = contact(index, footprint(robot.body.platform(), after));
  if (partner) {
    if (robot.partner != partner) record(index, *partner);
    robot.body.halt();
  } else {
    robot.body.take(after);
    const Pose2 away = robot.contact.inverse() * after;
    if (std::hypot(away.x, away.y) > 0.05 || std::abs(away.yaw) > 0.1) robot.partner.reset();
  }
  const Pose2 now = robot.body.pose();
  robot.odometry.move(before, partner ? now : counted(robot, before, now), dt);
  Truth& truth = robot.truth;
  truth.twist = robot.body.twist();
  truth.distance += (now.position() - before.position()).norm();
  if (std::hypot(truth.twist.vx, truth.twist.vy) > 0.05 || std::abs(truth.twist.wz) > 0.1)
    truth.moving += params_.step;
  if (robot.real) return;
  const double ground = robot.ground->ground(now.x, now.y), height = truth.pose.position.z();
  const bool stays = robot.body.platform().flies() || std::isnan(ground);
  if (!stays) robot.odometry.rise(ground - height);
  truth.pose = Pose3::level(now, stays ? height : ground);
}

void Simulation::measure(std::size_t index) {
  Robot& robot = robots_[index];
  const Rectangle body = footprint(robot.body.platform(), robot.body.pose());
  constexpr double far = 2.0;  // m: what is farther from a flying body is not looked for
  const Platform& platform = robot.body.platform();
  const double least = robot.truth.min_clearance;
  const auto [low, high] = extent(robot);
  double clearance = platform.flies() ? space_.clearance(body, low, high, std::min(least, far))
                                      : robot.ground->clearance(body);
  clearance = platform.flies() && clearance >= far ? least : std::min(least, clearance);
  for (std::size_t n = 0; n < robots_.size(); ++n)
    if (n != index && level(index, n))
      clearance =
          std::min(clearance, distance(body, footprint(robots_[n].body.platform(), robots_[n].body.pose())));
  for (const Person& person : people_)
    if (level(index, person)) clearance = std::min(clearance, distance(body, person.body()));
  for (const Shutter& shutter : shutters_)
    if (shutter.stands && level(robot, shutter))
      clearance = std::min(clearance, distance(body, shutter.outline()));
  robot.truth.min_clearance = clearance;
}

// Robots with the same share its pattern.
std::shared_ptr<const LidarPattern> Simulation::lidar_of(const Platform& platform,
                                                         const LidarConfig& lidar) const {
  LidarParams params = params_.lidar;
  if (params.folded && platform.flies()) {
    // One level ring: ground, steps and holes do not stand in its way.
    params.elevations = {0.0};
    params.rings = 1;
    params.folded = false;
  } else if (params.folded) {
    params.step = platform.step;
    params.drop = std::max(params.drop, 1.5 * platform.step);
  } else {
    params.rings = lidar.rings;
    params.lowest = lidar.lowest;
    params.highest = lidar.highest;
    params.rosette = lidar.rosette;
  }
  for (const Robot& robot : robots_) {
    const LidarParams& other = robot.lidar->params();
    if (other.rings == params.rings && other.lowest == params.lowest && other.highest == params.highest &&
        other.elevations == params.elevations && other.folded == params.folded && other.step == params.step &&
        other.rosette == params.rosette)
      return robot.lidar;
  }
  return std::make_shared<const LidarPattern>(params);
}

void Simulation::step() {
  now_ += params_.step;
  ++steps_;
  for (Shutter& shutter : shutters_) shutter.stands = shutter.wanted && (shutter.stands || is_clear(shutter));
  for (std::size_t n = 0; n < people_.size(); ++n) walk(n);
  for (std::size_t n = 0; n < robots_.size(); ++n) move(n);
  for (std::size_t n = 0; n < robots_.size(); ++n) measure(n);
  sense();
}

PointCloud Simulation::ScanJob::compute() const {
  const Eigen::Vector3d aside(mounted.x(), mounted.y(), 0);
  PointCloud points = lidar->scan(*world, others, {base * aside, base.orientation}, mounted.z(), seed);
  for (Eigen::Vector3f& point : points) point += aside.cast<float>();
  return points;
}

std::vector<BodyBox> Simulation::other_robots(std::size_t index) const {
  std::vector<BodyBox> bodies;
  for (std::size_t n = 0; n < robots_.size(); ++n) {
    if (n == index) continue;
    const Platform& platform = robots_[n].body.platform();
    bodies.push_back({robots_[n].body.pose(), robots_[n].truth.pose.position.z(), platform.length,
                      platform.width, platform.height});
  }
  return bodies;
}

std::vector<BodyBox> Simulation::people_bodies(std::size_t index) const {
  std::vector<BodyBox> bodies;
  for (const Person& person : people_) {
    const Rectangle body = person.body();
    const double ground = robots_[index].ground->ground(body.pose.x, body.pose.y);
    bodies.push_back({body.pose, std::isnan(ground) ? robots_[index].truth.pose.position.z() : ground,
                      body.length, body.width, Person::kHeight});
  }
  return bodies;
}

Simulation::ScanJob Simulation::scan(std::size_t index) const {
  const Eigen::Vector3d mounted = robots_[index].body.platform().lidar_origin();
  ScanJob job{world_, robots_[index].lidar, shutter_bodies(), robots_[index].truth.pose, mounted, 0};
  for (const BodyBox& body : other_robots(index)) job.others.push_back(body);
  for (const BodyBox& body : people_bodies(index)) job.others.push_back(body);
  job.seed = derive_seed(params_.seed ^ (steps_ << 8), 2 * index + 2);
  return job;
}

}  // namespace adit::sim
