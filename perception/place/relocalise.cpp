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
  }
  static int cell(float metres) { return static_cast<int>(std::floor(metres / kCell)); }
  /// Of a cell, -kHalf to kHalf in x and y.
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y + kHalf) * kSize + static_cast<std::size_t>(x + kHalf);
  }
  std::uint8_t near(std::size_t index) const { return near_[index]; }

  static constexpr int kHalf =
      static_cast<int>((static_cast<double>(Keyframe::kReach) + kMaxRelocaliseRadius + 1.0) / kCell);
  static constexpr int kSize = 2 * kHalf + 1;

 private:
  std::vector<std::uint8_t> near_;
};

struct Candidate {
  double x{}, y{}, yaw{};
  std::uint32_t score{};
  bool near(const Candidate& other) const {
    return std::hypot(x - other.x, y - other.y) < kApart &&
           std::abs(wrap_angle(yaw - other.yaw)) < kApartTurn;
  }
};

/// Poses at which points lie on the plan's walls, the best first, that differ.
std::vector<Candidate> search(const Plan& plan, const Points& points, double radius, double max_turn) {
  const int steps = static_cast<int>(std::ceil(radius / (kStep * kCell) - 1e-9));
  const int turns = static_cast<int>(std::ceil(max_turn / kTurnStep - 1e-9));
  std::vector<Candidate> all;
  std::vector<std::size_t> cells;
  for (int turn = -turns; turn <= turns; ++turn) {
    const double yaw = turn * kTurnStep;
    const Eigen::Rotation2Df R(static_cast<float>(yaw));
    cells.clear();
    for (const Eigen::Vector2f& p : points) {
      const Eigen::Vector2f q = R * p;
      cells.push_back(Plan::at(Plan::cell(q.x()), Plan::cell(q.y())));
    }
    for (int y = -steps; y <= steps; ++y)
      for (int x = -steps; x <= steps; ++x) {
        const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(kStep) * (y * Plan::kSize + x);
        std::uint32_t score = 0;
        for (const std::size_t each : cells)
          score += plan.near(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(each) + shift));
        all.push_back({kStep * kCell * x, kStep * kCell * y, yaw, score});
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<Candidate> best;
  for (const Candidate& each : all) {
    if (best.size() == kCandidates || 2 * each.score < all.front().score) break;
    if (std::none_of(best.begin(), best.end(), [&](const Candidate& other) { return each.near(other); }))
      best.push_back(each);
  }
  return best;
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
  const PointCloud surfaces = surfaces_near(keyframes, guess, kNearKeyframe + radius, kMaxKeyframes);
  const std::size_t least = params.planar ? kMinPlanarPoints : kMinPlacePoints;
  if (surfaces.size() < least) return RecognisedPlace{};
  RecognisedPlace place;
  place.match = PlaceMatch::cannot_tell;
  // Thinned as a keyframe, so that walls near the lidar do not count more than others.
  const PointCloud scan = surfaces_of(make_keyframe(points, guess, 0).points, params.planar);
  if (points.size() < least || scan.empty()) return place;
  Points walls = upright(scan, align_target(scan, params.noise));
  // A point in the corner of the keyframe's reach leaves the plan when it is turned.
  std::erase_if(walls, [](const Eigen::Vector2f& p) { return p.norm() > Keyframe::kReach; });
  if (walls.size() < kMinSearchPoints) return place;
  Points some;
  const std::size_t step = std::max<std::size_t>(1, walls.size() / kSearchPoints);
  for (std::size_t n = 0; n < walls.size(); n += step) some.push_back(walls[n]);

  const VoxelPlanes target = align_target(surfaces, params.noise);
  std::vector<Alignment> found;
  for (const Candidate& each : search(Plan(upright(surfaces, target)), some, radius, params.max_turn))
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
  place.match = PlaceMatch::found;
  place.correction = level_correction(guess, best.pose);
  return place;
}

}  // namespace adit::perception
