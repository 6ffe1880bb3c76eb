// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/findings/finding_store.hpp"
#include "core/time/random.hpp"

namespace adit::agent {

struct SyncParams {
  std::string robot{};
  std::size_t max_findings{512};  ///< Maximum number of stored findings, [1, 65536].
  std::size_t in_a_round{4};      ///< Maximum number of findings sent in a round, [1, 64].
  Duration repeat{2s};            ///< Period of an unacknowledged finding; doubles up to `slowest`.
  Duration slowest{16s};
  std::uint64_t seed{1};  ///< For ids of findings that were reported without one.
};

/// Sends this robot's findings until every station that is heard has them (rule 9). Sends the most important
/// first, a few in a round, so that nothing accumulates after a long link outage. A pure state machine except
/// for its finding store.
class FindingSync {
 public:
  using StationId = std::array<std::uint8_t, 16>;
  struct Outputs {
    /// Reports that there is no room: a finding was discarded or not accepted.
    std::function<void(const std::string& text)> full{};
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  FindingSync(SyncParams params, std::shared_ptr<store::Disk> disk, Executor& home,
              std::shared_ptr<Executor> writer, Outputs outputs);

  /// Loads from disk the findings and the stations that have them.
  findings::LoadReport load();
  /// Adds a finding and sets its robot; id 0 is replaced by a new id. Errors: bad_argument, queue_full if
  /// there is no room and no less important finding.
  Result<std::uint64_t> report(findings::Finding finding);
  /// Records that a station has the findings on its own disk.
  void acknowledged(const StationId& station, std::span<const std::uint64_t> ids, Time now);
  /// The findings to send now to the stations that are heard; empty if no station is heard.
  std::vector<const findings::Finding*> due(const std::vector<StationId>& heard, Time now);

  /// Hands unwritten findings to the writer's strand, at a clean end after the home strand has ended.
  void flush() { finding_store_.flush(); }

  std::size_t size() const { return finding_store_.all().size(); }
  /// Number of findings discarded or not accepted since the start.
  std::uint32_t overflowed() const { return overflowed_; }
  const findings::FindingStore& finding_store() const { return finding_store_; }

 private:
  static constexpr std::size_t kStations = 16;  ///< Stored for each finding.
  struct Track {
    std::vector<StationId> has{};
    Time next{};
    Duration pause{};
  };
  Track& track(std::uint64_t id) { return tracks_[id]; }
  bool make_room(std::uint8_t importance);
  void save_tracks(Time now);

  SyncParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  Outputs outputs_;
  Random random_;
  findings::FindingStore finding_store_;
  std::map<std::uint64_t, Track> tracks_{};
  std::vector<StationId> heard_{};  ///< Stations heard in the previous round.
  std::uint32_t overflowed_{};
  bool told_full_{}, tracks_changed_{};
  Time tracks_saved_{};
  Timer timer_{};
};

}  // namespace adit::agent
