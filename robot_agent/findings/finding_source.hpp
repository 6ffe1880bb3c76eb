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
  std::size_t max_findings{512};  ///< Largest number of stored findings, [1, 65536].
  std::uint64_t seed{1};          ///< For ids of findings that were reported without one.
};

/// This robot's findings, which every station is to have on its disk (rule 9): the most important go first,
/// several in a piece. A station acknowledges a piece once its findings are on its disk. The findings of a
/// station are remembered by its identity, so that one that was started again gets none of them once more.
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
  struct Outputs {
    /// Reports that there is no room: a finding was discarded or not accepted.
    std::function<void(const std::string& text)> full{};
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  FindingSource(FindingParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                std::shared_ptr<Executor> writer, Outputs outputs);

  /// Loads from disk the findings and the stations that have them.
  findings::LoadReport load();
  /// Adds a finding and sets its robot; id 0 is replaced by a new id. Errors: bad_argument, queue_full if
  /// there is no room and no less important finding.
  Result<std::uint64_t> report(findings::Finding finding);
  /// Records that a station is there. One that was away gets at once what had begun to wait.
  void heard(const transfer::PeerId& station, Time now);
  /// Writes to the disk what is due. Call it before the sender's due().
  void tick(Time now);
  /// Hands unwritten findings to the writer's strand, at a clean end after the home strand has ended.
  void flush() { finding_store_.flush(); }

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
  /// A finding that a peer lacks.
  struct Want {
    std::uint8_t flights{};  ///< Pieces with it that are on their way to the peer.
    std::uint8_t losses{};   ///< Of it in a row.
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
  };
  /// The findings that may go out now, the most important first. Sets rests_until_ if there is none.
  std::vector<Due> due(std::span<const transfer::PeerId> peers, Time now);
  void take_from(FindingRecipient& peer, std::uint64_t id);
  bool make_room(std::uint8_t importance);

  FindingParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  Outputs outputs_;
  Random random_;
  KnownFindings known_;
  findings::FindingStore finding_store_;
  std::map<transfer::PeerId, FindingRecipient> peers_{};
  std::map<std::uint64_t, std::vector<std::uint64_t>> flights_{};  ///< Ids by token.
  std::uint64_t tokens_{};
  std::size_t run_{};                  ///< Pieces since the sources behind this one had a turn.
  std::optional<Time> rests_until_{};  ///< Nothing is due before.
  std::uint32_t overflowed_{};
  bool reported_full_{};
};

}  // namespace adit::agent
