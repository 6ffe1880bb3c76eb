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
  std::size_t max_findings{512};  ///< findings kept, [1, 65536]
  std::size_t in_a_round{4};      ///< sent in a round, [1, 64]
  Duration repeat{2s};            ///< of one that is not acknowledged; doubles up to `slowest`
  Duration slowest{16s};
  std::uint64_t seed{1};  ///< of ids for findings that came without
};

/// What this robot found, until every station that is heard has it (rule 9). Most important first, a few in a
/// round, whatever the length of the gap: nothing queues up. A pure machine but for its finding store.
class FindingSync {
 public:
  using StationId = std::array<std::uint8_t, 16>;
  struct Outputs {
    /// No room: something was given up, or not taken.
    std::function<void(const std::string& text)> full{};
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  FindingSync(SyncParams params, std::shared_ptr<store::Disk> disk, Executor& home,
              std::shared_ptr<Executor> writer, Outputs outputs);

  /// Reads what is on disk: findings, and which stations have them.
  findings::LoadReport load();
  /// Adds one; id 0: it gets one. Its robot is this one. Errors: bad_argument, queue_full when there is no
  /// room and nothing that matters less.
  Result<std::uint64_t> report(findings::Finding finding);
  /// A station has them on its own disk.
  void acknowledged(const StationId& station, std::span<const std::uint64_t> ids, Time now);
  /// What to send now to the stations that are heard: none of them, nothing.
  std::vector<const findings::Finding*> due(const std::vector<StationId>& heard, Time now);

  /// At a clean end, after the home strand has ended: hands what is not on disk yet to the writer's strand.
  void flush() { finding_store_.flush(); }

  std::size_t size() const { return finding_store_.all().size(); }
  /// Given up or not taken since the start.
  std::uint32_t overflowed() const { return overflowed_; }
  const findings::FindingStore& finding_store() const { return finding_store_; }

 private:
  static constexpr std::size_t kStations = 16;  ///< remembered per finding
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
  std::vector<StationId> heard_{};  ///< in the round before
  std::uint32_t overflowed_{};
  bool told_full_{}, tracks_changed_{};
  Time tracks_saved_{};
  Timer timer_{};
};

}  // namespace adit::agent
