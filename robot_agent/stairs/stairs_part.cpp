// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_part.hpp"

#include <utility>

#include "perception/stairs/stairs_detector.hpp"

namespace adit::agent {

namespace {

constexpr float kFar = 8.0f;      // Points are used within 6 m of the newest scan's place, m.
constexpr double kAtRest = 0.05;  // Way in the window of a body that stands and sways, m.
constexpr float kNear = 6.0f;     // An end of a staircase, for a check of it, m.

/// What one search shows.
struct Seen {
  std::vector<Staircase> stairs{};
  StairsTracker::Checks checks{};
};

}  // namespace

StairsCloud accumulated(std::span<const std::shared_ptr<const StairsJob>> scans, const Eigen::Vector3d& eye) {
  StairsCloud out;
  struct Part {
    Eigen::Vector3f eye;
    std::size_t count;
  };
  std::vector<Part> parts;
  for (const auto& job : scans) {
    const auto scan = without_team(job->scan, job->team);
    const Eigen::Affine3f T_odom_base =
        (Eigen::Translation3d(scan->located.position) * scan->located.orientation).cast<float>();
    const std::vector<std::uint8_t> passing = scan->passing();
    std::size_t n = 0;
    scan->measured().each_part(
        eye, [&](std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& origin) {
          const std::size_t before = out.points.size();
          for (const Eigen::Vector3f& point : points) {
            const bool passes = n < passing.size() && passing[n] != 0;
            ++n;
            if (!passes && point.squaredNorm() < kFar * kFar) out.points.push_back(T_odom_base * point);
          }
          parts.push_back({T_odom_base * origin.cast<float>(), out.points.size() - before});
        });
  }
  std::span<const Eigen::Vector3f> rest(out.points);
  for (const Part& part : parts) {
    out.rays.push_back({part.eye, rest.first(part.count)});
    rest = rest.subspan(part.count);
  }
  return out;
}

StairsPart::StairsPart(StairsParams params, Executor& strand, Log log, StairsService& service)
    : Component("stairs", strand, std::move(log), {.beat = 100ms}),
      params_(params),
      service_(service),
      detector_(std::make_shared<perception::StairsDetector>()),
      tracker_(params.instance) {}

Result<void> StairsPart::on_start() {
  offer(service_, [this](const auto& job, const auto& reply) { take(job, reply); });
  return {};
}

bool StairsPart::is_due(const StairsJob& job) const {
  if (searching_) return false;
  if (!sought_from_) return true;
  const Eigen::Vector3d at = job.scan->located.position;
  const double way = (at - *sought_from_).norm();
  // Where it came to rest, no motion blurs the scans.
  const bool rests =
      scans_.size() == params_.most_scans && (at - scans_.front()->scan->located.position).norm() < kAtRest;
  return way >= params_.least_way || (rests && way >= 2 * kAtRest);
}

void StairsPart::take(const std::shared_ptr<const StairsJob>& job, const Reply<StairsStep>& reply) {
  // Poses before a jump, or of another frame, do not fit.
  if (!scans_.empty() &&
      (scans_.back()->odom_epoch != job->odom_epoch || scans_.back()->scan->jumps != job->scan->jumps)) {
    scans_.clear();
    tracker_.clear();
    sought_from_.reset();
  }
  scans_.push_back(job);
  while (scans_.size() > params_.most_scans || job->made - scans_.front()->made > params_.window)
    scans_.pop_front();
  if (!is_due(*job)) return reply(StairsStep{{}, {}, job->odom_epoch});
  searching_ = true;
  sought_from_ = job->scan->located.position;
  const Eigen::Vector3f eye = (job->scan->located * params_.eye).cast<float>();
  compute(
      {.name = "stairs", .modelled = params_.modelled, .lane = "map"},
      [scans = std::vector(scans_.begin(), scans_.end()), detector = detector_, eye, of_base = params_.eye,
       known = tracker_.all()] {
        const StairsCloud cloud = accumulated(scans, of_base);
        Seen seen{detector->detect(cloud.points, eye), {}};
        for (const StairsTracker::Tracked& track : known)
          if ((track.stairs.foot.cast<float>() - eye).norm() < kNear ||
              (track.stairs.top().cast<float>() - eye).norm() < kNear)
            seen.checks[track.id] = perception::check_stairs(track.stairs, cloud.rays);
        return seen;
      },
      [this, reply, job](Result<Seen> seen) {
        searching_ = false;
        if (!seen) return reply(seen.error());
        const StairsJob& newest = *scans_.back();
        // The frame may have begun again, or jumped, meanwhile.
        if (newest.odom_epoch != job->odom_epoch || newest.scan->jumps != job->scan->jumps)
          return reply(StairsStep{{}, {}, newest.odom_epoch});
        tracker_.take(seen->stairs, job->scan->located.position, seen->checks);
        reply(StairsStep{tracker_.confirmed(), tracker_.take_withdrawn(), job->odom_epoch});
      });
}

}  // namespace adit::agent
