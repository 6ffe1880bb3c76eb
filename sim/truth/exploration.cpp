// SPDX-License-Identifier: Apache-2.0
#include "sim/truth/exploration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/truth/lidar_turn.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::sim {
namespace {

constexpr double kPlaces = 0.8;   ///< Between the places from which cells can be seen, m.
constexpr double kWay = 0.2;      ///< Between the points of the search for these places, m.
constexpr double kMargin = 0.05;  ///< Distance that a body keeps from obstacles beside half its width, m.
constexpr double kBefore =
    1e-4;  ///< A ray ends so far before the surface that it meets, in the cell before it, m.
constexpr double kAside = 1e-3;  ///< Places lie so much beside the multiples of kPlaces, m.
constexpr std::uint16_t kMostPlaces = std::numeric_limits<std::uint16_t>::max();
constexpr int kColumns = 900;        ///< Of a lidar's turn.
constexpr int kSparseColumns = 300;  ///< 0.25 m apart at kRange: enough to meet every cell from some place.

LidarParams lidar_of(const Platform& platform, int columns) {
  const LidarConfig config = platform.lidar();
  LidarParams out;
  out.rings = config.rings;
  out.lowest = config.lowest;
  out.highest = config.highest;
  out.columns = columns;
  return out;
}

Pose3 sensor_of(const Platform& platform, const Pose3& base) {
  Pose3 out = base;
  out.position += base.orientation * platform.lidar_origin();
  return out;
}

/// The points, kWay apart, to which a body can drive from a start, in the order in which they were found.
/// Points are counted from the start's nearest multiples of kWay, so that places of several robots agree.
std::vector<Eigen::Vector2i> reachable(const World& world, const Platform& platform, const StandingMap& map,
                                       const Pose2& start) {
  const VoxelGrid& grid = world.grid();
  const Eigen::Vector2d low = grid.origin();
  const Eigen::Vector2d high = low + grid.resolution() * Eigen::Vector2d(grid.nx(), grid.ny());
  const Eigen::Vector2i first = (low / kWay).array().floor().cast<int>();
  const Eigen::Vector2i count = (high / kWay).array().ceil().cast<int>() - first.array() + 1;
  std::vector<std::uint8_t> known(static_cast<std::size_t>(count.x()) * count.y(), 0);
  std::vector<Eigen::Vector2i> out;
  const double clearance = platform.width / 2 + kMargin;
  const auto visit = [&](const Eigen::Vector2i& at, bool is_start) {
    const Eigen::Vector2i local = at - first;
    if (local.minCoeff() < 0 || local.x() >= count.x() || local.y() >= count.y()) return;
    std::uint8_t& cell = known[static_cast<std::size_t>(local.y()) * count.x() + local.x()];
    if (cell != 0) return;
    cell = 1;
    const Eigen::Vector2d p = kWay * at.cast<double>();
    if (is_start || (map.distance(p.x(), p.y()) >= clearance && std::isfinite(map.ground(p.x(), p.y()))))
      out.push_back(at);
  };
  visit((start.position() / kWay).array().round().cast<int>(), true);
  for (std::size_t n = 0; n < out.size(); ++n) {
    const Eigen::Vector2i at = out[n];
    for (const auto& step :
         {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)})
      visit(at + step, false);
  }
  return out;
}

}  // namespace

ExplorationTruth::ExplorationTruth(std::shared_ptr<const World> world,
                                   std::span<const ExplorationRobot> robots)
    : world_(std::move(world)),
      robots_(robots.begin(), robots.end()),
      cells_(*world_),
      possible_(cells_.size(), 0),
      seen_(cells_.size(), 0) {
  for (const ExplorationRobot& robot : robots_) lidars_.emplace_back(lidar_of(robot.platform, kColumns));
}

Result<ExplorationTruth> ExplorationTruth::create(std::shared_ptr<const World> world,
                                                  std::span<const ExplorationRobot> robots) {
  if (robots.empty() || robots.size() > kMostRobots)
    return Error{Reason::bad_argument, "expected 1 to 64 robots whose exploration is to be judged"};
  ExplorationTruth out(std::move(world), robots);
  out.find_possible();
  if (out.possible_count_ == 0)
    return Error{Reason::bad_argument, "the robots' lidars see nothing of this world"};
  return out;
}

template <class Mark, class End>
void ExplorationTruth::turn(const LidarPattern& lidar, const Pose3& sensor, const Mark& mark,
                            const End& end) const {
  for_each_beam(*world_, lidar, sensor, kRange, [&](const Eigen::Vector3d& direction, double range) {
    const double length = std::min(range, kRange) - kBefore;
    cells_.for_each_on(sensor.position, direction, length, mark);
    end(sensor.position + length * direction);
  });
}

void ExplorationTruth::find_possible() {
  constexpr int kEvery = 4;
  static_assert(kEvery * kWay == kPlaces);
  Eigen::AlignedBox3d seen;
  std::vector<std::uint32_t> counted(possible_.size(), 0);  // By cell: the last place that it counts.
  std::uint32_t place = 0;
  for (const ExplorationRobot& robot : robots_) {
    const double headroom = std::max(robot.platform.height, robot.platform.lidar_height);
    const StandingMap map(*world_, headroom, robot.platform.step);
    const LidarPattern lidar(lidar_of(robot.platform, kSparseColumns));
    for (const Eigen::Vector2i& at : reachable(*world_, robot.platform, map, robot.start)) {
      if (at.x() % kEvery != 0 || at.y() % kEvery != 0) continue;
      // A ray along the face of a wall would be neither in front of it nor behind.
      const Eigen::Vector2d p = kWay * at.cast<double>() + Eigen::Vector2d::Constant(kAside);
      const Pose3 base = Pose3::level({p.x(), p.y(), 0}, map.ground(p.x(), p.y()));
      ++place;
      const auto count = [&](std::size_t cell) {
        if (std::exchange(counted[cell], place) != place && possible_[cell] < kMostPlaces) ++possible_[cell];
      };
      turn(lidar, sensor_of(robot.platform, base), count,
           [&seen](const Eigen::Vector3d& point) { seen.extend(point); });
    }
  }
  for (std::size_t cell = 0; cell < possible_.size(); ++cell)
    if (!seen.contains(cells_.centre(cell))) possible_[cell] = 0;
  possible_count_ =
      possible_.size() - static_cast<std::size_t>(std::count(possible_.begin(), possible_.end(), 0));
}

void ExplorationTruth::look(std::size_t robot, const Pose3& base) {
  const std::uint64_t bit = std::uint64_t{1} << robot;
  const auto mark = [this, bit](std::size_t cell) {
    if (possible_[cell] == 0) return;
    if (seen_[cell] == 0) ++seen_count_;
    seen_[cell] |= bit;
  };
  turn(lidars_[robot], sensor_of(robots_[robot].platform, base), mark, [](const Eigen::Vector3d&) {});
}

double ExplorationTruth::share(const std::optional<ExplorationArea>& area,
                               std::span<const std::size_t> robots) const {
  std::uint64_t of = robots.empty() ? ~std::uint64_t{0} : 0;
  for (const std::size_t robot : robots) of |= std::uint64_t{1} << robot;
  std::size_t possible = 0, seen = 0;
  for (std::size_t cell = 0; cell < possible_.size(); ++cell) {
    if (possible_[cell] == 0) continue;
    if (area) {
      const Eigen::Vector3d at = cells_.centre(cell);
      if (at.x() < area->x0 || at.x() > area->x1 || at.y() < area->y0 || at.y() > area->y1) continue;
    }
    ++possible;
    if ((seen_[cell] & of) != 0) ++seen;
  }
  return possible == 0 ? 1.0 : static_cast<double>(seen) / static_cast<double>(possible);
}

std::vector<UnseenPatch> ExplorationTruth::unseen() const {
  std::vector<bool> listed(possible_.size(), false);
  std::vector<std::size_t> group;
  std::vector<UnseenPatch> out;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(ExplorationCells::kSize / 2);
  const auto add = [&](std::size_t cell) {
    if (possible_[cell] == 0 || seen_[cell] != 0 || listed[cell]) return;
    listed[cell] = true;
    group.push_back(cell);
  };
  for (std::size_t first = 0; first < possible_.size(); ++first) {
    group.clear();
    add(first);
    UnseenPatch patch;
    for (std::size_t n = 0; n < group.size(); ++n) {
      const Eigen::Vector3d centre = cells_.centre(group[n]);
      patch.box.extend(Eigen::AlignedBox3d(centre - half, centre + half));
      patch.places = std::max(patch.places, int{possible_[group[n]]});
      cells_.for_each_around(group[n], add);
    }
    patch.cells = group.size();
    if (patch.cells > 0) out.push_back(patch);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const UnseenPatch& a, const UnseenPatch& b) { return a.cells > b.cells; });
  return out;
}

double ExplorationTruth::overlap() const {
  if (seen_count_ == 0) return 0;
  const auto several =
      std::count_if(seen_.begin(), seen_.end(), [](std::uint64_t who) { return std::popcount(who) > 1; });
  return static_cast<double>(several) / static_cast<double>(seen_count_);
}

double ExplorationTruth::volume() const {
  return static_cast<double>(seen_count_) * std::pow(ExplorationCells::kSize, 3);
}

}  // namespace adit::sim
