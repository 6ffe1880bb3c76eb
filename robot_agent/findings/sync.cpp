// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/sync.hpp"

#include <algorithm>
#include <utility>

#include "core/store/pack.hpp"
#include "core/store/preserve.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

using findings::Finding;

constexpr const char* kTracksFile = "findings-known";
constexpr store::StateFormat kTracksFormat{{'F', 'A', 'C', 'K'}, 1, 512 * 1024};
constexpr Duration kTracksPeriod = 5s;  // If the last write is lost, its findings are only sent once more.

}  // namespace

FindingSync::FindingSync(SyncParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                         std::shared_ptr<Executor> writer, Outputs outputs)
    : params_(std::move(params)),
      disk_(disk),
      home_(home),
      writer_(writer),
      outputs_(std::move(outputs)),
      random_(params_.seed),
      finding_store_({.max_findings = params_.max_findings}, std::move(disk), home, std::move(writer),
                     {[](const findings::Key&) {}, outputs_.failing}) {}

findings::LoadReport FindingSync::load() {
  findings::LoadReport report = finding_store_.load();
  if (!disk_) return report;
  const store::State state = store::StateFile(disk_, kTracksFile, kTracksFormat).load();
  // Without the file every finding is sent once more, which harms no station.
  if (state.found != store::LoadStatus::good) {
    if (state.found != store::LoadStatus::nothing)
      (void)store::set_aside(*disk_, kTracksFile, store::name(state.found));
    return report;
  }
  store::Unpacker in(state.payload);
  for (std::size_t left = in.count(65535); left > 0 && in.good(); --left) {
    const auto id = in.get<std::uint64_t>();
    std::vector<StationId> has;
    for (std::size_t stations = in.count(kStations); stations > 0 && in.good(); --stations)
      has.push_back(in.array<16>());
    if (in.good() && finding_store_.all().contains({params_.robot, id})) track(id).has = std::move(has);
  }
  return report;
}

Result<std::uint64_t> FindingSync::report(Finding finding) {
  finding.key.robot = params_.robot;
  while (finding.key.id == 0) finding.key.id = random_.next();
  if (!findings::valid(finding))
    return {Reason::bad_argument, "a finding needs a kind, a place, and fits its bounds"};
  const std::uint64_t id = finding.key.id;
  if (finding_store_.all().contains(finding.key)) return id;
  if (finding_store_.full() && !make_room(finding.importance))
    return {Reason::queue_full, "no room for one more finding"};
  (void)finding_store_.put(std::move(finding));  // It is valid, and there is room.
  return id;
}

bool FindingSync::make_room(std::uint8_t importance) {
  const Finding* least = nullptr;  // The least important one; findings that a station has go first.
  bool least_known = false;
  for (const auto& [key, finding] : finding_store_.all()) {
    const auto found = tracks_.find(key.id);
    const bool known = found != tracks_.end() && !found->second.has.empty();
    if (least && (least_known != known ? least_known : least->importance <= finding.importance)) continue;
    least = &finding;
    least_known = known;
  }
  const bool give_up = least && (least_known || least->importance < importance);
  if (!least_known) {
    ++overflowed_;
    if (!told_full_)
      outputs_.full(std::to_string(params_.max_findings) + " findings are kept, there is no room for more");
    told_full_ = true;
  }
  if (!give_up) return false;
  const findings::Key key = least->key;
  tracks_.erase(key.id);
  finding_store_.drop(key);
  return true;
}

void FindingSync::acknowledged(const StationId& station, std::span<const std::uint64_t> ids, Time now) {
  for (const std::uint64_t id : ids) {
    if (!finding_store_.all().contains({params_.robot, id})) continue;
    Track& t = track(id);
    if (std::find(t.has.begin(), t.has.end(), station) != t.has.end()) continue;
    if (t.has.size() >= kStations) t.has.erase(t.has.begin());
    t.has.push_back(station);
    tracks_changed_ = true;
    told_full_ = false;
  }
  save_tracks(now);
}

std::vector<const Finding*> FindingSync::due(const std::vector<StationId>& heard, Time now) {
  save_tracks(now);
  std::vector<const Finding*> out;
  const auto contains = [](const std::vector<StationId>& set, const StationId& s) {
    return std::find(set.begin(), set.end(), s) != set.end();
  };
  // A station that is heard again gets its findings at once: the pauses had grown while its link was bad.
  const std::vector<StationId> before_this = std::exchange(heard_, heard);
  if (heard.empty()) return out;
  const bool anew =
      std::any_of(heard.begin(), heard.end(), [&](const StationId& s) { return !contains(before_this, s); });
  for (const auto& [key, finding] : finding_store_.all()) {
    Track& t = track(key.id);
    const bool wanted =
        std::any_of(heard.begin(), heard.end(), [&](const StationId& s) { return !contains(t.has, s); });
    if (anew && wanted) {
      t.next = now;
      t.pause = {};
    }
    if (wanted && now >= t.next) out.push_back(&finding);
  }
  const auto before = [this](const Finding* a, const Finding* b) {
    return a->importance != b->importance ? a->importance > b->importance
                                          : tracks_[a->key.id].next < tracks_[b->key.id].next;
  };
  std::stable_sort(out.begin(), out.end(), before);
  if (out.size() > params_.in_a_round) out.resize(params_.in_a_round);
  for (const Finding* f : out) {
    Track& t = track(f->key.id);
    t.pause = t.pause == Duration{0} ? params_.repeat : std::min(2 * t.pause, params_.slowest);
    t.next = now + t.pause;
  }
  return out;
}

void FindingSync::save_tracks(Time now) {
  if (!disk_ || !tracks_changed_ || now - tracks_saved_ < kTracksPeriod) return;
  tracks_changed_ = false;
  tracks_saved_ = now;
  store::Packer out;
  std::uint16_t count = 0;
  for (const auto& [id, t] : tracks_) count = static_cast<std::uint16_t>(count + (t.has.empty() ? 0 : 1));
  out.put(count);
  for (const auto& [id, t] : tracks_) {
    if (t.has.empty()) continue;
    out.put(id).put(static_cast<std::uint16_t>(t.has.size()));
    for (const StationId& station : t.has) out.put(station);
  }
  // If this write is lost, its findings are only sent once more.
  const auto save = [file = store::StateFile(disk_, kTracksFile, kTracksFormat), bytes = out.bytes()] {
    (void)file.save(1, bytes);
  };
  if (disk_->instant())
    timer_ = home_.after(3ms, save);
  else if (writer_)
    writer_->post(save);
  else
    home_.compute({.name = "findings' tracks", .modelled = 3ms, .pool = PoolKind::io}, save,
                  [](const Result<void>&) {});
}

}  // namespace adit::agent
