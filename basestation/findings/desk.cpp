// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/desk.hpp"

#include <algorithm>

#include "core/findings/finding_piece.hpp"

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
  if (!robots_.contains(robot) && robots_.size() >= kRobots)
    return {Reason::queue_full, "no room for one more robot's findings"};
  robots_[robot] = {piece->stored, piece->overflowed};
  bool fits = true;
  Waiting waiting{{}, std::move(stored)};
  for (findings::Finding& finding : piece->findings) {
    const findings::Key key = finding.key;
    const std::uint32_t revision = finding.revision;
    const auto found = finding_store_.all().find(key);
    const bool is_new = found == finding_store_.all().end();
    const bool is_newer = !is_new && found->second.revision < revision;
    if (!finding_store_.put(std::move(finding))) {
      fits = false;
      continue;
    }
    if (!finding_store_.is_stored(key)) {
      std::uint32_t& wanted = waiting.revisions[key];
      wanted = std::max(wanted, revision);
    }
    if (is_new) outputs_.found(finding_store_.all().at(key));
    if (is_newer && outputs_.changed) outputs_.changed(finding_store_.all().at(key));
  }
  if (!fits) {
    if (!reported_full_)
      outputs_.trouble("findings_full", "no room for more findings here; " + robot + " keeps its own");
    reported_full_ = true;
    return {Reason::queue_full, "no room for more findings"};
  }
  if (waiting.revisions.empty()) {
    waiting.stored();  // They were stored before, and that acknowledgement was lost.
    return {};
  }
  // What is forgotten here comes again, and is acknowledged then.
  if (waiting_.size() >= kMaxPieces) waiting_.pop_front();
  waiting_.push_back(std::move(waiting));
  return {};
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
