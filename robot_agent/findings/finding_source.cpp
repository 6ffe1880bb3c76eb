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

constexpr std::uint8_t kAloneLosses = 2;  // A finding that was lost so often goes alone.

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
                     {[this](const findings::Key& key, std::uint32_t revision) { on_stored(key, revision); },
                      outputs_.failing}) {}

findings::LoadReport FindingSource::load() {
  findings::LoadReport report = finding_store_.load();
  known_.load([this](std::uint64_t id) { return finding_store_.all().contains(key(id)); });
  if (report.surplus > 0) known_.raise_above(report.surplus_revision);
  return report;
}

findings::Key FindingSource::key(std::uint64_t id) const {
  const auto stored = finding_store_.all().lower_bound({params_.robot, id});
  if (stored != finding_store_.all().end() && stored->first.robot == params_.robot && stored->first.id == id)
    return stored->first;
  return {params_.robot, id, params_.owner};
}

void FindingSource::complete(Finding& finding) const {
  finding.key = key(finding.key.id);
  if (outputs_.anchor) finding.anchor = outputs_.anchor(finding.position);
}

Result<std::uint64_t> FindingSource::report(Finding finding) {
  const bool given = finding.key.id != 0;  // Else no station can have one of that id.
  while (finding.key.id == 0) finding.key.id = random_.next();
  complete(finding);
  if (!findings::valid(finding))
    return {Reason::bad_argument, "a finding needs a kind, a place, and fits its bounds"};
  const std::uint64_t id = finding.key.id;
  if (finding_store_.all().contains(finding.key)) return id;
  if (finding_store_.full() && !make_room(finding.importance))
    return {Reason::queue_full, "no room for one more finding"};
  finding.revision = given ? known_.floor() : 0;
  (void)finding_store_.put(std::move(finding));  // It is valid, and there is room.
  revised_[id] = home_.now();
  offer(id);
  return id;
}

Result<void> FindingSource::update(Finding finding) {
  complete(finding);
  if (!findings::valid(finding))
    return {Reason::bad_argument, "a finding needs a kind, a place, and fits its bounds"};
  const std::uint64_t id = finding.key.id;
  const auto stored = finding_store_.all().find(finding.key);
  if (stored == finding_store_.all().end()) return {Reason::bad_argument, "there is no finding of that id"};
  if (std::max(stored->second.revision, known_.floor()) == UINT32_MAX)
    return {Reason::out_of_range, "the finding cannot be changed any more"};
  if (findings::same_content(stored->second, finding))
    changed_.erase(id);
  else
    changed_.insert_or_assign(id, std::move(finding));
  return {};
}

Result<void> FindingSource::withdraw(std::uint64_t id) {
  const auto changed = changed_.find(id);
  const auto stored = finding_store_.all().find(key(id));
  if (stored == finding_store_.all().end()) return {Reason::bad_argument, "there is no finding of that id"};
  Finding finding = changed != changed_.end() ? changed->second : stored->second;
  finding.withdrawn = true;
  return update(std::move(finding));
}

const Finding* FindingSource::newest(std::uint64_t id) const {
  if (const auto changed = changed_.find(id); changed != changed_.end()) return &changed->second;
  const auto stored = finding_store_.all().find(key(id));
  return stored != finding_store_.all().end() ? &stored->second : nullptr;
}

void FindingSource::revise(Time now) {
  std::erase_if(revised_, [now](const auto& entry) { return now - entry.second >= kRefinement; });
  if (changed_.empty() || (round_ && now - *round_ < kRound)) return;
  // While the revision before is not on the disk, the change waits: a disk that is slow gets one at a time.
  std::erase_if(changed_, [&](auto& entry) {
    if (revised_.contains(entry.first) || !finding_store_.is_stored(key(entry.first))) return false;
    revised_[entry.first] = now;
    round_ = now;
    revise(entry.first, std::move(entry.second));
    return true;
  });
}

void FindingSource::revise(std::uint64_t id, Finding content) {
  const Finding& old = finding_store_.all().at(key(id));
  content.revision = std::max(old.revision, known_.floor()) + 1;
  before_.insert_or_assign(id, old);
  (void)finding_store_.put(std::move(content));
}

void FindingSource::flush() {
  for (auto& [id, content] : changed_) revise(id, std::move(content));
  changed_.clear();
  finding_store_.flush();
}

void FindingSource::on_stored(const findings::Key& key, std::uint32_t revision) {
  if (finding_store_.all().at(key).revision == revision && before_.erase(key.id) > 0) offer(key.id);
}

const Finding& FindingSource::sendable(std::uint64_t id) const {
  const auto before = before_.find(id);
  return before != before_.end() ? before->second : finding_store_.all().at(key(id));
}

void FindingSource::offer(std::uint64_t id) {
  const std::uint32_t revision = sendable(id).revision;
  for (auto& [station, peer] : peers_) {
    const auto [entry, is_new] = peer.wants.try_emplace(id);
    Want& want = entry->second;
    if (is_new) want.first = !known_.revision(id, station);
    if (is_new || want.flights > 0) want.since = home_.now();
    if (want.flights > 0) --peer.flying;  // With an older revision.
    want.flights = 0;
    want.revision = revision;
  }
  rests_until_.reset();
}

bool FindingSource::make_room(std::uint8_t importance) {
  const Finding* least = nullptr;  // The least important one; findings that a station has go first.
  bool least_known = false;
  for (const auto& [key, finding] : finding_store_.all()) {
    const bool known = known_.has(key.id, finding.revision) && !changed_.contains(key.id);
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
  known_.raise_above(least->revision);
  changed_.erase(key.id);
  before_.erase(key.id);
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
  revise(now);
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
  for (const auto& [key, finding] : finding_store_.all()) {
    const auto has = known_.revision(key.id, station);
    const std::uint32_t revision = sendable(key.id).revision;
    if (!has || *has < revision)
      peer.wants[key.id] = {.revision = revision, .first = !has, .since = home_.now()};
  }
  rests_until_.reset();
}

std::size_t FindingSource::missing(const PeerId& station) const {
  const auto found = peers_.find(station);
  return found == peers_.end() ? 0 : found->second.wants.size() - found->second.flying;
}

std::vector<FindingSource::Due> FindingSource::due(std::span<const PeerId> peers, Time now) {
  std::map<std::uint64_t, Due> ids;
  std::optional<Time> earliest;
  for (const PeerId& station : peers) {
    const auto peer = peers_.find(station);
    if (peer == peers_.end()) continue;
    for (const auto& [id, want] : peer->second.wants) {
      if (want.flights > 0) continue;
      if (want.next > now)
        earliest = std::min(earliest.value_or(want.next), want.next);
      else {
        Due& one = ids.try_emplace(id, Due{&sendable(id), false, false, want.since}).first->second;
        one.alone |= want.losses >= kAloneLosses;
        one.first |= want.first;
        one.since = std::min(one.since, want.since);
      }
    }
  }
  if (ids.empty()) rests_until_ = earliest;
  std::vector<Due> out;
  for (const auto& [id, one] : ids) out.push_back(one);
  std::sort(out.begin(), out.end(), [](const Due& a, const Due& b) {
    const auto order = [](const Due& due) {
      const Finding& f = *due.finding;
      // A new finding goes before refinements of others, and of those the one that waits longest.
      return std::tuple(255 - f.importance, due.alone, !due.first, due.first ? Time{} : due.since, f.stamp,
                        f.key.id);
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
  FindingPiece piece{params_.robot, static_cast<std::uint32_t>(size()), overflowed_, {}, {}};
  std::vector<Carried>& carried = flights_[++tokens_];
  std::size_t bytes = findings::encoded_head(params_.robot);
  for (const Due& one : waiting) {
    const std::size_t more = findings::encoded_size(*one.finding);
    const findings::Owner& owner = one.finding->key.owner;
    if (!carried.empty() && (one.alone || bytes + more > max_bytes || owner != piece.owner)) continue;
    piece.owner = owner;
    bytes += more;
    piece.findings.push_back(*one.finding);
    carried.push_back({one.finding->key.id, one.finding->revision});
    if (one.alone || carried.size() >= FindingPiece::kMaxFindings) break;
  }
  for (const PeerId& station : peers) {
    const auto peer = peers_.find(station);
    if (peer == peers_.end()) continue;
    for (const auto& [id, revision] : carried)
      if (const auto want = peer->second.wants.find(id); want != peer->second.wants.end())
        if (want->second.flights++ == 0) ++peer->second.flying;
  }
  ++run_;
  return Content{tokens_, findings::encode(piece)};
}

void FindingSource::acknowledged(const PeerId& station, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end()) return;
  for (const auto& [id, revision] : flight->second) {
    if (!finding_store_.all().contains(key(id))) continue;  // Discarded meanwhile.
    known_.add(id, revision, station);
    reported_full_ = false;
    const auto peer = peers_.find(station);
    if (peer == peers_.end()) continue;
    if (revision >= sendable(id).revision) {
      take_from(peer->second, id);
    } else if (const auto want = peer->second.wants.find(id); want != peer->second.wants.end()) {
      want->second.first = false;  // The newer revision is still to come.
      want->second.losses = 0;
    }
  }
}

void FindingSource::lost(const PeerId& station, std::uint64_t token) {
  const auto flight = flights_.find(token);
  const auto peer = peers_.find(station);
  if (flight == flights_.end() || peer == peers_.end()) return;
  for (const auto& [id, revision] : flight->second) {
    const auto entry = peer->second.wants.find(id);
    if (entry == peer->second.wants.end()) continue;
    Want& want = entry->second;
    if (revision == want.revision) {
      if (want.flights == 0 || --want.flights > 0) continue;
      --peer->second.flying;
    }
    // The loss of an older revision counts as well: what a station cannot store goes alone, however often it
    // changes.
    if (want.losses < 255) ++want.losses;
    want.next = home_.now() + pause_after(want.losses);
  }
  rests_until_.reset();
}

}  // namespace adit::agent
