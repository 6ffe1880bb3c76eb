// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/findings/finding_store.hpp"
#include "core/time/random.hpp"
#include "core/transfer/source.hpp"
#include "robot_agent/findings/known_findings.hpp"

namespace adit::agent {

struct FindingParams {
  std::string robot{};
  findings::Owner owner{};        ///< Of new findings: the robot's 128 random bits.
  std::size_t max_findings{512};  ///< Largest number of stored findings, [1, 65536].
  std::uint64_t seed{1};          ///< For ids of findings that were reported without one.
};

/// This robot's findings, which every station is to have on its disk (rule 9): the most important go first,
/// several in a piece. A station acknowledges a piece once its findings are on its disk. The findings of a
/// station are remembered by its identity, so that one that was started again gets none of them once more.
///
/// A finding can change. Changed content gets the next revision at most once each kRefinement, and the
/// changes of kRound together, so that findings that change ten times a second neither fill the radio nor
/// wear the disk; only the newest content counts. A station lacks a finding until it acknowledged a piece
/// with its newest revision.
///
/// The revision of a change goes out only once it is on this robot's disk; until then the one before does.
/// So no station has a revision that a restart of the robot can lose, and the next one, one above that on the
/// disk, is higher than any at a station. A counter of starts as the upper half of a revision would not need
/// to wait, but must be on the disk itself before it is used, and a disk that refuses it makes two starts
/// give one number to different contents. The first content of a finding is not held back: a robot whose disk
/// fails still reports what it found. If a crash loses that content and the id is reported again, it has the
/// same revision, and a station keeps the earlier content until the next change. Revisions of findings that
/// were dropped are covered by KnownFindings::floor(). Without a disk, an id must not be used after a
/// restart.
///
/// A finding that a station does not acknowledge goes again at once, then after 2, 4, 8 and 16 s, alone in a
/// piece: one that a station cannot store holds up no other. After kRun pieces in a row the sources behind
/// this one get a turn, so that a full set of findings does not starve the map. A pure state machine except
/// for its finding store.
class FindingSource final : public transfer::Source {
 public:
  static constexpr std::size_t kRun = 3;     ///< Pieces in a row.
  static constexpr Duration kSilence = 12s;  ///< A station silent for so long was away, see SenderParams.
  static constexpr Duration kShortestPause = 2s;
  static constexpr Duration kLongestPause = 16s;
  static constexpr Duration kRefinement = 2s;  ///< Between two revisions of a finding.
  static constexpr Duration kRound = 500ms;    ///< Between two times at which changes get revisions.
  struct Outputs {
    /// Reports that there is no room: a finding was discarded or not accepted.
    std::function<void(const std::string& text)> full{};
    std::function<void(bool failing, const std::string& text)> failing{};
    /// The anchor of a place in the map frame; may be empty, or return nothing.
    std::function<std::optional<findings::Anchor>(const std::array<double, 3>& place)> anchor{};
  };

  FindingSource(FindingParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                std::shared_ptr<Executor> writer, Outputs outputs);

  /// Loads from disk the findings and the stations that have them.
  findings::LoadReport load();
  /// Adds a finding and sets its robot, owner and revision; id 0 is replaced by a new id. An existing id
  /// leaves what is there. Errors: bad_argument, queue_full if there is no room and no less important
  /// finding.
  Result<std::uint64_t> report(findings::Finding finding);
  /// Replaces the content of an existing finding and sets its robot, owner and revision. It waits in memory
  /// for its revision, kRefinement at most while the disk works: a crash loses that much. A withdrawn finding
  /// comes back. Errors: bad_argument (also: no such id), out_of_range when there is no higher revision.
  Result<void> update(findings::Finding finding);
  /// Marks a finding as withdrawn: stations keep it and list it so. Errors: as of update().
  Result<void> withdraw(std::uint64_t id);
  /// Records that a station is there. One that was away gets at once what had begun to wait.
  void heard(const transfer::PeerId& station, Time now);
  /// Writes to the disk what is due. Call it before the sender's due().
  void tick(Time now);
  /// Hands unwritten findings and changes to the writer's strand, at a clean end after the home strand has
  /// ended.
  void flush();

  /// The key of a stored finding, which may be of another owner: the disk is from an older version of this
  /// program, or the file with the robot's identity was lost. Else the key of a new one.
  findings::Key key(std::uint64_t id) const;
  /// The newest content of a finding, which may still wait for its revision; null: there is none of that id.
  const findings::Finding* newest(std::uint64_t id) const;
  bool has(std::uint64_t id) const { return finding_store_.all().contains(key(id)); }
  std::size_t size() const { return finding_store_.all().size(); }
  /// Number of findings discarded or not accepted since the start.
  std::uint32_t overflowed() const { return overflowed_; }
  const findings::FindingStore& finding_store() const { return finding_store_; }

  transfer::Kind kind() const override { return transfer::Kind::findings; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override { peers_.erase(peer); }
  /// The first piece of a run does not wait for the rate: a finding does not wait behind a piece of the map.
  bool ahead() const override { return run_ == 0; }
  std::size_t missing(const transfer::PeerId& peer) const override;
  /// A finding that is longer than `max_bytes` goes alone in a piece of its own length, at most
  /// transfer::kMaxPieceBytes: the wire cuts it into frames.
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  /// A finding that a peer lacks in the newest revision that may go out.
  struct Want {
    std::uint32_t revision{};
    std::uint8_t flights{};  ///< Pieces with that revision that are on their way to the peer.
    std::uint8_t losses{};   ///< Of the finding in a row.
    bool first{};            ///< The peer has no revision of it.
    Time since{};            ///< It waits to be sent.
    Time next{};             ///< Not before.
  };
  struct FindingRecipient {
    std::map<std::uint64_t, Want> wants{};  ///< By id.
    std::size_t flying{};                   ///< Number of those that are on their way.
    std::optional<Time> heard{};
  };
  struct Due {
    const findings::Finding* finding{};
    bool alone{};
    bool first{};
    Time since{};
  };
  /// A finding in a piece that is on its way.
  struct Carried {
    std::uint64_t id{};
    std::uint32_t revision{};
  };
  /// The findings that may go out now, the most important first. Sets rests_until_ if there is none.
  std::vector<Due> due(std::span<const transfer::PeerId> peers, Time now);
  void take_from(FindingRecipient& peer, std::uint64_t id);
  bool make_room(std::uint8_t importance);
  /// Gives a finding its key, and its anchor.
  void complete(findings::Finding& finding) const;
  /// The newest revision that may go out.
  const findings::Finding& sendable(std::uint64_t id) const;
  /// Sends the newest revision that may go out to all peers.
  void offer(std::uint64_t id);
  void on_stored(const findings::Key& key, std::uint32_t revision);
  /// Gives revisions to the changes that are due.
  void revise(Time now);
  void revise(std::uint64_t id, findings::Finding content);

  FindingParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  Outputs outputs_;
  Random random_;
  KnownFindings known_;
  findings::FindingStore finding_store_;
  std::map<transfer::PeerId, FindingRecipient> peers_{};
  std::map<std::uint64_t, std::vector<Carried>> flights_{};  ///< By token.
  std::map<std::uint64_t, findings::Finding> changed_{};     ///< Content that waits for its revision, by id.
  /// The revision before, where the newest is not on the disk yet, by id.
  std::map<std::uint64_t, findings::Finding> before_{};
  std::map<std::uint64_t, Time> revised_{};  ///< When an id got its newest revision, within kRefinement.
  std::optional<Time> round_{};              ///< When changes got revisions.
  std::uint64_t tokens_{};
  std::size_t run_{};                  ///< Pieces since the sources behind this one had a turn.
  std::optional<Time> rests_until_{};  ///< Nothing is due before.
  std::uint32_t overflowed_{};
  bool reported_full_{};
};

}  // namespace adit::agent
