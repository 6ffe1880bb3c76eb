// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/block_source.hpp"

#include <algorithm>

#include "perception/stream/piece.hpp"

namespace adit::agent {
namespace {

using perception::BlockUpdate;
using transfer::PeerId;

constexpr std::size_t kBlocksInPiece = 64;
constexpr std::size_t kLookedAt = 512;      // Candidates that are looked at for one piece.
constexpr std::uint64_t kChangedEvery = 4;  // One piece of so many is for changed blocks first.

}  // namespace

void BlockSource::add_missing(Peer& peer, const Ref& ref, const Entry& entry) {
  ((entry.had_by & peer.bit) == 0 ? peer.unseen : peer.changed)[entry.change] = ref;
}

void BlockSource::update(std::uint32_t submap, const perception::CoarseBlock& block) {
  const Ref ref{submap, block.index};
  const auto [found, added] = blocks_.try_emplace(ref);
  Entry& entry = found->second;
  if (!added && entry.known == block.known && entry.occupied == block.occupied) return;
  const std::uint64_t before = entry.change;
  entry.known = block.known;
  entry.occupied = block.occupied;
  entry.change = ++changes_;
  for (auto& [id, peer] : peers_) {
    peer.unseen.erase(before);
    peer.changed.erase(before);
    add_missing(peer, ref, entry);
  }
  if (blocks_.size() > params_.max_blocks) drop_oldest_submap();
}

void BlockSource::drop_oldest_submap() {
  const std::uint32_t oldest = blocks_.begin()->first.submap;
  if (oldest == blocks_.rbegin()->first.submap) {  // One submap alone is too large: its first block goes.
    for (auto& [id, peer] : peers_)
      peer.unseen.erase(blocks_.begin()->second.change), peer.changed.erase(blocks_.begin()->second.change);
    blocks_.erase(blocks_.begin());
    ++dropped_;
    return;
  }
  while (blocks_.begin()->first.submap == oldest) {
    const std::uint64_t change = blocks_.begin()->second.change;
    for (auto& [id, peer] : peers_) {
      peer.unseen.erase(change);
      peer.changed.erase(change);
    }
    blocks_.erase(blocks_.begin());
    ++dropped_;
  }
}

void BlockSource::join(const PeerId& id) {
  leave(id);
  if (peers_.size() >= kMaxPeers) return;
  std::uint16_t used = 0;
  for (const auto& [other, peer] : peers_) used |= peer.bit;
  Peer& peer = peers_[id];
  peer.bit = 1;
  while ((used & peer.bit) != 0) peer.bit = static_cast<std::uint16_t>(peer.bit << 1);
  for (const auto& [ref, entry] : blocks_) add_missing(peer, ref, entry);
}

void BlockSource::leave(const PeerId& id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  for (auto& [ref, entry] : blocks_) entry.had_by &= static_cast<std::uint16_t>(~found->second.bit);
  peers_.erase(found);
}

std::size_t BlockSource::missing(const PeerId& id) const {
  const auto found = peers_.find(id);
  return found == peers_.end() ? 0 : found->second.unseen.size() + found->second.changed.size();
}

std::vector<BlockSource::Ref> BlockSource::choose(const Peer& peer, Time now) {
  std::vector<Ref> out;
  const auto add = [&out](const Ref& ref) {
    if (out.size() < kBlocksInPiece && (out.empty() || out.front().submap == ref.submap)) out.push_back(ref);
  };
  const auto add_unseen = [&] {
    std::size_t looked = 0;
    for (auto it = peer.unseen.rbegin(); it != peer.unseen.rend() && looked < kLookedAt; ++it, ++looked)
      add(it->second);
  };
  const auto add_changed = [&] {
    std::size_t looked = 0;
    for (auto it = peer.changed.begin(); it != peer.changed.end() && looked < kLookedAt; ++it, ++looked) {
      const Time sent = blocks_.at(it->second).sent;
      if (sent == Time(Duration::min()) || now - sent >= params_.hold) add(it->second);
    }
  };
  if ((tokens_ + 1) % kChangedEvery == 0) add_changed();
  add_unseen();
  if ((tokens_ + 1) % kChangedEvery != 0) add_changed();
  return out;
}

std::optional<transfer::Source::Content> BlockSource::next(std::span<const PeerId> peers,
                                                           std::size_t max_bytes, Time now) {
  const auto first = peers_.find(peers.front());
  if (first == peers_.end()) return std::nullopt;
  const std::vector<Ref> chosen = choose(first->second, now);
  if (chosen.empty()) return std::nullopt;
  std::vector<BlockUpdate> updates;
  for (const Ref& ref : chosen) {
    const Entry& entry = blocks_.at(ref);
    updates.push_back({{ref.index, entry.known, entry.occupied}, static_cast<std::uint32_t>(entry.change)});
  }
  auto packed = perception::pack({params_.robot, params_.start, chosen.front().submap}, updates, max_bytes);
  if (packed.count == 0) return std::nullopt;
  std::vector<Part>& parts = flights_[++tokens_];
  for (std::size_t i = 0; i < packed.count; ++i) {
    Entry& entry = blocks_.at(chosen[i]);
    entry.sent = now;
    parts.push_back({chosen[i], entry.change});
    for (const PeerId& id : peers) {
      const auto peer = peers_.find(id);
      if (peer == peers_.end()) continue;
      peer->second.unseen.erase(entry.change);
      peer->second.changed.erase(entry.change);
    }
  }
  return Content{tokens_, std::move(packed.bytes)};
}

void BlockSource::acknowledged(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second) {
    const auto block = blocks_.find(part.ref);
    if (block == blocks_.end()) continue;
    Entry& entry = block->second;
    entry.had_by |= peer->second.bit;
    if (peer->second.unseen.erase(entry.change) != 0) peer->second.changed[entry.change] = part.ref;
  }
}

void BlockSource::lost(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second) {
    const auto block = blocks_.find(part.ref);
    if (block == blocks_.end() || block->second.change != part.change) continue;
    block->second.sent = Time(Duration::min());  // The hold is for what arrived.
    add_missing(peer->second, part.ref, block->second);
  }
}

}  // namespace adit::agent
