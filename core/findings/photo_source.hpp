// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "core/findings/photo_ledger.hpp"
#include "core/transfer/source.hpp"

namespace adit::findings {

/// One part of the photos that a PhotoLedger offers: the thumbnails, which a sender sends right behind the
/// findings, or the pictures, which it sends when nothing else waits. A picture goes to a peer once its
/// thumbnail is there. Photos go one after the other, the most important first.
class PhotoSource final : public transfer::Source {
 public:
  /// Both others must outlive the source.
  PhotoSource(PhotoPart part, const PhotoStore& photos, PhotoLedger& ledger)
      : part_(part), photos_(photos), ledger_(ledger) {}

  transfer::Kind kind() const override { return transfer::Kind::photos; }
  void join(const transfer::PeerId& peer) override { ledger_.join(peer); }
  void leave(const transfer::PeerId& peer) override {
    ledger_.leave(peer);
    counted_.erase(peer);
  }
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct Flight {
    std::uint64_t content{};
    std::size_t first{}, count{};
    std::vector<transfer::PeerId> peers{};  ///< That lacked it.
  };
  using Blocks = PhotoLedger::Blocks;
  /// The blocks of an offered photo that may go to the peer; null: none may.
  Blocks* wanted(const transfer::PeerId& peer, const OfferedPhoto& photo, Time now) const;

  PhotoPart part_;
  const PhotoStore& photos_;
  PhotoLedger& ledger_;
  std::map<std::uint64_t, Flight> flights_{};  ///< By token.
  std::uint64_t tokens_{};
  /// What missing() returned, and PhotoLedger::changes() then: a sender asks for each piece and peer.
  mutable std::map<transfer::PeerId, std::pair<std::uint64_t, std::size_t>> counted_{};
};

/// What sends the photos of one computer: add the thumbnails to its sender right behind the findings, and the
/// pictures last.
struct PhotoSources {
  /// `photos` must outlive it; the others are as of PhotoLedger.
  PhotoSources(const PhotoStore& photos, std::shared_ptr<store::Disk> disk, Executor& home,
               std::shared_ptr<Executor> writer)
      : ledger(std::move(disk), home, std::move(writer)),
        thumbnails(PhotoPart::thumbnail, photos, ledger),
        pictures(PhotoPart::picture, photos, ledger) {}

  PhotoLedger ledger;
  PhotoSource thumbnails, pictures;
};

/// The photos of those of the findings for which `is_offered` is true and that are not withdrawn.
template <class Findings, class IsOffered>
std::vector<OfferedPhoto> photos_of(const Findings& findings, IsOffered is_offered) {
  std::vector<OfferedPhoto> out;
  for (const auto& [key, finding] : findings)
    if (finding.photo && !finding.withdrawn && is_offered(finding))
      out.push_back({*finding.photo, finding.importance, finding.stamp});
  return out;
}

}  // namespace adit::findings
