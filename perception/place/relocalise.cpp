// SPDX-License-Identifier: Apache-2.0
#include "perception/place/relocalise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "perception/place/surfaces.hpp"

namespace adit::perception {
namespace {

using Points = std::vector<Eigen::Vector2f>;

constexpr std::size_t kMaxKeyframes = 16;  ///< Of the target; their reach overlaps, and each costs 2 ms.
constexpr float kCell = 0.125f;            ///< Of the plan, m.
constexpr int kStep = 2;                   ///< Between poses that are compared, cells: as in align(), 0.25 m.
constexpr double kTurnStep = 0.045;        ///< The same, rad.
constexpr float kNear = 0.4f;              ///< Distance from a wall that counts in a comparison, m.
constexpr float kLevel = 0.9f;             ///< Vertical part of the normal of a floor.
constexpr int kSquare = 4;                 ///< Poses along an edge of the squares that are bounded, steps.
constexpr std::size_t kSearchPoints = 200, kMinSearchPoints = 30;  ///< Of the scan, on upright planes.
constexpr std::size_t kCandidates = 10;                            ///< Poses that are laid onto the planes.
constexpr double kApart = 0.75, kApartTurn = 0.2;  ///< Candidates differ by at least so much, m, rad.
constexpr double kSame = 0.3, kSameTurn = 0.1;     ///< Results nearer to each other are one place, m, rad.
/// By so much the next best place fits less: as far as another hall's overlap, 0.5, is below kAlignOverlap.
constexpr double kClearly = 0.15;

/// The part of a cloud that is on upright planes, seen from above.
Points upright(const PointCloud& cloud, const VoxelPlanes& planes) {
  Points out;
  for (const Eigen::Vector3f& p : cloud) {
    const auto plane = planes.find(p.cast<double>());
    if (plane && std::abs(plane->normal.z()) < kLevel) out.emplace_back(p.x(), p.y());
  }
  return out;
}

/// How near each place is to a wall, 0 to 255 at a wall, in the square of +-`kHalf` cells around the guess.
class Plan {
 public:
  explicit Plan(const Points& walls) : near_(static_cast<std::size_t>(kSize) * kSize) {
    constexpr int kReach = static_cast<int>(kNear / kCell);
    for (const Eigen::Vector2f& p : walls) {
      const int x = cell(p.x()), y = cell(p.y());
      if (std::abs(x) > kHalf - kReach || std::abs(y) > kHalf - kReach) continue;
      if (near_[at(x, y)] == 255) continue;
      for (int v = -kReach; v <= kReach; ++v)
        for (int u = -kReach; u <= kReach; ++u) {
          const float off = std::hypot(static_cast<float>(u), static_cast<float>(v)) * kCell / kNear;
          const auto value = static_cast<std::uint8_t>(255.0f * std::max(0.0f, 1.0f - off * off));
          near_[at(x + u, y + v)] = std::max(near_[at(x + u, y + v)], value);
        }
    }
    bound_ = near_;
    for (const int step : {1, kSize}) {
      std::vector<std::uint8_t> row = bound_;
      for (std::size_t n = 0; n < bound_.size(); ++n)
        for (int k = 1; k < kSquare; ++k) {
          const std::size_t other = n + static_cast<std::size_t>(k * kStep * step);
          if (other < row.size()) bound_[n] = std::max(bound_[n], row[other]);
        }
    }
  }
  static int cell(float metres) { return static_cast<int>(std::floor(metres / kCell)); }
  /// Of a cell, -kHalf to kHalf in x and y.
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y + kHalf) * kSize + static_cast<std::size_t>(x + kHalf);
  }
  /// Sum of the points' nearness, of cells moved by some cells.
  static std::uint32_t sum(const std::vector<std::uint8_t>& plan, const std::vector<std::size_t>& cells,
                           int x, int y) {
    const auto shift = static_cast<std::ptrdiff_t>(y) * kSize + x;
    std::uint32_t total = 0;
    for (const std::size_t each : cells)
      total += plan[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(each) + shift)];
    return total;
  }
  std::uint32_t score(const std::vector<std::size_t>& cells, int x, int y) const {
    return sum(near_, cells, x, y);
  }
  /// No pose of the square that begins here has a higher score.
  std::uint32_t bound(const std::vector<std::size_t>& cells, int x, int y) const {
    return sum(bound_, cells, x, y);
  }

  static constexpr int kHalf =
      static_cast<int>((static_cast<double>(Keyframe::kReach) + kMaxRelocaliseRadius + 2.0) / kCell);
  static constexpr int kSize = 2 * kHalf + 1;

 private:
  std::vector<std::uint8_t> near_;     ///< Of each cell, how near it is to a wall.
  std::vector<std::uint8_t> bound_{};  ///< The highest of near_ over kSquare steps in x and y from each cell.
};

struct Candidate {
  double x{}, y{}, yaw{};
  std::uint32_t score{};
  bool near(const Candidate& other) const {
    return std::hypot(x - other.x, y - other.y) < kApart &&
           std::abs(wrap_angle(yaw - other.yaw)) < kApartTurn;
  }
};

/// kSquare x kSquare poses of one heading, from a corner on.
struct Square {
  int turn{}, x{}, y{};  ///< Steps of heading; cells.
  std::uint32_t bound{};
};

std::vector<std::size_t> cells_of(const Points& points, double yaw) {
  std::vector<std::size_t> cells;
  const Eigen::Rotation2Df R(static_cast<float>(yaw));
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector2f q = R * p;
    cells.push_back(Plan::at(Plan::cell(q.x()), Plan::cell(q.y())));
  }
  return cells;
}

/// Poses that differ, at which points lie on the plan's walls.
struct Found {
  std::vector<Candidate> best{};  ///< The best first.
  bool complete{};                ///< No pose that was not compared belongs among them.
};

Found search(const Plan& plan, const Points& points, double radius, const RelocaliseParams& params) {
  const int reach = kStep * static_cast<int>(std::ceil(radius / (kStep * kCell) - 1e-9));
  const int turns = static_cast<int>(std::ceil(params.max_turn / kTurnStep - 1e-9));
  std::vector<Square> squares;
  for (int turn = -turns; turn <= turns; ++turn) {
    const auto cells = cells_of(points, turn * kTurnStep);
    for (int y = -reach; y <= reach; y += kSquare * kStep)
      for (int x = -reach; x <= reach; x += kSquare * kStep)
        squares.push_back({turn, x, y, plan.bound(cells, x, y)});
  }
  std::stable_sort(squares.begin(), squares.end(),
                   [](const auto& a, const auto& b) { return a.bound > b.bound; });
  const std::uint32_t left_out = squares.size() > params.max_squares ? squares[params.max_squares].bound : 0;
  if (squares.size() > params.max_squares) squares.resize(params.max_squares);
  std::vector<Candidate> all;
  std::uint32_t highest = 0;
  for (const Square& square : squares) {
    if (2 * square.bound < highest) break;
    const auto cells = cells_of(points, square.turn * kTurnStep);
    for (int v = 0; v < kSquare; ++v)
      for (int u = 0; u < kSquare; ++u) {
        const int x = square.x + u * kStep, y = square.y + v * kStep;
        if (x > reach || y > reach) continue;
        const std::uint32_t score = plan.score(cells, x, y);
        if (2 * score < highest) continue;
        highest = std::max(highest, score);
        all.push_back({kCell * x, kCell * y, square.turn * kTurnStep, score});
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  Found found;
  std::vector<Candidate>& best = found.best;
  for (const Candidate& each : all) {
    if (best.size() == kCandidates || 2 * each.score < highest) break;
    if (std::none_of(best.begin(), best.end(), [&](const Candidate& other) { return each.near(other); }))
      best.push_back(each);
  }
  found.complete = best.size() == kCandidates ? left_out < best.back().score : 2 * left_out < highest;
  return found;
}

bool is_same(const Pose3& a, const Pose3& b) {
  return (a.position - b.position).head<2>().norm() < kSame &&
         std::abs(wrap_angle(a.yaw() - b.yaw())) < kSameTurn;
}

Result<RecognisedPlace> refused(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);  // NOLINT(clang-diagnostic-format-nonliteral)
  return Error{Reason::not_localised_here, text};
}

}  // namespace

Result<RecognisedPlace> relocalise(std::span<const Keyframe> keyframes,
                                   std::span<const Eigen::Vector3f> points, const Pose3& guess, double sigma,
                                   const RelocaliseParams& params) {
  const double radius = std::min(kMaxRelocaliseRadius, 3.0 * sigma + params.moved);
  // On a ramp the body leans. What is unknown is a turn about the vertical, and the plan is one from above.
  // Along odom's axes the planes, and so the result, do not depend on the guess's heading.
  const Pose3 level{guess.position, Eigen::Quaterniond::Identity()};
  const Pose3 T_level_guess = level.inverse() * guess;
  const PointCloud surfaces =
      surfaces_near(keyframes, level, kNearKeyframe + radius, kMaxKeyframes, 2.0 * radius / kMaxKeyframes);
  const std::size_t least = params.planar ? kMinPlanarPoints : kMinPlacePoints;
  if (surfaces.size() < least) return RecognisedPlace{};
  RecognisedPlace place;
  place.match = PlaceMatch::cannot_tell;
  // Thinned as a keyframe, so that walls near the lidar do not count more than others.
  PointCloud scan = make_keyframe(points, guess, 0).points;
  const Eigen::Matrix3f R = T_level_guess.orientation.toRotationMatrix().cast<float>();
  for (Eigen::Vector3f& p : scan) p = R * p;
  scan = surfaces_of(scan, params.planar);
  if (points.size() < least || scan.empty()) return place;
  Points walls = upright(scan, align_target(scan, params.noise));
  // A point in the corner of the keyframe's reach leaves the plan when it is turned.
  std::erase_if(walls, [](const Eigen::Vector2f& p) { return p.norm() > Keyframe::kReach; });
  if (walls.size() < kMinSearchPoints) return place;
  Points some;
  const std::size_t step = std::max<std::size_t>(1, walls.size() / kSearchPoints);
  for (std::size_t n = 0; n < walls.size(); n += step) some.push_back(walls[n]);

  const VoxelPlanes target = align_target(surfaces, params.noise);
  const Found candidates = search(Plan(upright(surfaces, target)), some, radius, params);
  std::vector<Alignment> found;
  for (const Candidate& each : candidates.best)
    found.push_back(align(target, scan, Pose3::level({each.x, each.y, each.yaw}, 0),
                          {.range_noise = params.noise, .keeps_undetermined = true}));
  if (found.empty()) return refused("no place within %.1f m fits what the lidar sees", radius, 0);
  const Alignment& best = *std::max_element(
      found.begin(), found.end(), [](const auto& a, const auto& b) { return a.overlap < b.overlap; });
  for (const Alignment& each : found)
    if (!is_same(each.pose, best.pose)) place.runner_up = std::max(place.runner_up, each.overlap);
  place.overlap = best.overlap;
  if (best.overlap < kAlignOverlap)
    return refused("%.0f %% of what the lidar sees was there before, %.0f %% are expected",
                   100 * best.overlap, 100 * kAlignOverlap);
  if (best.overlap - place.runner_up < kClearly)
    return refused("places look alike: %.0f %% and %.0f %% of what the lidar sees was there before",
                   100 * best.overlap, 100 * place.runner_up);
  if (best.pose.position.head<2>().norm() > radius + kSame)
    return refused("the surroundings fit %.1f m beside the expected place, %.1f m are possible",
                   best.pose.position.head<2>().norm(), radius);
  if (!candidates.complete)
    return refused("too many places within %.1f m could fit to compare them all", radius, 0);
  place.match = PlaceMatch::found;
  place.correction = level_correction(guess, guess.inverse() * level * best.pose * T_level_guess);
  return place;
}

}  // namespace adit::perception
