// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/finding_source.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/findings/finding_piece.hpp"

namespace adit::agent {
namespace {

using findings::Finding;
using findings::FindingPiece;
using transfer::PeerId;

constexpr std::uint8_t kAlone = 2;  // A finding that was lost so often goes alone.

Duration pause_after(std::uint8_t losses) {
  if (losses < 2) return {};
  Duration pause = FindingSource::kShortestPause;
  for (int i = 2; i < losses && pause < FindingSource::kLongestPause; ++i) pause *= 2;
  return std::min<Duration>(pause, FindingSource::kLongestPause);
}

}  // namespace

FindingSource::FindingSource(FindingParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                             std::shared_ptr<Executor> writer, Outputs outputs)
    : params_(std::move(params)),
      disk_(disk),
      home_(home),
      outputs_(std::move(outputs)),
      random_(params_.seed),
      known_(disk, home, writer),
      finding_store_({.max_findings = params_.max_findings}, std::move(disk), home, std::move(writer),
                     {[](const findings::Key&) {}, outputs_.failing}) {}

findings::LoadReport FindingSource::load() {
  findings::LoadReport report = finding_store_.load();
  known_.load([this](std::uint64_t id) { return finding_store_.all().contains({params_.robot, id}); });
  return report;
}

Result<std::uint64_t> FindingSource::report(Finding finding) {
  finding.key.robot = params_.robot;
  while (finding.key.id == 0) finding.key.id = random_.next();
  if (!findings::valid(finding))
    return {Reason::bad_argument, "a finding needs a kind, a place, and fits its bounds"};
  const std::uint64_t id = finding.key.id;
  if (finding_store_.all().contains(finding.key)) return id;
  if (finding_store_.full() && !make_room(finding.importance))
    return {Reason::queue_full, "no room for one more finding"};
  (void)finding_store_.put(std::move(finding));  // It is valid, and there is room.
  for (auto& [station, peer] : peers_) peer.wants.try_emplace(id);
  rests_until_.reset();
  return id;
}

bool FindingSource::make_room(std::uint8_t importance) {
  const Finding* least = nullptr;  // The least important one; findings that a station has go first.
  bool least_known = false;
  for (const auto& [key, finding] : finding_store_.all()) {
    const bool known = known_.has(key.id);
    if (least && (least_known != known ? least_known : least->importance <= finding.importance)) continue;
    least = &finding;
    least_known = known;
  }
  const bool give_up = least && (least_known || least->importance < importance);
  if (!least_known) {
    ++overflowed_;
    if (!reported_full_)
      outputs_.full(std::to_string(params_.max_findings) + " findings are kept, there is no room for more");
    reported_full_ = true;
  }
  if (!give_up) return false;
  const findings::Key key = least->key;
  known_.erase(key.id);
  for (auto& [station, peer] : peers_) take_from(peer, key.id);
  finding_store_.drop(key);
  return true;
}

void FindingSource::take_from(FindingRecipient& peer, std::uint64_t id) {
  const auto want = peer.wants.find(id);
  if (want == peer.wants.end()) return;
  if (want->second.flights > 0) --peer.flying;
  peer.wants.erase(want);
}

void FindingSource::heard(const PeerId& station, Time now) {
  const auto found = peers_.find(station);
  if (found == peers_.end()) return;
  FindingRecipient& peer = found->second;
  if (peer.heard && now - *peer.heard >= kSilence) {
    for (auto& [id, want] : peer.wants) want.losses = 0, want.next = {};
    rests_until_.reset();
  }
  peer.heard = now;
}

void FindingSource::tick(Time now) {
  known_.tick(now);
  const bool idle = std::all_of(peers_.begin(), peers_.end(),
                                [this](const auto& peer) { return missing(peer.first) == 0; });
  if (idle) run_ = 0;
}

void FindingSource::join(const PeerId& station) {
  FindingRecipient& peer = peers_[station];
  // What was on its way was for the station's process before; what is on its disk it still has.
  peer.wants.clear();
  peer.flying = 0;
  for (const auto& [key, finding] : finding_store_.all())
    if (!known_.has(key.id, station)) peer.wants.try_emplace(key.id);
  rests_until_.reset();
}

std::size_t FindingSource::missing(const PeerId& station) const {
  const auto found = peers_.find(station);
  return found == peers_.end() ? 0 : found->second.wants.size() - found->second.flying;
}

std::vector<FindingSource::Due> FindingSource::due(std::span<const PeerId> peers, Time now) {
  std::map<std::uint64_t, bool> ids;  // Whether it goes alone.
  std::optional<Time> earliest;
  for (const PeerId& station : peers) {
    const auto peer = peers_.find(station);
    if (peer == peers_.end()) continue;
    for (const auto& [id, want] : peer->second.wants) {
      if (want.flights > 0) continue;
      if (want.next > now)
        earliest = std::min(earliest.value_or(want.next), want.next);
      else
        ids[id] |= want.losses >= kAlone;
    }
  }
  if (ids.empty()) rests_until_ = earliest;
  std::vector<Due> out;
  for (const auto& [id, alone] : ids) out.push_back({&finding_store_.all().at({params_.robot, id}), alone});
  std::sort(out.begin(), out.end(), [](const Due& a, const Due& b) {
    const auto order = [](const Due& due) {
      const Finding& f = *due.finding;
      return std::tuple(255 - f.importance, due.alone, f.stamp, f.key.id);
    };
    return order(a) < order(b);
  });
  return out;
}

std::optional<transfer::Source::Content> FindingSource::next(std::span<const PeerId> peers,
                                                             std::size_t max_bytes, Time now) {
  if (run_ >= kRun || (rests_until_ && now < *rests_until_)) {
    run_ = 0;
    return std::nullopt;
  }
  const std::vector<Due> waiting = due(peers, now);
  if (waiting.empty()) {
    run_ = 0;
    return std::nullopt;
  }
  FindingPiece piece{params_.robot, static_cast<std::uint32_t>(size()), overflowed_, {}};
  std::vector<std::uint64_t>& ids = flights_[++tokens_];
  std::size_t bytes = findings::encoded_head(params_.robot);
  for (const Due& one : waiting) {
    const std::size_t more = findings::encoded_size(*one.finding);
    if (!ids.empty() && (one.alone || bytes + more > max_bytes)) continue;
    bytes += more;
    piece.findings.push_back(*one.finding);
    ids.push_back(one.finding->key.id);
    if (one.alone || ids.size() >= FindingPiece::kMaxFindings) break;
  }
  for (const PeerId& station : peers) {
    const auto peer = peers_.find(station);
    if (peer == peers_.end()) continue;
    for (const std::uint64_t id : ids)
      if (const auto want = peer->second.wants.find(id); want != peer->second.wants.end())
        if (want->second.flights++ == 0) ++peer->second.flying;
  }
  ++run_;
  return Content{tokens_, findings::encode(piece)};
}

void FindingSource::acknowledged(const PeerId& station, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end()) return;
  for (const std::uint64_t id : flight->second) {
    if (!finding_store_.all().contains({params_.robot, id})) continue;  // Discarded meanwhile.
    known_.add(id, station);
    reported_full_ = false;
    if (const auto peer = peers_.find(station); peer != peers_.end()) take_from(peer->second, id);
  }
}

void FindingSource::lost(const PeerId& station, std::uint64_t token) {
  const auto flight = flights_.find(token);
  const auto peer = peers_.find(station);
  if (flight == flights_.end() || peer == peers_.end()) return;
  for (const std::uint64_t id : flight->second) {
    const auto want = peer->second.wants.find(id);
    if (want == peer->second.wants.end() || want->second.flights == 0) continue;
    if (--want->second.flights > 0) continue;
    --peer->second.flying;
    if (want->second.losses < 255) ++want->second.losses;
    want->second.next = home_.now() + pause_after(want->second.losses);
  }
  rests_until_.reset();
}

}  // namespace adit::agent
