// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/desk.hpp"

#include <algorithm>
#include <optional>

#include "core/findings/finding_piece.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::station {
namespace {

constexpr std::size_t kRobots = 64;

}  // namespace

FindingDesk::FindingDesk(DeskParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                         Outputs outputs)
    : outputs_(std::move(outputs)),
      finding_store_({.max_findings = params.max_findings}, std::move(disk), home, nullptr,
                     {[this](const findings::Key& key, std::uint32_t revision) { on_stored(key, revision); },
                      [this](bool failing, const std::string& text) {
                        outputs_.trouble(failing ? "store_failing" : "store_works", text);
                      }}) {}

Result<void> FindingDesk::hear(const std::string& robot, std::span<const std::uint8_t> bytes,
                               std::function<void()> stored) {
  auto piece = findings::decode_piece(bytes);
  if (!piece) return piece.error();
  if (piece->robot != robot) return {Reason::malformed, "findings of another robot"};
  if (std::ranges::any_of(piece->findings, [this](const findings::Finding& f) { return touches_mark(f); }))
    return {Reason::malformed, "a robot's piece with marks of an operator"};
  return take(std::move(*piece), std::move(stored));
}

Result<void> FindingDesk::hear_station(const std::string& station, const findings::Owner& id,
                                       std::span<const std::uint8_t> bytes, std::function<void()> stored) {
  auto piece = findings::decode_piece(bytes);
  if (!piece) return piece.error();
  if (piece->robot != station) return {Reason::malformed, "findings of another station"};
  std::size_t marks = marks_of(station, id), of_all = marks_of_all();
  for (const findings::Finding& finding : piece->findings) {
    const auto known = finding_store_.all().find(finding.key);
    const bool is_new = known == finding_store_.all().end();
    if (findings::marked_by(finding) != id || finding.kind == findings::kStairs ||
        (!is_new && findings::marked_by(known->second) != id))
      return {Reason::malformed, "what is no mark of that station"};
    marks += is_new ? 1 : 0;
    of_all += is_new ? 1 : 0;
  }
  if (marks > kMaxMarks) return {Reason::queue_full, "no room for more marks of that station"};
  if (of_all > kMarksOfAll) return {Reason::queue_full, "no room for more marks of other stations"};
  return take(std::move(*piece), std::move(stored));
}

std::size_t FindingDesk::marks_of(const std::string& station, const findings::Owner& id) const {
  std::size_t count = 0;
  for (auto at = finding_store_.all().lower_bound({station, 0});
       at != finding_store_.all().end() && at->first.robot == station; ++at)
    count += findings::marked_by(at->second) == id ? 1 : 0;
  return count;
}

std::size_t FindingDesk::marks_of_all() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      finding_store_.all(), [](const auto& entry) { return findings::marked_by(entry.second).has_value(); }));
}

Result<void> FindingDesk::take(findings::FindingPiece piece, std::function<void()> stored) {
  const std::string& from = piece.robot;
  if (!robots_.contains(from) && robots_.size() >= kRobots)
    return {Reason::queue_full, "no room for one more robot's findings"};
  robots_[from] = {piece.stored, piece.overflowed};
  bool fits = true;
  Waiting waiting{{}, std::move(stored)};
  for (findings::Finding& finding : piece.findings) fits = take(std::move(finding), waiting) && fits;
  if (!fits) {
    if (!reported_full_)
      outputs_.trouble("findings_full", "no room for more findings here; " + from + " keeps its own");
    reported_full_ = true;
    return {Reason::queue_full, "no room for more findings"};
  }
  wait(std::move(waiting));
  return {};
}

Result<void> FindingDesk::keep(findings::Finding finding, std::function<void()> stored) {
  if (!findings::valid(finding)) return {Reason::bad_argument, "no valid finding"};
  Waiting waiting{{}, std::move(stored)};
  if (!take(std::move(finding), waiting)) return {Reason::queue_full, "no room for more findings"};
  wait(std::move(waiting));
  return {};
}

bool FindingDesk::take(findings::Finding finding, Waiting& waiting) {
  const findings::Key key = finding.key;
  const std::uint32_t revision = finding.revision;
  const auto found = finding_store_.all().find(key);
  const bool is_new = found == finding_store_.all().end();
  std::optional<findings::Finding> before;
  if (!is_new && found->second.revision < revision) before = found->second;
  if (!finding_store_.put(std::move(finding))) return false;
  if (!finding_store_.is_stored(key)) {
    std::uint32_t& wanted = waiting.revisions[key];
    wanted = std::max(wanted, revision);
  }
  if (is_new) outputs_.found(finding_store_.all().at(key));
  if (before && outputs_.changed) outputs_.changed(*before, finding_store_.all().at(key));
  return true;
}

void FindingDesk::wait(Waiting waiting) {
  if (waiting.revisions.empty()) {
    waiting.stored();  // They were stored before, and that acknowledgement was lost.
    return;
  }
  // What is forgotten here comes again, and is acknowledged then.
  if (waiting_.size() >= kMaxPieces) waiting_.pop_front();
  waiting_.push_back(std::move(waiting));
}

/// A robot may have the name of a station: its findings replace none of the station's.
bool FindingDesk::touches_mark(const findings::Finding& finding) const {
  const auto known = finding_store_.all().find(finding.key);
  return findings::marked_by(finding) ||
         (known != finding_store_.all().end() && findings::marked_by(known->second));
}

void FindingDesk::on_stored(const findings::Key& key, std::uint32_t revision) {
  for (Waiting& piece : waiting_) {
    const auto wanted = piece.revisions.find(key);
    if (wanted == piece.revisions.end() || wanted->second > revision) continue;
    piece.revisions.erase(wanted);
    if (piece.revisions.empty()) piece.stored();
  }
  std::erase_if(waiting_, [](const Waiting& piece) { return piece.revisions.empty(); });
}

}  // namespace adit::station
