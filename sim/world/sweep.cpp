// SPDX-License-Identifier: Apache-2.0
#include "sim/world/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/box_target.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

constexpr double kTextureSize = 0.25;  // m: edge of a patch of one albedo
constexpr double kDarkest = 0.05;      // albedo
constexpr double kBrightest = 0.9;     // albedo
constexpr double kDark = 0.15;         // albedo below which far returns get lost
constexpr double kGrazing = 0.995;     // squared sine of the incidence beyond which returns get lost
constexpr double kEdge = 0.3;          // m: neighbouring beams that differ by more see an edge
constexpr double kDustReach = 8.0;     // m: farther dust returns too little light
constexpr std::uint64_t kDustSeed = 0x2545f4914f6cdd1dULL;
constexpr double kWrapped = 4.2949668;  // s: nearly 2^32 ns
constexpr std::uint64_t kLossSeed = 1, kCoverSeed = 2;
constexpr double kGolden = 0.6180339887;  // Spreads the columns of a rosette most evenly.
constexpr std::size_t kLines = 4;         // Lasers of a rosette.
constexpr double kDustAlbedo = 0.1;       // of what is left of a beam

/// Albedo of the surface at a place: a fixed pattern of patches.
double albedo_at(const Eigen::Vector3d& place) {
  // Truncation towards zero only makes the patches at the origin larger.
  const auto patch = [](double v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(v / kTextureSize));
  };
  std::uint64_t h = patch(place.x()) * 0x9e3779b97f4a7c15ULL ^ patch(place.y()) * 0xbf58476d1ce4e5b9ULL ^
                    patch(place.z()) * 0x94d049bb133111ebULL;
  h = (h ^ (h >> 29)) * 0xd1342543de82ef95ULL;
  return kDarkest + (kBrightest - kDarkest) * static_cast<double>(h >> 40) * 0x1.0p-24;
}

/// One beam of a column.
struct Neighbours {
  double range{};   ///< True, m.
  double before{};  ///< The same ring in the column before, m.
  double below{};   ///< The next lower ring of this column, m.
};

/// What a lidar measures of true ranges.
class Receiver {
 public:
  Receiver(const LidarParams& params, const LidarErrors& errors, double column_step, double ring_step,
           std::uint64_t seed)
      : params_(params), errors_(errors), column_step_(column_step), ring_step_(ring_step), random_(seed) {}

  struct Return {
    double range{};      ///< Measured, m; NaN: none.
    double intensity{};  ///< [0, 255]
  };

  /// One draw for every beam, whatever it meets, so that a body in the way of some beams leaves the noise of
  /// the others alone.
  Return measure(const Neighbours& beam, const Eigen::Vector3d& sensor, const Eigen::Vector3d& direction) {
    const double deviate = gaussian(random_);
    const double r = beam.range;
    if (errors_.dust > 0.0)
      if (const Return speck = dust(r); !std::isnan(speck.range)) return speck;
    if (!(r <= params_.max_range)) return {std::nan(""), 0.0};
    const double albedo = albedo_at(sensor + r * direction);
    // Squared sine of the incidence, from what the beams beside and below met.
    const double along = beam.before - r, across = beam.below - r;
    const double dx = r * column_step_, dy = r * ring_step_;
    const double sine_x = along * along / (along * along + dx * dx);
    const double sine_y = across * across / (across * across + dy * dy);
    const double sine =
        std::min(1.0, std::max(std::isfinite(along) ? sine_x : 0.0, std::isfinite(across) ? sine_y : 0.0));
    Return out{r, 255.0 * albedo * (1.0 - 0.7 * sine)};
    if (errors_.noise <= 0.0) return out;
    const double far = r / params_.max_range;
    const double share = 1.0 + (errors_.grazing - 1.0) * std::min(1.0, 0.5 * (far + sine));
    out.range += errors_.noise * (errors_.bias + share * params_.range_noise * deviate);
    Random event(random_peek());
    double lost = errors_.dropouts;
    if (sine > kGrazing) lost += 0.3;
    if (albedo < kDark) lost += 0.3 * far;
    if (event.chance(errors_.noise * lost)) return {std::nan(""), 0.0};
    // The beam is wider than the edge: part of it meets what is behind.
    if (std::abs(along) > kEdge && std::isfinite(along) && event.chance(errors_.noise * errors_.mixed))
      out.range += event.uniform() * along;
    return out;
  }

 private:
  /// A particle before `range`, or NaN. Particles are spread evenly (Poisson), but returns become fewer with
  /// the square of the distance, and nearer than the wall they must be.
  Return dust(double range) const {
    Random event(random_peek() ^ kDustSeed);
    if (!event.chance(errors_.noise * errors_.dust)) return {std::nan(""), 0.0};
    const double draw = event.uniform();
    const double at = params_.min_range + draw * draw * (kDustReach - params_.min_range);
    if (!(at < range)) return {std::nan(""), 0.0};
    return {at, 255.0 * kDustAlbedo * (1.0 - 0.5 * draw)};
  }

  /// A seed for rare events that leaves the sequence of draws alone.
  std::uint64_t random_peek() const {
    Random copy = random_;
    return copy.next() ^ 0x5851f42d4c957f2dULL;
  }

  const LidarParams& params_;
  const LidarErrors& errors_;
  double column_step_, ring_step_;  ///< rad
  Random random_;
};

float lost_time(LostTime time, float own) {
  switch (time) {
    case LostTime::zero:
      return 0.0f;
    case LostTime::nan:
      return std::nanf("");
    case LostTime::wrapped:
      return static_cast<float>(kWrapped);
    case LostTime::kept:
      return own;
  }
  return own;
}

}  // namespace

const std::vector<std::string>& lost_time_words() {
  static const std::vector<std::string> words{"zero", "nan", "wrapped", "kept"};
  return words;
}

std::vector<SweepPoint> SweepJob::trace() const {
  const LidarParams& params = lidar->params();
  const auto& azimuths = lidar->azimuths();
  const std::size_t columns = azimuths.size(), rings = lidar->elevations().size();
  const std::size_t intervals = T_world_lidar.size() - 1;
  const double highest =
      std::max(std::abs(lidar->elevations().front().y()), std::abs(lidar->elevations().back().y()));
  // A rosette moves all beams within the step between two of them, another way in each column.
  const double ring_step =
      rings > 1 ? (params.highest - params.lowest) * M_PI / 180.0 / static_cast<double>(rings - 1) : 0.0;
  Receiver receiver(params, errors, 2.0 * M_PI / static_cast<double>(columns), ring_step, seed);

  // Of their own: the faults leave the noise of the other beams alone.
  Random of_loss(derive_seed(seed, kLossSeed)), of_cover(derive_seed(seed, kCoverSeed));
  const double nearest = covered ? 0.0 : params.min_range;
  std::vector<SweepPoint> points(columns * rings);
  std::size_t returns = 0;
  std::vector<Eigen::Vector3d> directions(rings);
  std::vector<double> ranges(rings), before(rings, VoxelGrid::kNoHit);
  std::vector<Eigen::Vector2d> elevations = lidar->elevations();
  double phase = static_cast<double>(seed % 1024) / 1024.0;
  std::vector<BoxTarget> targets;
  std::size_t in_interval = intervals;  // None yet.
  for (std::size_t n = 0; n < columns; ++n) {
    const std::size_t at = (n + columns / 2) % columns;
    const double when = static_cast<double>(n) / static_cast<double>(columns);  // Share of the sweep.
    const std::size_t interval = n * intervals / columns;
    const double part = when * static_cast<double>(intervals) - static_cast<double>(interval);
    const Pose3 &from = T_world_lidar[interval], &to = T_world_lidar[interval + 1];
    // Between poses 10 ms apart the chord of the rotation is as good as its arc.
    Eigen::Quaterniond turn;
    turn.coeffs() = from.orientation.coeffs() + part * (to.orientation.coeffs() - from.orientation.coeffs());
    const Eigen::Matrix3d rotation = turn.normalized().toRotationMatrix();
    const Eigen::Vector3d sensor = from.position + part * (to.position - from.position);
    const VoxelGrid::Start start = world->grid().locate(sensor);
    if (interval != in_interval) {
      in_interval = interval;
      targets.clear();
      // Seen from above, a tilted column's beams spread sideways.
      const double tilt = rotation.col(2).head<2>().norm();
      const double spread = 0.02 + 2.0 * tilt * highest;
      for (const BodyBox& body : others[interval]) {
        BoxTarget target = make_target(body, sensor);
        const double angle = std::acos(std::clamp(target.cos_spread, -1.0, 1.0)) + spread;
        target.cos_spread = angle < M_PI ? std::cos(angle) : -1.0;
        targets.push_back(target);
      }
    }
    const Eigen::Vector3d ahead = rotation.col(0) * azimuths[at].x() + rotation.col(1) * azimuths[at].y();
    if (params.rosette) {
      phase = std::fmod(phase + kGolden, 1.0);
      const Eigen::Rotation2Dd shift((phase - 0.5) * ring_step);
      for (std::size_t k = 0; k < rings; ++k) elevations[k] = shift * lidar->elevations()[k];
    }
    for (std::size_t k = 0; k < rings; ++k)
      directions[k] = ahead * elevations[k].x() + rotation.col(2) * elevations[k].y();
    world->grid().cast(start, directions, params.max_range, ranges);
    for (BoxTarget& target : targets) {
      if (ahead.head<2>().dot(target.towards) < target.cos_spread * ahead.head<2>().norm()) continue;
      target.set_start(sensor);
      for (std::size_t k = 0; k < rings; ++k)
        ranges[k] = std::min(ranges[k], cast_box(target, directions[k]));
    }
    const auto t = static_cast<float>(when * duration);
    const bool lost = loss && of_loss.chance(loss->share);
    for (std::size_t k = 0; k < rings; ++k) {
      // The number of a laser, which moves over all elevations.
      const auto ring = static_cast<std::uint16_t>(params.rosette ? (k + n) % kLines : k);
      const Neighbours beam{ranges[k], params.rosette ? VoxelGrid::kNoHit : before[k],
                            k > 0 ? ranges[k - 1] : VoxelGrid::kNoHit};
      Receiver::Return got = receiver.measure(beam, sensor, directions[k]);
      if (lost) {
        points[returns++] = {0, 0, 0, 0, lost_time(loss->time, t), ring, 0};
        continue;
      }
      if (covered) got = {of_cover.uniform(0.0, kCover), 255.0 * kBrightest};
      if (!(got.range >= nearest && got.range <= params.max_range)) continue;
      const double flat = got.range * elevations[k].x();
      points[returns++] = {static_cast<float>(flat * azimuths[at].x()),
                           static_cast<float>(flat * azimuths[at].y()),
                           static_cast<float>(got.range * elevations[k].y()),
                           static_cast<float>(got.intensity),
                           t,
                           ring,
                           0};
    }
    before.swap(ranges);
  }
  points.resize(returns);
  return points;
}

}  // namespace adit::sim
