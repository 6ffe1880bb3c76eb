// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/time/time.hpp"
#include "sim/world/body.hpp"
#include "sim/world/camera.hpp"
#include "sim/world/flight_space.hpp"
#include "sim/world/lidar.hpp"
#include "sim/world/odometry.hpp"
#include "sim/world/person.hpp"
#include "sim/world/realism.hpp"
#include "sim/world/standing_map.hpp"
#include "sim/world/traction.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

struct SimulationParams {
  Duration step{10ms};   ///< Step of the true motion, (0, 100 ms].
  double watchdog{0.5};  ///< A driver without a command for longer stops, s, (0, 10].
  LidarParams lidar{};   ///< Rings come from each platform, unless it is planar.
  OdometryParams odometry{};
  std::uint64_t seed{1};
  std::vector<PersonSpec> people{};  ///< At most 100.
  /// Bodies tilt with ground, suspension and gait; lidars sweep, see sweep(); there are inertial sensors.
  bool realistic{false};
  /// Scale of the errors of tracks, swept lidars, inertial sensors, mounts and clocks, [0, 10]; 0: the truth.
  /// `odometry` and the noise of `lidar` are scaled by the caller.
  double noise{1.0};
  ImuParams imu{};                   ///< Realistic.
  double dust{0.0};                  ///< Realistic: LidarErrors::dust, [0, 0.5].
  std::optional<double> dropouts{};  ///< Realistic: LidarErrors::dropouts, unless its default, [0, 1].
};

/// A robot to be put into the world.
struct RobotStart {
  std::string id{};
  Platform platform{};
  Pose2 pose{};  ///< World frame.
};

/// A contact; it lasts until the robot has moved 0.05 m or 0.1 rad away from where it was held, or the person
/// who walked into it 0.05 m.
///
/// The body that approaches the other by its own motion, at more than 0.05 m/s where they touch, caused it:
/// both of them, perhaps; when neither is that fast, the faster one. What stands still causes nothing.
struct Collision {
  Duration at{};
  std::string robot{};    ///< The one that moved, or that a person walked into.
  std::string partner{};  ///< Another robot's id, "world", or "a person".
  Pose2 pose{};           ///< Pose of `robot` where it was held, world.
  bool caused{};          ///< Caused by `robot`.
  bool by_partner{};      ///< Caused by `partner`.
};

/// What is true of a robot, whatever it believes.
struct Truth {
  Pose3 pose{};               ///< base_link, on the ground or where it flies, world
  Twist2 twist{};             ///< Body frame.
  double distance{0.0};       ///< Distance driven, m.
  Duration moving{};          ///< Time with more than 0.05 m/s or 0.1 rad/s.
  std::size_t collisions{0};  ///< Contacts it was part of.
  std::size_t caused{0};      ///< Contacts that it caused, see Collision.
  double min_clearance{0.0};  ///< Smallest distance to the world or a robot, m; infinite: none there.
};

/// The true world: bodies that drive, touch and see. Moves only when step() is called; the same seed and the
/// same commands give the same run. Not for several threads, except where stated.
class Simulation {
 public:
  /// Reason::bad_argument when two robots share an id or overlap, or one starts in a wall or without ground;
  /// the text names them; or when a person has no path.
  static Result<Simulation> create(std::shared_ptr<const World> world, std::vector<RobotStart> robots,
                                   const SimulationParams& params);

  /// One step of the true motion; robots move in the order they were given.
  void step();
  /// Time since the start.
  Duration now() const { return now_; }

  std::size_t size() const { return robots_.size(); }
  const std::vector<Person>& people() const { return people_; }
  const std::string& id(std::size_t robot) const { return robots_[robot].id; }
  std::optional<std::size_t> find(const std::string& id) const;
  const Platform& platform(std::size_t robot) const { return robots_[robot].body.platform(); }
  const World& world() const { return *world_; }
  const std::shared_ptr<const World>& shared_world() const { return world_; }
  const SimulationParams& params() const { return params_; }

  /// What a driver does with a cmd_vel.
  void command(std::size_t robot, const Twist2& wanted) { robots_[robot].body.command(wanted); }
  /// Faults between a robot's drive and the ground, which may begin and end between two steps.
  Traction& traction(std::size_t robot) { return robots_[robot].traction; }
  /// A solid box, as a door that shuts: it stands from the first step on in which neither a person nor a
  /// robot is in it, and no robot must brake hard for it. Height counts; for people it is a wall. Returns its
  /// number.
  std::size_t close(const Box& box);
  /// The box is gone.
  void open(std::size_t number) { shutters_.at(number) = {}; }
  /// Whether it stands.
  bool closed(std::size_t number) const { return shutters_.at(number).stands; }
  /// Its odometry begins again at `origin` of its frame, as after a restart of its driver.
  void reset_odometry(std::size_t robot, const Pose2& origin = {}) { robots_[robot].odometry.reset(origin); }
  const Truth& truth(std::size_t robot) const { return robots_[robot].truth; }
  /// Pose in `odom` (which begins at the start pose) and measured velocity.
  const Odometry& odometry(std::size_t robot) const { return robots_[robot].odometry; }
  /// Height above where it started as odometry has it, m; of what flies as it measures it.
  double altitude(std::size_t robot) const;
  /// Of the ground where it started, world frame, m: odometry's height counts from it.
  double start_ground(std::size_t robot) const { return robots_[robot].start_ground; }
  /// In the order they began; the first 1000 of them.
  const std::vector<Collision>& collisions() const { return collisions_; }

  /// All that one turn of a lidar depends on, by value: compute() may run on another thread, later.
  struct ScanJob {
    std::shared_ptr<const World> world{};
    std::shared_ptr<const LidarPattern> lidar{};
    std::vector<BodyBox> others{};
    Pose3 base{};
    Eigen::Vector3d mounted{0, 0, 0};  ///< The lidar in base_link, m.
    std::uint64_t seed{};
    /// Points in base_link, see LidarPattern::scan.
    PointCloud compute() const;
  };
  /// The lidar of a robot as the world is now.
  ScanJob scan(std::size_t robot) const;
  /// A picture of a robot's camera as the world is now. `camera`: index of Platform::cameras.
  PictureJob picture(std::size_t robot, std::size_t camera) const;

  /// Realistic: the sweep of a robot's lidar that ends now, in the lidar's own frame. `lidar`: index of
  /// Platform::all_lidars().
  SweepJob sweep(std::size_t robot, std::size_t lidar = 0) const;
  /// Realistic: how long a sweep lasts.
  Duration sweep_duration() const;
  /// Realistic: what the inertial sensor measured since the last call.
  std::vector<ImuSample> take_imu(std::size_t robot);
  const ImuParams& imu_params(std::size_t robot) const { return robots_[robot].real->imu.params(); }
  /// Seed for the timing of a robot's sensors.
  std::uint64_t sensor_seed(std::size_t robot) const;

 private:
  struct Robot {
    std::string id;
    Body body;
    Odometry odometry;
    std::shared_ptr<const StandingMap> ground;
    std::shared_ptr<const LidarPattern> lidar;
    Truth truth{};
    std::optional<std::size_t> partner{};  ///< Partner of the present contact, see contact().
    Pose2 contact{};                       ///< Place where it began.
    Traction traction{};
    double start_ground{};  ///< World frame, m.
    std::optional<Realism> real{};
  };
  Simulation(std::shared_ptr<const World> world, const SimulationParams& params);

  /// A box that stands in the world, or waits until it can.
  struct Shutter {
    Box box{};
    bool wanted{}, stands{};
    Rectangle outline() const {
      return {{(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, 0}, box[1] - box[0], box[3] - box[2]};
    }
  };
  static Rectangle footprint(const Platform& platform, const Pose2& pose);
  Result<void> add(const RobotStart& start);
  std::shared_ptr<const LidarPattern> lidar_of(const Platform& platform, const LidarConfig& lidar) const;
  void move(std::size_t robot);
  void drive(std::size_t robot);
  void equip(const RobotStart& start);
  void settle(Robot& robot, const Twist2& before, bool moved);
  void sense();
  std::size_t sweep_steps() const;
  void walk(std::size_t person);
  std::string partner_name(std::size_t partner) const;
  /// What the footprint would touch: a robot's index, size() for the world, from size() + 1 on a person, or
  /// nothing.
  std::optional<std::size_t> contact(std::size_t robot, const Rectangle& footprint) const;
  /// Whether two robots' bodies share a height; a flying one passes over another.
  bool level(std::size_t a, std::size_t b) const;
  bool level(std::size_t robot, const Person& person) const;
  bool level(const Robot& robot, const Shutter& shutter) const;
  bool is_clear(const Shutter& shutter) const;
  bool touches_world(const Robot& robot, const Rectangle& footprint) const;
  /// The boxes that stand, as lidars see them.
  std::vector<BodyBox> shutter_bodies() const;
  /// The other robots, and the people, as the lidar of a robot sees them now.
  std::vector<BodyBox> other_robots(std::size_t robot) const;
  std::vector<BodyBox> people_bodies(std::size_t robot) const;
  /// Heights that a flying body takes up, m, world: leaning it takes up more.
  static std::pair<double, double> extent(const Robot& robot);
  void lift(Robot& robot);
  /// Pose after a step from `before` as wheels or legs count it; that of the body is `after`.
  Pose2 counted(const Robot& robot, const Pose2& before, const Pose2& after) const;
  void record(std::size_t robot, std::size_t partner);
  /// How fast a robot and a person come nearer to `body` by their own motion, m/s.
  double approach(std::size_t robot, const Rectangle& body) const;
  double approach(const Person& person, const Rectangle& body) const;
  void measure(std::size_t robot);

  std::shared_ptr<const World> world_;
  FlightSpace space_;
  SimulationParams params_;
  Duration now_{};
  std::uint64_t steps_{0};
  std::vector<Robot> robots_{};
  std::vector<Collision> collisions_{};
  std::vector<Person> people_{};
  std::vector<Shutter> shutters_{};
  std::vector<std::deque<Pose2>> walked_{};             ///< Realistic, by person: as Realism::history.
  std::vector<std::optional<std::size_t>> touching_{};  ///< By person: the robot walked into.
};

}  // namespace adit::sim
