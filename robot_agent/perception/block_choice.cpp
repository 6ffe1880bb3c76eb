// SPDX-License-Identifier: Apache-2.0
// Which blocks the next piece is for.
#include <algorithm>

#include "perception/stream/piece.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::agent {
namespace {

using transfer::PeerId;

constexpr std::size_t kBlocksInPiece = perception::kMaxPieceBlocks;
constexpr std::size_t kLookedAt =
    4096;                            // Candidates, or cells of the focus, that are looked at for one piece.
constexpr Duration kRest = 500ms;    // Between two looks at changed blocks when none is due.
constexpr Duration kFocusRest = 1s;  // Between two looks at the focus when it lacks nothing.
constexpr std::uint64_t kChangedEvery = 4;  // One piece of so many is for changed blocks first.

}  // namespace

/// Candidates for one piece, all of the submap of the first one.
struct BlockSource::Choice {
  std::vector<Ref> refs{};
  std::set<Ref> focused{};

  bool full() const { return refs.size() >= kLookedAt; }
  void add(const Ref& ref) {
    if (!full() && (refs.empty() || refs.front().submap == ref.submap)) refs.push_back(ref);
  }
};

bool BlockSource::is_needed(const Peer& peer, const Ref& ref) const {
  const Entry& asked = blocks_.at(ref);
  if ((asked.chosen_for & peer.bit) != 0 && (asked.up_to_date & peer.bit) == 0) return true;
  const Cell cell = cell_of(ref);
  const std::vector<std::uint32_t>& submaps = cells_.at(cell);
  const BlockVotes all = votes_of(cell, submaps);
  // The newer ones are brought up to date first; this one is needed if that does not suffice.
  for (std::size_t renewed = submaps.size();; --renewed) {
    BlockVotes shown;
    for (std::size_t i = 0; i < submaps.size(); ++i) {
      const Entry& entry = blocks_.at(ref_in(cell, submaps[i]));
      if (i >= renewed)
        shown.add(entry.known, entry.occupied);
      else if ((entry.chosen_for & peer.bit) != 0)
        shown.add(entry.sent_known, entry.sent_occupied);
    }
    if (shown.shows(all)) return false;
    if (renewed == 0 || submaps[renewed - 1] == ref.submap) return true;
  }
}

Duration BlockSource::hold(const Entry& entry) const {
  Duration hold = params_.hold;
  for (int i = 1; i < entry.sends && hold < params_.max_hold; ++i) hold *= 2;
  return std::min(hold, params_.max_hold);
}

void BlockSource::focus(std::vector<BlockRegion> regions) {
  focus_ = std::move(regions);
  for (auto& [id, peer] : peers_) peer.focus_rests_until.reset();
}

void BlockSource::focus(const PeerId& id, std::vector<BlockRegion> regions) {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return;
  peer->second.focus = std::move(regions);
  peer->second.focus_rests_until.reset();
}

bool BlockSource::is_behind() const {
  return std::any_of(peers_.begin(), peers_.end(),
                     [](const auto& peer) { return peer.second.unseen.size() > kBacklog; });
}

void BlockSource::add_focused(Peer& peer, Time now, Choice& out) {
  if (peer.unseen.size() <= kBacklog || (peer.focus_rests_until && now < *peer.focus_rests_until)) return;
  const std::size_t before = out.refs.size();
  std::size_t looked = 0;
  const auto look = [&](const BlockRegion& region) {
    Cell cell{region.group, region.low};
    for (cell.index.x = region.low.x; cell.index.x <= region.high.x; ++cell.index.x)
      for (cell.index.y = region.low.y; cell.index.y <= region.high.y; ++cell.index.y)
        for (cell.index.z = region.low.z; cell.index.z <= region.high.z; ++cell.index.z) {
          if (++looked > kLookedAt || out.full()) return;
          const auto found = cells_.find(cell);
          if (found == cells_.end()) continue;
          for (const std::uint32_t submap : found->second) {
            const Ref ref = ref_in(cell, submap);
            if (!peer.unseen.contains(blocks_.at(ref).change) || out.focused.contains(ref)) continue;
            out.add(ref);
            if (out.refs.back() == ref) out.focused.insert(ref);
          }
        }
  };
  for (const BlockRegion& region : focus_) look(region);
  for (const BlockRegion& region : peer.focus) look(region);
  if (out.refs.size() == before) peer.focus_rests_until = now + kFocusRest;
}

void BlockSource::add_unseen(const Peer& peer, Choice& out) const {
  // Without a backlog all of them go out at once, in whatever order.
  const std::size_t most = peer.unseen.size() > kBacklog ? kLookedAt : kBlocksInPiece;
  std::size_t looked = 0;
  for (auto it = peer.unseen.rbegin(); it != peer.unseen.rend() && looked < most; ++it, ++looked)
    if (!out.focused.contains(it->second)) out.add(it->second);
}

void BlockSource::add_changed(Peer& peer, Time now, Choice& out) {
  if (peer.rests_until && now < *peer.rests_until) return;
  std::size_t looked = 0;
  bool due = false;
  for (auto it = peer.changed.begin();
       it != peer.changed.end() && looked < kLookedAt && out.refs.size() < kBlocksInPiece; ++looked) {
    const Ref ref = it->second;
    Entry& entry = blocks_.at(ref);
    if (!entry.held_since) entry.held_since = now;  // A place that is shown already can wait.
    if (now - *entry.held_since < hold(entry)) {
      ++it;
      continue;
    }
    if (!is_needed(peer, ref)) {
      it = peer.changed.erase(it);
      if (entry.sends == 0) entry.held_since.reset();
      continue;
    }
    due = true;
    out.add(ref);
    ++it;
  }
  if (!due) peer.rests_until = now + kRest;
}

std::vector<BlockSource::Ref> BlockSource::choose(Peer& peer, Time now) {
  Choice out;
  const bool changed_first = (tokens_ + 1) % kChangedEvery == 0;
  if (changed_first) add_changed(peer, now, out);
  const auto first = static_cast<std::ptrdiff_t>(out.refs.size());
  add_focused(peer, now, out);
  const auto focused = static_cast<std::ptrdiff_t>(out.refs.size());
  add_unseen(peer, out);
  // Free space tells an operator less than surfaces, and surfaces show where it is.
  const auto is_surface = [this](const Ref& ref) { return blocks_.at(ref).occupied != 0; };
  std::stable_partition(out.refs.begin() + first, out.refs.begin() + focused, is_surface);
  std::stable_partition(out.refs.begin() + focused, out.refs.end(), is_surface);
  if (!changed_first) add_changed(peer, now, out);
  if (out.refs.size() > kBlocksInPiece) out.refs.resize(kBlocksInPiece);
  return std::move(out.refs);
}

}  // namespace adit::agent
