// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo_ledger.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/store/background.hpp"
#include "core/store/pack.hpp"
#include "core/store/preserve.hpp"

namespace adit::findings {
namespace {

using transfer::PeerId;

constexpr const char* kLedgerFile = "photos-known";
constexpr store::StateFormat kLedgerFormat{{'P', 'H', 'A', 'K'}, 1, 1024 * 1024};
constexpr Duration kLedgerWrite = 3ms;  // In rehearsal.
constexpr std::size_t kMostBlocks = blocks_of(PhotoRef::kMaxBytes);

void pack_blocks(store::Packer& out, const std::vector<bool>& has) {
  out.put(static_cast<std::uint16_t>(has.size()));
  // A part that is there takes no more.
  const bool all = std::ranges::all_of(has, [](bool one) { return one; });
  out.flag(all);
  if (all) return;
  for (std::size_t i = 0; i < has.size(); i += 8) {
    std::uint8_t byte = 0;
    for (std::size_t bit = 0; bit < 8 && i + bit < has.size(); ++bit)
      byte = static_cast<std::uint8_t>(byte | (has[i + bit] ? 1U << bit : 0U));
    out.put(byte);
  }
}

std::vector<bool> unpack_blocks(store::Unpacker& in) {
  std::vector<bool> has(in.count(kMostBlocks));
  if (in.flag()) return std::vector<bool>(has.size(), true);
  std::uint8_t byte = 0;
  for (std::size_t i = 0; i < has.size() && in.good(); ++i) {
    if (i % 8 == 0) byte = in.get<std::uint8_t>();
    has[i] = (byte >> (i % 8) & 1U) != 0;
  }
  return has;
}

}  // namespace

bool PhotoLedger::Held::has(PhotoPart part) const { return parts[static_cast<std::size_t>(part)].complete(); }

/// Makes what is known of a photo as long as the photo is.
void PhotoLedger::fit(Held& held, const PhotoRef& ref) {
  const std::array<std::size_t, 2> bytes{ref.thumbnail, ref.bytes};
  for (std::size_t i = 0; i < 2; ++i) {
    Blocks& blocks = held.parts[i];
    const std::size_t count = blocks_of(bytes[i]);
    if (blocks.has.size() != count) blocks.has.assign(count, false);
    if (blocks.flying.size() == count) continue;
    blocks.flying.assign(count, false);
    blocks.left = static_cast<std::size_t>(std::ranges::count(blocks.has, false));
  }
}

void PhotoLedger::load() {
  if (!disk_) return;
  const store::State state = store::StateFile(disk_, kLedgerFile, kLedgerFormat).load();
  if (state.found != store::LoadStatus::good) {
    if (state.found != store::LoadStatus::nothing)
      (void)store::set_aside(*disk_, kLedgerFile, store::name(state.found));
    return;
  }
  store::Unpacker in(state.payload);
  for (std::size_t peers = in.count(kPeers); peers > 0 && in.good(); --peers) {
    const auto id = in.array<16>();
    std::map<std::uint64_t, Held> photos;
    for (std::size_t left = in.count(kPhotos); left > 0 && in.good(); --left) {
      const auto content = in.get<std::uint64_t>();
      Held held;
      for (Blocks& blocks : held.parts) blocks.has = unpack_blocks(in);
      photos[content] = std::move(held);
    }
    if (in.good()) peers_[id].photos = std::move(photos);
  }
}

void PhotoLedger::offer(std::vector<OfferedPhoto> photos) {
  std::ranges::sort(photos, {}, [](const OfferedPhoto& photo) {
    return std::tuple(255 - photo.importance, photo.stamp, photo.ref.content);
  });
  // Two findings may have one photo.
  std::set<std::uint64_t> seen;
  std::erase_if(photos, [&](const OfferedPhoto& photo) { return !seen.insert(photo.ref.content).second; });
  if (photos.size() > kPhotos) photos.resize(kPhotos);
  if (photos == offered_) return;
  offered_ = std::move(photos);
  ++changes_;
  std::set<std::uint64_t> offered;
  for (const OfferedPhoto& photo : offered_) offered.insert(photo.ref.content);
  for (auto& [id, peer] : peers_)
    std::erase_if(peer.photos, [&](const auto& entry) { return !offered.contains(entry.first); });
  for (auto& [id, peer] : peers_)
    for (const OfferedPhoto& photo : offered_) fit(peer.photos[photo.ref.content], photo.ref);
  changed_ = true;
}

void PhotoLedger::join(const PeerId& id) {
  ++changes_;
  if (!peers_.contains(id) && peers_.size() >= kPeers) {
    const auto gone = std::ranges::find_if(peers_, [](const auto& entry) { return !entry.second.here; });
    if (gone == peers_.end()) return;
    peers_.erase(gone);
  }
  Peer& peer = peers_[id];
  peer.here = true;
  peer.heard.reset();
  // What was on its way was for the process before.
  for (auto& [content, held] : peer.photos) {
    for (Blocks& blocks : held.parts) blocks.flying.clear();
    held.losses = 0;
    held.pause = {};
    held.rests_until = {};
  }
  for (const OfferedPhoto& photo : offered_) fit(peer.photos[photo.ref.content], photo.ref);
}

void PhotoLedger::leave(const PeerId& id) {
  ++changes_;
  if (const auto peer = peers_.find(id); peer != peers_.end()) peer->second.here = false;
}

void PhotoLedger::heard(const PeerId& id, Time now) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  Peer& peer = found->second;
  if (peer.heard && now - *peer.heard >= kSilence)
    for (auto& [content, held] : peer.photos) held.losses = 0, held.pause = {}, held.rests_until = {};
  peer.heard = now;
}

bool PhotoLedger::is_here(const PeerId& id) const {
  const auto peer = peers_.find(id);
  return peer != peers_.end() && peer->second.here;
}

PhotoLedger::Held* PhotoLedger::find(const PeerId& id, std::uint64_t content) {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return nullptr;
  const auto held = peer->second.photos.find(content);
  return held == peer->second.photos.end() ? nullptr : &held->second;
}

PhotoLedger::Held* PhotoLedger::held(const PeerId& id, const OfferedPhoto& photo) {
  return is_here(id) ? find(id, photo.ref.content) : nullptr;
}

const PhotoLedger::Held* PhotoLedger::held(const PeerId& id, const OfferedPhoto& photo) const {
  return const_cast<PhotoLedger*>(this)->held(id, photo);
}

void PhotoLedger::acknowledged(const PeerId& id, std::uint64_t content, PhotoPart part, std::size_t first,
                               std::size_t count) {
  Held* held = find(id, content);
  if (held == nullptr) return;
  ++changes_;
  held->parts[static_cast<std::size_t>(part)].acknowledged(first, count);
  held->losses = 0;
  held->pause = {};
  held->rests_until = {};
  changed_ = true;
}

void PhotoLedger::lost(const PeerId& id, std::uint64_t content, PhotoPart part, std::size_t first,
                       std::size_t count) {
  Held* held = find(id, content);
  if (held == nullptr) return;
  ++changes_;
  held->parts[static_cast<std::size_t>(part)].lost(first, count);
  if (held->losses < 255) ++held->losses;
  const Time now = home_.now();
  if (held->losses < kRow || now < held->rests_until) return;
  // A peer that refuses a photo, for example because it has no room, gets a piece of it now and then.
  held->pause = held->pause == Duration{} ? Duration{kShortestPause}
                                          : std::min<Duration>(2 * held->pause, kLongestPause);
  held->rests_until = now + held->pause;
}

void PhotoLedger::tick(Time now) {
  if (!disk_ || !changed_ || now - saved_ < kPeriod) return;
  saved_ = now;
  save();
}

store::Bytes PhotoLedger::as_bytes() const {
  store::Packer out;
  out.put(static_cast<std::uint16_t>(peers_.size()));
  for (const auto& [id, peer] : peers_) {
    out.put(id).put(static_cast<std::uint16_t>(std::min(peer.photos.size(), kPhotos)));
    std::size_t left = kPhotos;
    for (const auto& [content, held] : peer.photos) {
      if (left-- == 0) break;
      out.put(content);
      for (const Blocks& blocks : held.parts) pack_blocks(out, blocks.has);
    }
  }
  return out.bytes();
}

void PhotoLedger::save() {
  changed_ = false;
  timer_ = store::run_in_background(*disk_, home_, writer_,
                                    {.name = "known photos", .modelled = kLedgerWrite, .pool = PoolKind::io},
                                    [file = store::StateFile(disk_, kLedgerFile, kLedgerFormat),
                                     bytes = as_bytes()] { (void)file.save(1, bytes); });
}

}  // namespace adit::findings
