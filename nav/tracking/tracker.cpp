// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "nav/geometry/footprint.hpp"

namespace adit::nav {
namespace {

constexpr double kTracked = 8.0;        // Movers are tracked up to this distance from the lidar, m.
constexpr double kReferenceAge = 0.45;  // The scan is compared with the free space of one this much older, s.
// Least age of a second reference, of half of kReferenceAge, for movers that turn about, s.
constexpr double kYoungestAge = 0.2;
constexpr double kPassed = 0.15;  // A ray must pass a place by this much to show that it was free, m.
// Least height of a mover above the ground and the platform's step, m.
constexpr double kLowestMover = 0.15;
constexpr double kBodyMargin = 0.05;  // Returns within this distance of the footprint belong to the robot, m.
constexpr double kLargest = 1.2;      // Larger objects are split, m.
constexpr double kSlowest = 0.3;      // Slower objects count as stationary, m/s.
constexpr double kCentreNoise = 0.08;  // Standard deviation of an observed centre, m.
constexpr double kAgility = 2.0;       // Standard deviation of a mover's acceleration, m/s2.
constexpr double kLost = 0.35;  // A track without an observation for longer counts as stationary or gone, s.
constexpr double kMoverMemory = 4.0;  // A mover that stopped may move again for this long, s.
constexpr float kNearest = 0.1f;      // Nearer returns belong to the robot, m from the lidar.
constexpr float kFarthest = 1e3f;     // m
constexpr float kSteepest = 1e2f;     // Maximum tangent of a ray's elevation.
constexpr double kMinPeriod = 0.08;   // Minimum time between the stored images, s.
constexpr double kBreak = 1.0;        // A longer pause between scans resets the tracker, s.
constexpr int kGapColumns = 2;        // Maximum number of columns without a return within one object.
constexpr float kStep = 0.45f;        // Maximum distance between neighbouring columns of one object, m.
constexpr int kMinColumns = 2;        // Minimum number of columns of an observation.
constexpr int kConfirmed = 3;         // Observations that confirm a mover; one less if it moved before.
constexpr float kSlowing = 0.5f;      // Fraction of the velocity left after each scan without an observation.
constexpr double kGate = 0.5;         // Association gate, m: a farther observation belongs to another object.
constexpr double kFirstSigma = 1.2;   // Standard deviation of an unknown velocity, m/s.
constexpr double kLostSigma = 0.4;    // Standard deviation of the position of a stationary object, m.

}  // namespace

void Tracker::clear() {
  for (Image& image : images_) image.stamp_s = -1e9;
  track_count_ = mover_count_ = 0;
  stamp_s_ = -1e9;
}

const Tracker::Image* Tracker::reference(double stamp_s, double wanted) const {
  const Image* best = nullptr;
  for (const Image& image : images_) {
    const double age = stamp_s - image.stamp_s;
    if (age < kYoungestAge || age > 2 * kReferenceAge) continue;
    const bool enough = age >= wanted, has = best && stamp_s - best->stamp_s >= wanted;
    if (!best || (enough && !has) || (enough == has && (image.stamp_s > best->stamp_s) == enough))
      best = &image;
  }
  return best;
}

void Tracker::look(const ScanPoints& scan, const Pose3& body, double stamp_s) {
  if (stamp_s - stamp_s_ > kBreak || jumped(body.planar(), stamp_s - stamp_s_)) clear();
  body_ = body.planar();
  const double dt = std::min(stamp_s - stamp_s_, kBreak);
  const Image *before = reference(stamp_s, kReferenceAge), *lately = reference(stamp_s, kReferenceAge / 2);
  Image& now = images_[next_];
  newest_ = next_;
  const std::size_t last = (next_ + kImages - 1) % kImages;
  if (stamp_s - images_[last].stamp_s >= kMinPeriod) next_ = (next_ + 1) % kImages;
  take_in(scan, body, now);
  compare(scan, body, before == &now ? nullptr : before, lately == &now ? nullptr : lately, now);
  now.seen.spread();
  now.stamp_s = stamp_s;
  stamp_s_ = stamp_s;
  observe();
  follow(dt);
  show();
}

bool Tracker::jumped(const Pose2& body, double dt) const {
  constexpr double kMore = 1.5;                 // Factor on the platform's maximum speed.
  constexpr double kMetres = 0.2, kTurn = 0.3;  // m and rad: for late or inaccurate odometry.
  const Pose2 by = body_.inverse() * body;
  return std::hypot(by.x, by.y) > kMore * platform_.max_speed * dt + kMetres ||
         std::fabs(by.yaw) > kMore * platform_.max_turn * dt + kTurn;
}

void Tracker::take_in(const ScanPoints& scan, const Pose3& body, Image& now) {
  const Eigen::Matrix3f turn = body.orientation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f lidar = scan.origin(platform_.lidar_origin()).cast<float>();
  const auto points = scan.first();
  now.sensor = body.position.cast<float>() + turn * lidar;
  now.seen.clear();
  for (std::size_t first = 0; first < points.size(); first += block_.count()) {
    block_.take(points.subspan(first), lidar, turn);
    // Four rays at a time.
    std::array<int, RayBlock::kSize> bins;
    for (std::size_t n = 0; n < RayBlock::kSize; ++n) {
      const Ray ray = block_[n];
      // Written so that values that are not finite fail.
      const bool usable =
          (ray.range > kNearest) & (ray.range < kFarthest) & (std::fabs(ray.tangent) < kSteepest);
      bins[n] = usable ? UprightRangeImage::bin_of(ray) : -1;
    }
    for (std::size_t n = 0; n < block_.count(); ++n) {
      if (bins[n] < 0) continue;
      const int nearer = now.seen.add(bins[n], block_[n].range);
      // The last element takes the others.
      constexpr int kOther = UprightRangeImage::kBins;
      nearest_[kOther - nearer * (kOther - bins[n])] = static_cast<std::uint32_t>(first + n);
    }
  }
}

void Tracker::compare(const ScanPoints& scan, const Pose3& body, const Image* before, const Image* lately,
                      const Image& now) {
  const Eigen::Matrix3f turn = body.orientation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f lidar = scan.origin(platform_.lidar_origin()).cast<float>();
  const auto points = scan.first();
  columns_.fill({});
  const Footprint own = Footprint(platform_).grown(kBodyMargin, kBodyMargin);
  const auto low = static_cast<float>(platform_.step + kLowestMover);
  const auto high = static_cast<float>(std::max(platform_.height, platform_.lidar_height) + 0.5);
  const auto reach = static_cast<float>(kTracked), beyond = static_cast<float>(kPassed);
  const auto radius2 = static_cast<float>(own.radius() * own.radius());
  const auto was_free = [beyond](const Image* image, const Eigen::Vector3f& at) {
    if (!image) return false;
    const Eigen::Vector3f from = at - image->sensor;
    const Ray ray = Ray::to(from.x(), from.y(), from.z());
    return ray.range > kNearest && image->seen.saw_past(ray, beyond);
  };
  for (int bin = 0; bin < UprightRangeImage::kBins; ++bin) {
    if (!now.seen.filled(bin)) continue;
    const Eigen::Vector3f& p = points[nearest_[bin]];
    if (p.z() < low || p.z() > high) continue;
    const Eigen::Vector3f d = turn * (p - lidar), at = now.sensor + d;
    const float range = std::sqrt(d.x() * d.x() + d.y() * d.y());
    if (range > reach || (!was_free(before, at) && !was_free(lately, at))) continue;
    if (p.x() * p.x() + p.y() * p.y() < radius2 && own.depth(p.x(), p.y()) > 0) continue;
    Column& column = columns_[bin % UprightRangeImage::kColumns];
    if (column.returns++ > 0 && column.range <= range) continue;
    column.range = range;
    column.at = at.head<2>();
  }
}

void Tracker::observe() {
  observation_count_ = 0;
  int start = -1;  // Begins behind a gap, so that no object is cut at the seam.
  for (int c = 0; c < UprightRangeImage::kColumns; ++c) {
    bool gap = true;
    for (int k = 0; k <= kGapColumns; ++k)
      gap &= columns_[(c + UprightRangeImage::kColumns - k) % UprightRangeImage::kColumns].returns == 0;
    if (gap && start < 0) start = c;
  }
  if (start < 0) return;
  int first = -1, last = -1;
  for (int k = 0; k <= UprightRangeImage::kColumns; ++k) {
    const int c = (start + k) % UprightRangeImage::kColumns;
    const bool there = k < UprightRangeImage::kColumns && columns_[c].returns > 0;
    if (first >= 0) {
      const auto& at = columns_[(start + last) % UprightRangeImage::kColumns].at;
      const auto& begin = columns_[(start + first) % UprightRangeImage::kColumns].at;
      const bool apart = there && ((columns_[c].at - at).norm() > kStep ||
                                   (columns_[c].at - begin).norm() > static_cast<float>(kLargest));
      if (k - last > kGapColumns + 1 || apart || k == UprightRangeImage::kColumns) {
        add_observation((start + first) % UprightRangeImage::kColumns, last - first + 1);
        first = -1;
      }
    }
    if (!there) continue;
    if (first < 0) first = k;
    last = k;
  }
}

void Tracker::add_observation(int first, int columns) {
  Observation seen{{0, 0}, first, columns, false};
  int filled = 0;
  for (int k = 0; k < columns; ++k) {
    const Column& column = columns_[(first + k) % UprightRangeImage::kColumns];
    if (column.returns == 0) continue;
    ++filled;
    seen.middle += column.at;
  }
  if (filled < kMinColumns || observation_count_ == kTracks) return;
  seen.middle /= static_cast<float>(filled);
  observations_[observation_count_++] = seen;
}

void Tracker::follow(double dt) {
  const double q = kAgility * kAgility;
  const auto step = static_cast<float>(dt);
  for (std::size_t i = 0; i < track_count_; ++i) {
    Track& t = tracks_[i];
    t.mover.position += step * t.mover.velocity;
    for (std::uint32_t k = 0; k < t.mover.count; ++k) t.mover.points[k] += step * t.mover.velocity;
    t.place += 2 * dt * t.both + dt * dt * t.speed + q * dt * dt * dt * dt / 4;
    t.both += dt * t.speed + q * dt * dt * dt / 2;
    t.speed += q * dt * dt;
  }
  // Associates the nearest pair first, until no pair is within its gate.
  std::array<bool, kTracks> followed{};
  while (true) {
    double best = 1.0;
    std::size_t track = kTracks, observation = kTracks;
    for (std::size_t i = 0; i < track_count_; ++i)
      for (std::size_t k = 0; k < observation_count_ && !followed[i]; ++k) {
        if (observations_[k].taken) continue;
        const double gate = kGate + 2 * std::sqrt(tracks_[i].place);
        const double off = (observations_[k].middle - tracks_[i].mover.position).norm() / gate;
        if (off >= best) continue;
        best = off;
        track = i;
        observation = k;
      }
    if (track == kTracks) break;
    followed[track] = observations_[observation].taken = true;
    confirm(tracks_[track], observations_[observation]);
  }
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < track_count_; ++i) {
    Track& t = tracks_[i];
    const double unseen = stamp_s_ - t.seen_s;
    // Without an observation it has probably slowed down or turned about on ground that it just left.
    if (unseen > 0) t.mover.velocity *= kSlowing;
    if (unseen > kLost) {
      if (!t.moved || unseen > kMoverMemory) continue;
      // It stopped or is out of sight: it stays where it was seen last until it is seen to move.
      t.mover.velocity.setZero();
      t.confirmed = 0;
      t.both = 0;
      t.speed = kFirstSigma * kFirstSigma;
      t.place = std::min(t.place, kLostSigma * kLostSigma);
    }
    if (remaining != i) tracks_[remaining] = t;
    ++remaining;
  }
  track_count_ = remaining;
  for (std::size_t k = 0; k < observation_count_ && track_count_ < kTracks; ++k) {
    if (observations_[k].taken) continue;
    Track& t = tracks_[track_count_++];
    t = {};
    t.mover.position = observations_[k].middle;
    t.place = kCentreNoise * kCentreNoise;
    t.speed = kFirstSigma * kFirstSigma;
    confirm(t, observations_[k]);
  }
}

void Tracker::confirm(Track& t, const Observation& seen) {
  const double noise = kCentreNoise * kCentreNoise;
  const double gain = t.place / (t.place + noise), speed_gain = t.both / (t.place + noise);
  const Eigen::Vector2f off = seen.middle - t.mover.position;
  t.mover.position += static_cast<float>(gain) * off;
  t.mover.velocity += static_cast<float>(speed_gain) * off;
  t.speed -= speed_gain * t.both;
  t.both *= 1 - gain;
  t.place *= 1 - gain;
  t.seen_s = stamp_s_;
  ++t.confirmed;
  t.mover.count = 0;
  const int stride = (seen.columns - 1) / static_cast<int>(Mover::kMax) + 1;
  for (int k = 0; k < seen.columns; k += stride) {
    const Column& column = columns_[(seen.first + k) % UprightRangeImage::kColumns];
    if (column.returns > 0) t.mover.points[t.mover.count++] = column.at;
  }
}

void Tracker::show() {
  mover_count_ = 0;
  for (std::size_t i = 0; i < track_count_ && mover_count_ < kMax; ++i) {
    Track& t = tracks_[i];
    Mover& mover = t.mover;
    mover.sigma_velocity = static_cast<float>(std::sqrt(std::max(0.0, t.speed)));
    const float speed = mover.velocity.norm();
    // An object that moved before needs less evidence.
    mover.moves = t.confirmed >= kConfirmed - t.moved && speed >= static_cast<float>(kSlowest) &&
                  speed >= (t.moved ? 1 : 2) * mover.sigma_velocity;
    t.moved |= mover.moves;
    if (t.moved) movers_[mover_count_++] = mover;
  }
}

}  // namespace adit::nav
