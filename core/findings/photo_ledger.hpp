// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/findings/photo_store.hpp"
#include "core/transfer/blocks.hpp"
#include "core/transfer/piece.hpp"

namespace adit::findings {

/// A photo that other computers are to have.
struct OfferedPhoto {
  PhotoRef ref{};
  std::uint8_t importance{};  ///< Of its finding.
  std::uint64_t stamp{};      ///< Of its finding, ns.
  bool operator==(const OfferedPhoto&) const = default;
};

/// The photos that this computer offers, and which blocks of them each peer has on its disk. A peer is known
/// by its identity, which outlives its process: after a cut or a restart of either side the transfer goes on
/// where it was. Stored in the file `photos-known` every kPeriod; if a write is lost, some blocks go twice,
/// which harms no peer.
class PhotoLedger {
 public:
  static constexpr std::size_t kPeers = 16;     ///< That are remembered; then one of those that left goes.
  static constexpr std::size_t kPhotos = 1024;  ///< Of those that are offered, the most important.
  static constexpr Duration kPeriod = 5s;
  static constexpr Duration kSilence = 12s;  ///< A peer silent for so long was away.
  static constexpr Duration kShortestPause = 2s, kLongestPause = 16s;
  static constexpr std::uint8_t kRow = 8;  ///< Losses in a row after which a photo rests.

  using Blocks = transfer::Blocks;  ///< Of one part at one peer.
  /// A photo at one peer.
  struct Held {
    std::array<Blocks, 2> parts{};  ///< By PhotoPart.
    std::uint8_t losses{};          ///< In a row.
    Duration pause{};
    Time rests_until{};
    bool has(PhotoPart part) const;
  };

  /// `disk`, `writer`: as of FindingStore.
  PhotoLedger(std::shared_ptr<store::Disk> disk, Executor& home, std::shared_ptr<Executor> writer)
      : disk_(std::move(disk)), home_(home), writer_(std::move(writer)) {}

  void load();
  /// Sets which photos peers are to have.
  void offer(std::vector<OfferedPhoto> photos);
  /// The most important first, of those the oldest.
  const std::vector<OfferedPhoto>& offered() const { return offered_; }
  /// A peer is there: nothing is on its way to it.
  void join(const transfer::PeerId& peer);
  void leave(const transfer::PeerId& peer);
  /// Notes that a peer was heard. One that was away gets at once what rests.
  void heard(const transfer::PeerId& peer, Time now);
  /// What a peer has of an offered photo; null: the peer is not there.
  Held* held(const transfer::PeerId& peer, const OfferedPhoto& photo);
  const Held* held(const transfer::PeerId& peer, const OfferedPhoto& photo) const;
  bool is_here(const transfer::PeerId& peer) const;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t content, PhotoPart part, std::size_t first,
                    std::size_t count);
  void lost(const transfer::PeerId& peer, std::uint64_t content, PhotoPart part, std::size_t first,
            std::size_t count);
  /// Notes that blocks of a peer are on their way.
  void sent() { ++changes_; }
  /// Rises with each change of what any peer lacks.
  std::uint64_t changes() const { return changes_; }
  /// Writes the file when it is due.
  void tick(Time now);

 private:
  struct Peer {
    bool here{};
    std::optional<Time> heard{};
    std::map<std::uint64_t, Held> photos{};  ///< By content.
  };
  static void fit(Held& held, const PhotoRef& ref);
  Held* find(const transfer::PeerId& peer, std::uint64_t content);
  void save();
  store::Bytes as_bytes() const;

  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  std::vector<OfferedPhoto> offered_{};
  std::map<transfer::PeerId, Peer> peers_{};
  std::uint64_t changes_{1};
  bool changed_{};
  Time saved_{};
  Timer timer_{};
};

}  // namespace adit::findings
