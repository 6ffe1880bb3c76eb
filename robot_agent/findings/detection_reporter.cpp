// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/detection_reporter.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "core/findings/object_data.hpp"

namespace adit::agent {
namespace {

constexpr double kLeastWeight = 0.2;  // Of a sighting in the mean: an object may move.

constexpr std::string_view kScore = "score ";  // Begins a text that says nothing else.

std::string score_text(double score, double sigma) {
  std::array<char, 48> text{};
  if (sigma > 0.0)
    std::snprintf(text.data(), text.size(), "%.2f, sigma %.1f m", score, sigma);
  else
    std::snprintf(text.data(), text.size(), "%.2f", score);
  return std::string(kScore) + text.data();
}

Eigen::Vector3d position_of(const findings::Finding& finding) {
  return {finding.position[0], finding.position[1], finding.position[2]};
}

}  // namespace

DetectionReporter::Track& DetectionReporter::track_of(const Detection& detection,
                                                      const Eigen::Vector3d& place, Time now) {
  auto found = tracks_.end();
  double nearest = params_.same;
  for (auto at = tracks_.begin(); at != tracks_.end(); ++at) {
    if (at->kind != detection.kind || at->id != detection.id) continue;
    const double distance = (at->place - place).norm();
    if (!detection.id.empty()) {
      if (at->source != detection.source) continue;
      found = at;
      break;
    }
    if (distance > nearest) continue;
    nearest = distance;
    found = at;
  }
  const bool reused =
      found != tracks_.end() && now - found->seen > kOut && (found->place - place).norm() > kReused;
  if (reused) tracks_.erase(found);
  if (found != tracks_.end() && !reused) return *found;
  if (tracks_.size() >= kTracks) {
    // Objects that are no finding yet go first, then the one that was seen longest ago.
    tracks_.erase(std::min_element(tracks_.begin(), tracks_.end(), [](const Track& a, const Track& b) {
      const bool a_first = a.finding == 0, b_first = b.finding == 0;
      return a_first != b_first ? a_first : a.seen < b.seen;
    }));
  }
  return tracks_.emplace_back(Track{
      .source = detection.source, .id = detection.id, .kind = detection.kind, .place = place, .seen = now});
}

Result<void> DetectionReporter::take(const Detection& detection, const Eigen::Vector3d& place,
                                     std::uint64_t message, Time now) {
  Track& track = track_of(detection, place, now);
  if (track.sightings > 0 && track.message == message) return {};  // Two parts of one object.
  if (track.finding == 0 && now - track.seen > params_.lapse) {
    track.sightings = 0;
    track.score = track.sigma = 0.0;
    track.photo.reset();
  }
  track.message = message;
  track.seen = now;
  ++track.sightings;
  if (detection.photo && detection.score > track.score) track.photo = detection.photo;
  track.score = std::max(track.score, detection.score);
  if (detection.sigma > 0.0 && (track.sigma <= 0.0 || detection.sigma < track.sigma))
    track.sigma = detection.sigma;
  if (!detection.text.empty()) track.text = detection.text;
  track.place += (place - track.place) * std::max(1.0 / track.sightings, kLeastWeight);
  if (track.sightings < params_.sightings || now < track.retry) return {};
  if (track.finding != 0 && !findings_.has(track.finding))
    track.finding = 0;  // It was dropped for lack of room.
  const auto reported = report(track, params_.importance_of(track.kind), now);
  if (!reported) track.retry = now + kRetry;
  return reported;
}

Result<void> DetectionReporter::report(Track& track, std::uint8_t importance, Time now) {
  if (track.finding == 0) {
    track.finding = known(track, now);
    if (track.finding != 0) {
      const findings::Finding& stored = findings_.finding_store().all().at(findings_.key(track.finding));
      track.reported = position_of(stored);
      track.reported_score = stored.withdrawn ? -1.0 : track.score;
    }
  }
  const auto note = [&track] {
    track.reported = track.place;
    track.reported_score = track.score;
  };
  if (track.finding == 0) {
    if (!new_findings_.take(now))
      return {Reason::queue_full, "more than " + std::to_string(ReportRate::kBurst) +
                                      " new objects at once and one a second: '" + track.kind + "' waits"};
    findings::Finding finding = finding_of(track, importance, now);
    finding.photo = store_photo(track, importance);
    const auto taken = findings_.report(std::move(finding));
    if (!taken) return taken.error();
    track.finding = *taken;
    track.photo.reset();
    note();
    return {};
  }
  if ((track.place - track.reported).norm() < kMoved && track.score - track.reported_score < kSurer)
    return {};
  findings::Finding changed = finding_of(track, importance, now);
  changed.key.id = track.finding;
  // What others reported of it stays: a name, a photo, or what another program knows.
  const findings::Finding& before = findings_.finding_store().all().at(findings_.key(track.finding));
  changed.importance = std::max(changed.importance, before.importance);
  if (changed.data.empty() || !findings::read_object(before)) changed.data = before.data;
  changed.photo = before.photo;
  if (!before.photo || findings::read_object(before))
    if (const auto photo = store_photo(track, importance)) changed.photo = photo;
  if (track.text.empty() && !before.text.starts_with(kScore)) changed.text = before.text;
  const auto updated = findings_.update(std::move(changed));
  if (updated) {
    track.photo.reset();
    note();
  }
  return updated;
}

std::uint64_t DetectionReporter::known(const Track& track, Time now) const {
  double nearest = params_.same;
  std::uint64_t id = 0;
  for (const auto& [key, finding] : findings_.finding_store().all()) {
    if (key.robot != robot_ || finding.kind != track.kind) continue;
    const double distance = (position_of(finding) - track.place).norm();
    if (distance > nearest) continue;
    // Two objects that one detector sees beside each other are two.
    const bool taken = std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& other) {
      return &other != &track && other.finding == key.id && other.source == track.source &&
             now - other.seen <= kOut;
    });
    if (taken) continue;
    nearest = distance;
    id = key.id;
  }
  return id;
}

findings::Finding DetectionReporter::finding_of(const Track& track, std::uint8_t importance, Time now) const {
  return {.kind = track.kind,
          .importance = importance,
          .position = {track.place.x(), track.place.y(), track.place.z()},
          .stamp = to_stamp(now),
          .text = track.text.empty() ? score_text(track.score, track.sigma) : track.text,
          .data = track.sigma > 0.0 ? findings::encode_object({track.sigma, track.score}) : store::Bytes{}};
}

std::optional<findings::PhotoRef> DetectionReporter::store_photo(const Track& track,
                                                                 std::uint8_t importance) const {
  return track.photo && store_ ? store_(*track.photo, importance) : std::nullopt;
}

}  // namespace adit::agent
