// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo_source.hpp"

#include <algorithm>

namespace adit::findings {

using transfer::PeerId;

std::size_t PhotoSource::missing(const PeerId& peer) const {
  auto& [changes, count] = counted_[peer];
  if (changes == ledger_.changes()) return count;
  changes = ledger_.changes();
  count = 0;
  for (const OfferedPhoto& photo : ledger_.offered()) {
    const PhotoLedger::Held* held = std::as_const(ledger_).held(peer, photo);
    if (held == nullptr) return count = 0;
    if (part_ == PhotoPart::picture && !held->has(PhotoPart::thumbnail)) continue;
    if (photos_.find(photo.ref.content, part_) != nullptr)
      count += held->parts[static_cast<std::size_t>(part_)].left;
  }
  return count;
}

PhotoSource::Blocks* PhotoSource::wanted(const PeerId& peer, const OfferedPhoto& photo, Time now) const {
  PhotoLedger::Held* held = ledger_.held(peer, photo);
  if (held == nullptr || held->rests_until > now) return nullptr;
  if (part_ == PhotoPart::picture && !held->has(PhotoPart::thumbnail)) return nullptr;
  Blocks& blocks = held->parts[static_cast<std::size_t>(part_)];
  return blocks.left > 0 ? &blocks : nullptr;
}

std::optional<transfer::Source::Content> PhotoSource::next(std::span<const PeerId> peers,
                                                           std::size_t max_bytes, Time now) {
  const std::size_t most =
      max_bytes >= PhotoPiece::kHead + PhotoPiece::kMaxBlocks * kPhotoBlock ? PhotoPiece::kMaxBlocks : 1;
  for (const OfferedPhoto& photo : ledger_.offered()) {
    const store::Bytes* bytes = photos_.find(photo.ref.content, part_);
    if (bytes == nullptr) continue;
    std::size_t first = blocks_of(bytes->size());
    for (const PeerId& peer : peers)
      if (const Blocks* blocks = wanted(peer, photo, now))
        for (std::size_t i = 0; i < first; ++i)
          if (blocks->lacks(i)) first = i;
    if (first == blocks_of(bytes->size())) continue;
    std::size_t count = 1;
    const auto lacked = [&](const PeerId& peer) {
      const Blocks* blocks = wanted(peer, photo, now);
      return blocks != nullptr && blocks->lacks(first + count);
    };
    while (count < most && std::ranges::any_of(peers, lacked)) ++count;
    ledger_.sent();
    Flight& flight = flights_[++tokens_];
    flight = {photo.ref.content, first, count, {}};
    for (const PeerId& peer : peers) {
      Blocks* blocks = wanted(peer, photo, now);
      if (blocks == nullptr) continue;
      bool any = false;
      for (std::size_t i = first; i < first + count; ++i) {
        if (!blocks->lacks(i)) continue;
        blocks->sent(i);
        any = true;
      }
      if (any) flight.peers.push_back(peer);
    }
    PhotoPiece piece{.part = part_,
                     .content = photo.ref.content,
                     .bytes = static_cast<std::uint32_t>(bytes->size()),
                     .first = static_cast<std::uint16_t>(first)};
    const std::size_t begin = first * kPhotoBlock, end = std::min(bytes->size(), begin + count * kPhotoBlock);
    piece.data.assign(bytes->begin() + static_cast<std::ptrdiff_t>(begin),
                      bytes->begin() + static_cast<std::ptrdiff_t>(end));
    return Content{tokens_, encode(piece)};
  }
  return std::nullopt;
}

void PhotoSource::acknowledged(const PeerId& peer, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end()) return;
  // A peer that lacked none of it acknowledges it, too: it came by the same radio.
  ledger_.acknowledged(peer, flight->second.content, part_, flight->second.first, flight->second.count);
}

void PhotoSource::lost(const PeerId& peer, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end() || std::ranges::find(flight->second.peers, peer) == flight->second.peers.end())
    return;
  ledger_.lost(peer, flight->second.content, part_, flight->second.first, flight->second.count);
}

}  // namespace adit::findings
