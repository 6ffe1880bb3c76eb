// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>

#include "core/time/time.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/findings/report_rate.hpp"

namespace adit::agent {

/// Turns detections of one object into one finding. An object is known again by its source and id, or without
/// an id by its kind within DetectionParams::same. It becomes a finding after DetectionParams::sightings
/// messages, or goes on with a finding of the same kind within that distance that no other object in view
/// has: a detector that was restarted, or changes its ids, reports nothing twice. Later sightings are
/// updates, only when an operator would notice the change.
///
/// A pure state machine, bounded in tracks and in new findings per time.
class DetectionReporter {
 public:
  static constexpr double kMoved = 0.3;  ///< Smallest motion that is reported, m.
  static constexpr double kSurer = 0.1;  ///< Smallest rise of the score that is reported.
  static constexpr double kReused =
      10.0;  ///< An id that was out of view for kOut and is farther away is another's, m.
  static constexpr Duration kOut = 2s;    ///< An object that was not seen for so long is out of view.
  static constexpr Duration kRetry = 5s;  ///< After a finding that had no room.
  static constexpr std::size_t kTracks = 256;

  /// Stores a photo for a finding of that importance; nothing: there is no room.
  using StorePhoto =
      std::function<std::optional<findings::PhotoRef>(const findings::Photo& photo, std::uint8_t importance)>;

  /// `findings` must outlive it. `store`: empty: photos are not used.
  DetectionReporter(DetectionParams params, std::string robot, FindingSource& findings, StorePhoto store = {})
      : params_(std::move(params)), robot_(std::move(robot)), findings_(findings), store_(std::move(store)) {}

  /// Takes an object. `place`: map frame, m. `message`: a number of the message that it is from.
  /// Errors: those of FindingSource::report(), queue_full for too many new findings.
  Result<void> take(const Detection& detection, const Eigen::Vector3d& place, std::uint64_t message,
                    Time now);

  std::size_t tracks() const { return tracks_.size(); }

 private:
  /// An object over several messages.
  struct Track {
    std::string source{}, id{}, kind{};
    Eigen::Vector3d place{0, 0, 0};                  ///< Mean of the last sightings, map frame, m.
    Eigen::Vector3d reported{0, 0, 0};               ///< Map frame, m.
    double score{}, reported_score{};                ///< The best one.
    double sigma{};                                  ///< The smallest one, m; 0: unknown.
    std::shared_ptr<const findings::Photo> photo{};  ///< That of the best score, until it is reported.
    std::string text{};
    int sightings{};
    std::uint64_t message{};
    std::uint64_t finding{};  ///< Id of its finding; 0: none.
    Time seen{}, retry{};
  };
  Track& track_of(const Detection& detection, const Eigen::Vector3d& place, Time now);
  /// Id of a stored finding of the object; 0: none.
  std::uint64_t known(const Track& track, Time now) const;
  Result<void> report(Track& track, std::uint8_t importance, Time now);
  findings::Finding finding_of(const Track& track, std::uint8_t importance, Time now) const;
  /// Stores the photo of the track, if it has one.
  std::optional<findings::PhotoRef> store_photo(const Track& track, std::uint8_t importance) const;

  DetectionParams params_;
  std::string robot_;
  FindingSource& findings_;
  StorePhoto store_;
  std::list<Track> tracks_{};
  ReportRate new_findings_{};
};

}  // namespace adit::agent
