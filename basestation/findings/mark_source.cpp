// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/mark_source.hpp"

#include <algorithm>

#include "core/findings/finding_piece.hpp"

namespace adit::station {
namespace {

using transfer::PeerId;

}  // namespace

void MarkSource::refresh() {
  for (const auto& [key, finding] : desk_.all())
    if (marks_.is_own(finding) && desk_.is_stored(key)) revisions_[key.id] = finding.revision;
}

bool MarkSource::lacks(const Peer& peer, std::uint64_t id, std::uint32_t revision) {
  const auto held = peer.find(id);
  if (held == peer.end()) return true;
  return (!held->second.has || *held->second.has < revision) &&
         (!held->second.sent || *held->second.sent < revision);
}

std::size_t MarkSource::missing(const PeerId& id) const {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      revisions_, [&](const auto& mark) { return lacks(peer->second, mark.first, mark.second); }));
}

std::optional<transfer::Source::Content> MarkSource::next(std::span<const PeerId> peers,
                                                          std::size_t max_bytes, Time now) {
  now_ = now;
  std::vector<const findings::Finding*> due;
  for (const auto& [id, revision] : revisions_) {
    const auto wanted = [&, mark = id, newest = revision](const PeerId& peer) {
      const auto known = peers_.find(peer);
      if (known == peers_.end() || !lacks(known->second, mark, newest)) return false;
      const auto held = known->second.find(mark);
      return held == known->second.end() || held->second.rests_until <= now;
    };
    const auto finding = desk_.all().find(marks_.key_of(id));
    // A newer revision that is not on the disk yet goes when it is.
    if (finding != desk_.all().end() && finding->second.revision == revision &&
        std::ranges::any_of(peers, wanted))
      due.push_back(&finding->second);
  }
  if (due.empty()) return std::nullopt;
  std::ranges::stable_sort(due, std::ranges::greater{}, &findings::Finding::importance);
  findings::FindingPiece piece{
      .robot = station_, .stored = static_cast<std::uint32_t>(revisions_.size()), .owner = marks_.owner()};
  std::size_t bytes = findings::encoded_head(station_);
  // One that was lost twice goes alone, so that one that a station cannot store holds up no other.
  const auto goes_alone = [&](const findings::Finding& finding) {
    return std::ranges::any_of(peers, [&](const PeerId& id) {
      const auto peer = peers_.find(id);
      if (peer == peers_.end()) return false;
      const auto held = peer->second.find(finding.key.id);
      return held != peer->second.end() && held->second.losses >= 2;
    });
  };
  Revisions carried;
  for (const findings::Finding* finding : due) {
    const bool alone = goes_alone(*finding);
    if (alone && !piece.findings.empty()) continue;
    const std::size_t size = findings::encoded_size(*finding);
    if (piece.findings.size() == findings::FindingPiece::kMaxFindings) break;
    if (!piece.findings.empty() && bytes + size > max_bytes) break;  // One alone goes in any case.
    bytes += size;
    piece.findings.push_back(*finding);
    carried[finding->key.id] = finding->revision;
    if (alone) break;
  }
  for (const PeerId& id : peers)
    if (const auto peer = peers_.find(id); peer != peers_.end())
      for (const auto& [mark, revision] : carried) peer->second[mark].sent = revision;
  flights_[++tokens_] = std::move(carried);
  return Content{tokens_, findings::encode(piece)};
}

void MarkSource::acknowledged(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const auto& [mark, revision] : flight->second) {
    Held& held = peer->second[mark];
    held.has = std::max(held.has.value_or(0), revision);
    if (held.sent && *held.sent <= revision) held.sent.reset();
    held.losses = 0;
    held.rests_until = {};
  }
}

void MarkSource::lost(const PeerId& id, std::uint64_t token) {
  constexpr Duration kRest = std::chrono::seconds(1);
  constexpr std::uint8_t kMaxLosses = 5;
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const auto& [mark, revision] : flight->second) {
    Held& held = peer->second[mark];
    if (held.sent != revision) continue;  // A newer one is on its way.
    held.sent.reset();
    held.rests_until = now_ + std::min<Duration>(kRest * (1 << held.losses), kLongestRest);
    held.losses = std::min<std::uint8_t>(held.losses + 1, kMaxLosses);
  }
}

}  // namespace adit::station
