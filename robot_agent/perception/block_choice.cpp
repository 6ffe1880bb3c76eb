// SPDX-License-Identifier: Apache-2.0
// Which blocks the next piece is for.
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "perception/stream/piece.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::agent {
namespace {

using transfer::PeerId;

constexpr std::size_t kBlocksInPiece = perception::kMaxPieceBlocks;
constexpr std::size_t kLookedAt =
    4096;                         // Candidates, or cells of the focus, that are looked at for one piece.
constexpr std::size_t kFew = 12;  // Blocks.
constexpr std::size_t kSmallPiece = 600;    // Bytes.
constexpr Duration kRest = 500ms;           // Between two looks at changed blocks when none is due.
constexpr Duration kPieceRest = 200ms;      // Between two looks when there is not enough for a piece.
constexpr Duration kFocusRest = 1s;         // Between two looks at the focus when it lacks nothing.
constexpr std::uint64_t kChangedEvery = 4;  // One piece of so many is for changed blocks first.

/// The lowest 16 bits of a number, each in the place of three.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0xffff;
  bits = (bits | bits << 32) & 0x001f'0000'0000'ffff;
  bits = (bits | bits << 16) & 0x001f'0000'ff00'00ff;
  bits = (bits | bits << 8) & 0x100f'00f0'0f00'f00f;
  bits = (bits | bits << 4) & 0x10c3'0c30'c30c'30c3;
  return (bits | bits << 2) & 0x1249'2492'4924'9249;
}

/// The bits of the three numbers in turn: what is near in this order is near in space (Morton 1966).
std::uint64_t z_order(const perception::BlockIndex& index) {
  const auto axis = [](std::int32_t number) {
    return spread(static_cast<std::uint32_t>(number + perception::BlockIndex::kLimit));
  };
  return axis(index.x) << 2 | axis(index.y) << 1 | axis(index.z);
}

}  // namespace

/// Candidates for a piece, those first that should go first.
struct BlockSource::Choice {
  struct Candidate {
    const Cell* cell{};
    std::uint64_t order{};  ///< Of its index, see z_order().
    bool late{};            ///< It cannot wait for a full piece.
    bool coarse{};          ///< In voxels of 0.4 m.

    std::uint64_t group() const { return cell->first.group; }
  };
  std::vector<Candidate> all{};
  std::set<const Cell*> focused{};

  void add(const Cell& cell, bool late, bool coarse = false) {
    all.push_back({&cell, z_order(cell.first.index), late, coarse});
  }
  /// Puts those from `first` to `last` into an order in which neighbours follow each other, from the one that
  /// is first now on: in a piece, neighbours take least.
  void gather(std::ptrdiff_t first, std::ptrdiff_t last) {
    if (first == last) return;
    const auto begin = all.begin() + first, end = all.begin() + last;
    const auto key = [](const Candidate& c) { return std::pair(c.group(), c.order); };
    const auto from = key(*begin);
    std::sort(begin, end, [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::rotate(begin, std::find_if(begin, end, [&](const auto& c) { return key(c) == from; }), end);
  }
  /// Puts those that are late first, from `first` on, and then their neighbours.
  void late_first(std::ptrdiff_t first) {
    const auto begin = all.begin() + first;
    const auto rest = std::stable_partition(begin, all.end(), [](const Candidate& c) { return c.late; });
    // The first that is late is put before the rest, as that whose neighbours are wanted.
    if (rest == begin) return gather(first, std::ssize(all));
    const auto at = std::rotate(begin, begin + 1, rest);
    gather(at - all.begin(), std::ssize(all));
  }
  /// Those of one group: of the first one that is late, or else of which there are most.
  std::vector<Candidate> of_one_group() const {
    std::map<std::uint64_t, std::size_t> count;
    for (const Candidate& candidate : all) ++count[candidate.group()];
    std::uint64_t group = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                            return a.second < b.second;
                          })->first;
    const auto late = std::find_if(all.begin(), all.end(), [](const Candidate& c) { return c.late; });
    if (late != all.end()) group = late->group();
    std::vector<Candidate> out;
    for (const Candidate& candidate : all)
      if (candidate.group() == group) out.push_back(candidate);
    return out;
  }
  static std::vector<Part> parts_of(const std::vector<Candidate>& candidates) {
    std::vector<Part> out;
    for (std::size_t i = 0; i < std::min(candidates.size(), kBlocksInPiece); ++i)
      out.push_back({.cell = candidates[i].cell->first, .coarse = candidates[i].coarse});
    return out;
  }
};

BlockSource::Due BlockSource::due(const Place& place, std::optional<Time> since, const Waits& waits,
                                  Time now) {
  const Duration quiet = now - place.changed;
  if (!since || now - *since >= waits.latest || quiet >= waits.flush) return Due::late;
  return quiet >= waits.rest ? Due::yes : Due::no;
}

void BlockSource::focus(std::vector<BlockRegion> regions) {
  focus_ = std::move(regions);
  for (auto& [id, peer] : peers_) begin_focus(peer);
}

void BlockSource::focus(const PeerId& id, std::vector<BlockRegion> regions) {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return;
  peer->second.focus = std::move(regions);
  begin_focus(peer->second);
}

void BlockSource::begin_focus(BlockRecipient& peer) {
  peer.focus_rests_until.reset();
  peer.focus_next = std::numeric_limits<std::size_t>::max();
}

bool BlockSource::is_behind() const {
  return std::any_of(peers_.begin(), peers_.end(), [](const auto& peer) { return peer.second.behind; });
}

std::size_t BlockSource::add_slice(const BlockRecipient& peer, const BlockRegion& region, std::int32_t x,
                                   Time now, Choice& out) const {
  std::size_t looked = 1;
  const LatticeCell first{region.group, {x, region.low.y, INT32_MIN}};
  for (auto it = cells_.lower_bound(first); it != cells_.end() && it->first.group == region.group;
       ++it, ++looked) {
    const auto& [cell, place] = *it;
    if (cell.index.x != x || cell.index.y > region.high.y) break;
    if (cell.index.z < region.low.z || cell.index.z > region.high.z) continue;
    const bool rested = now - place.changed >= params_.hold && peer.resting.contains(place.change);
    if (!rested && !peer.unseen.contains(place.change)) continue;
    if (!place.is_on_its_way(peer.bit) && out.focused.insert(&*it).second)
      out.add(*it, true, !rested && goes_coarse(place, peer.bit, now));
  }
  return looked;
}

void BlockSource::add_focused(BlockRecipient& peer, Time now, Choice& out) {
  if (!peer.behind || (peer.focus_rests_until && now < *peer.focus_rests_until)) return;
  std::vector<std::pair<const BlockRegion*, std::int32_t>> slices;
  for (const auto* regions : {&focus_, &peer.focus})
    for (const BlockRegion& region : *regions)
      for (std::int32_t x = region.low.x; x <= region.high.x && slices.size() < kLookedAt; ++x)
        slices.emplace_back(&region, x);
  const std::size_t before = out.all.size();
  std::size_t looked = 0, slice = 0;
  for (; slice < slices.size() && looked < kLookedAt && out.all.size() < kBlocksInPiece; ++slice) {
    peer.focus_next = (peer.focus_next + 1) % slices.size();
    const auto& [region, x] = slices[peer.focus_next];
    looked += add_slice(peer, *region, x, now, out);
  }
  if (slice == slices.size() && out.all.size() == before) peer.focus_rests_until = now + kFocusRest;
}

void BlockSource::add_unseen(const BlockRecipient& peer, Duration wait, Time now, Choice& out) const {
  std::vector<const Cell*> seen;
  std::size_t looked = 0;
  for (auto it = peer.unseen.rbegin(); it != peer.unseen.rend() && looked < kLookedAt; ++it, ++looked) {
    const Place& place = it->second->second;
    // When it has arrived, what changed since is enough.
    if (!place.is_on_its_way(peer.bit) && !out.focused.contains(it->second)) seen.push_back(it->second);
  }
  const Duration longest = (seen.size() < kFew ? 3 : 1) * wait;
  for (const Cell* cell : seen) {
    const Place& place = cell->second;
    const Due is_due = due(place, place.grew_since, {params_.settle, longest, longest}, now);
    if (is_due != Due::no) out.add(*cell, is_due == Due::late, goes_coarse(place, peer.bit, now));
  }
}

std::size_t BlockSource::add_held(const BlockRecipient& peer, const Lacked& places, std::size_t most,
                                  Time now, Choice& out) const {
  std::size_t looked = 0, added = 0;
  for (const auto& [change, cell] : places) {
    if (looked++ >= kLookedAt || added >= most) break;
    const Place& place = cell->second;
    if (place.is_on_its_way(peer.bit) || out.focused.contains(cell)) continue;
    const Due is_due = due(place, place.waits_since, held(), now);
    if (is_due != Due::no) out.add(*cell, is_due == Due::late), ++added;
  }
  return added;
}

void BlockSource::add_resting(const BlockRecipient& peer, Time now, Choice& out) const {
  add_held(peer, peer.resting, kLookedAt, now, out);
}

void BlockSource::add_changed(BlockRecipient& peer, Time now, Choice& out) {
  if (peer.changed_rests_until && now < *peer.changed_rests_until) return;
  if (add_held(peer, peer.changed, kBlocksInPiece, now, out) == 0) peer.changed_rests_until = now + kRest;
}

bool BlockSource::is_coarse_first(BlockRecipient& peer, std::size_t max_bytes) const {
  const bool begins = complete_bytes_ * static_cast<double>(peer.unseen.size()) >
                      static_cast<double>(params_.coarse_pieces * max_bytes);
  // It ends when the peer is not behind any more, as pieces are lost.
  if (begins) peer.coarse_first = peer.behind = true;
  if (!peer.behind) peer.coarse_first = false;
  return peer.coarse_first;
}

std::vector<BlockSource::Part> BlockSource::choose_coarse(BlockRecipient& peer) {
  Choice choice;
  std::size_t looked = 0;
  for (auto it = peer.unseen.lower_bound(peer.coarse_below); it != peer.unseen.begin() && looked < kLookedAt;
       ++looked) {
    --it;
    const Place& place = it->second->second;
    const bool lacks = !place.is_fine(peer.bit) && place.lacks_coarse(peer.bit);
    if (lacks) choice.add(*it->second, true, true);
    if (choice.all.empty()) peer.coarse_below = it->first;
  }
  if (choice.all.empty()) return {};
  choice.gather(0, std::ssize(choice.all));
  return Choice::parts_of(choice.of_one_group());
}

std::vector<BlockSource::Part> BlockSource::choose(BlockRecipient& peer, std::size_t max_bytes, Time now) {
  if (peer.rests_until && now < *peer.rests_until) return {};
  Choice choice;
  const int longer = max_bytes < kSmallPiece ? 4 : 1;
  const bool changed_first = (tokens_ + 1) % kChangedEvery == 0;
  if (changed_first) add_changed(peer, now, choice);
  const std::ptrdiff_t first = std::ssize(choice.all);
  add_focused(peer, now, choice);
  const std::ptrdiff_t focused = std::ssize(choice.all);
  if (changed_first) add_resting(peer, now, choice);
  add_unseen(peer, longer * params_.wait, now, choice);
  if (!changed_first) add_resting(peer, now, choice);
  peer.behind = std::ssize(choice.all) - first > static_cast<std::ptrdiff_t>(kBacklog);
  // Free space shows an operator less than surfaces.
  const auto is_surface = [](const auto& candidate) { return candidate.cell->second.occupied != 0; };
  std::stable_partition(choice.all.begin() + first, choice.all.begin() + focused, is_surface);
  const auto free = std::stable_partition(choice.all.begin() + focused, choice.all.end(), is_surface);
  if (peer.behind) {
    choice.gather(focused, free - choice.all.begin());
    for (auto candidate = choice.all.begin() + first; candidate != choice.all.end(); ++candidate)
      candidate->late = true;
  }
  if (!changed_first) add_changed(peer, now, choice);
  if (!peer.behind) choice.late_first(changed_first ? first : 0);
  if (!choice.all.empty()) {
    const auto candidates = choice.of_one_group();
    const bool late = std::any_of(candidates.begin(), candidates.end(), [](const auto& c) { return c.late; });
    Bytes counts;
    for (const auto& each : candidates) counts.add(each.coarse, each.cell->second.has_base(peer.bit));
    const bool full = expected(counts).sum() >= params_.fill * static_cast<double>(max_bytes);
    if (full || (late && (peer.behind || !peer.round_ends || now >= *peer.round_ends))) {
      if (!full) peer.round_ends = now + longer * params_.round;
      return Choice::parts_of(candidates);
    }
  }
  peer.rests_until = now + kPieceRest;
  return {};
}

}  // namespace adit::agent
