// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "core/findings/finding_store.hpp"
#include "core/findings/mark_data.hpp"
#include "core/result/result.hpp"

namespace adit::findings {
struct FindingPiece;
}

namespace adit::station {

/// The bounds of a FindingDesk.
struct DeskParams {
  std::size_t max_findings{4096};  ///< Maximum number of findings of all robots, [1, 65536].
};

/// Stores the findings of all robots on this station's disk, each in the newest revision that came. A piece
/// of findings is acknowledged to its robot once all of them are on disk here in their revision or a newer
/// one: what does not fit, or cannot be written, stays with the robot.
class FindingDesk {
 public:
  static constexpr std::size_t kMaxMarks = 512;     ///< Of one station; withdrawn ones, too.
  static constexpr std::size_t kMarksOfAll = 2048;  ///< The rest of the room is for what robots find.
  static constexpr std::size_t kMaxPieces = 256;    ///< That wait for the disk; then the oldest is forgotten.
  struct Outputs {
    std::function<void(const findings::Finding&)> found{};  ///< Called with a new finding.
    /// `code`: findings_full or store_failing, store_works.
    std::function<void(const std::string& code, const std::string& text)> trouble{};
    /// Called when a newer revision replaced one; may be empty.
    std::function<void(const findings::Finding& before, const findings::Finding& now)> changed{};
  };
  /// How many findings a robot stores, and for how many it had no room, as it reports.
  struct Report {
    std::uint32_t stored{}, overflowed{};
  };

  FindingDesk(DeskParams params, std::shared_ptr<store::Disk> disk, Executor& home, Outputs outputs);

  /// Loads the findings from disk.
  findings::LoadReport load() { return finding_store_.load(); }
  /// Takes a piece of findings (findings::FindingPiece), genuine or not. `robot`: whose participant sent it.
  /// `stored` is called once all of its findings are on disk, at once if they were before. Errors:
  /// wrong_protocol, malformed (also: findings of another robot, or marks), queue_full (no room).
  Result<void> hear(const std::string& robot, std::span<const std::uint8_t> piece,
                    std::function<void()> stored);
  /// Takes a finding of this station itself, or its next revision. `stored` is called once it is on disk, at
  /// once if it was before. Errors: bad_argument (not valid), queue_full (no room).
  Result<void> keep(findings::Finding finding, std::function<void()> stored);

  /// Takes a piece with marks of another station, genuine or not. `station`, `id`: whose participant sent it.
  /// `stored` as of hear(). Errors: wrong_protocol, malformed (also: what is no mark of that station),
  /// queue_full (also: more than kMaxMarks of one station, or kMarksOfAll).
  Result<void> hear_station(const std::string& station, const findings::Owner& id,
                            std::span<const std::uint8_t> piece, std::function<void()> stored);

  /// Number of the marks of a station; withdrawn ones, too.
  std::size_t marks_of(const std::string& station, const findings::Owner& id) const;
  /// Whether a finding is on disk in its newest revision.
  bool is_stored(const findings::Key& key) const { return finding_store_.is_stored(key); }
  const std::map<findings::Key, findings::Finding>& all() const { return finding_store_.all(); }
  const std::map<std::string, Report>& robots() const { return robots_; }

 private:
  /// A piece that is acknowledged when these findings are on disk, each in that revision or a newer one.
  struct Waiting {
    std::map<findings::Key, std::uint32_t> revisions{};
    std::function<void()> stored{};
  };
  bool touches_mark(const findings::Finding& finding) const;
  std::size_t marks_of_all() const;
  /// Takes all findings of a piece that was checked.
  Result<void> take(findings::FindingPiece piece, std::function<void()> stored);
  /// Stores a finding and adds it to what the piece waits for. Returns false if there is no room.
  bool take(findings::Finding finding, Waiting& waiting);
  /// Calls `stored` when the findings are on disk, or now.
  void wait(Waiting waiting);
  void on_stored(const findings::Key& key, std::uint32_t revision);

  Outputs outputs_;
  std::deque<Waiting> waiting_{};
  std::map<std::string, Report> robots_{};
  bool reported_full_{};
  findings::FindingStore finding_store_;
};

}  // namespace adit::station
