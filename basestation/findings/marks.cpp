// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/marks.hpp"

#include <algorithm>
#include <utility>

#include "core/command/words.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::station {
namespace {

Error wrong_mark(const char* what) { return {Reason::bad_argument, what}; }

}  // namespace

Marks::Marks(std::string station, const findings::Owner& id, std::uint64_t seed, FindingDesk& desk,
             Executor& home)
    : station_(std::move(station)), id_(id), random_(seed), desk_(desk), home_(home) {}

bool Marks::is_own(const findings::Finding& finding) const {
  return finding.key.robot == station_ && findings::marked_by(finding) == id_;
}

Result<void> Marks::add(const Mark& mark, Done done) {
  findings::Finding finding{.kind = mark.kind,
                            .importance = findings::usual_importance(mark.kind),
                            .position = mark.position,
                            .stamp = static_cast<std::uint64_t>(home_.now().time_since_epoch().count()),
                            .text = mark.text,
                            .data = findings::encode_mark(),
                            .photo = mark.photo};
  if (mark.text.size() > findings::Finding::kText) return wrong_mark("the text has more than 128 bytes");
  if (mark.kind == findings::kStairs) return wrong_mark("staircases are measured by robots");
  if (desk_.marks_of(station_, id_) >= kMaxMarks)
    return {Reason::queue_full, "this station has " + std::to_string(kMaxMarks) + " marks already"};
  do {
    finding.key = key_of(random_.next());
  } while (finding.key.id == 0 || desk_.all().contains(finding.key));
  const findings::Key key = finding.key;
  if (auto kept = put(std::move(finding), std::move(done)); !kept) return kept;
  added_[key] = home_.now();
  return {};
}

std::optional<double> Marks::age(const findings::Finding& finding) const {
  const auto added = added_.find(finding.key);
  if (added == added_.end() || !is_own(finding)) return std::nullopt;
  return seconds(home_.now() - added->second);
}

Result<void> Marks::remove(const findings::Key& key, Done done) {
  const auto found = desk_.all().find(key);
  if (found == desk_.all().end() || !is_own(found->second))
    return wrong_mark("only a mark of this station can be removed; `finding N reject` rejects others");
  if (found->second.withdrawn) return wrong_mark("it is withdrawn already");
  findings::Finding mark = found->second;
  ++mark.revision;
  mark.withdrawn = true;
  return put(std::move(mark), std::move(done));
}

Result<void> Marks::put(findings::Finding mark, Done done) {
  if (waiting_.size() >= kMaxWaiting) return {Reason::queue_full, "too many marks wait for the disk"};
  const std::uint64_t number = next_++;
  waiting_[number] = {std::move(done), mark, {}};
  const auto stored = [this, number, alive = std::weak_ptr(alive_)] {
    if (!alive.expired()) end(number, true);
  };
  if (auto kept = desk_.keep(std::move(mark), stored); !kept) {
    waiting_.erase(number);
    return kept;
  }
  if (const auto waits = waiting_.find(number); waits != waiting_.end())
    waits->second.timer = home_.after(kPatience, [this, number] { end(number, false); });
  return {};
}

void Marks::end(std::uint64_t number, bool on_disk) {
  auto ended = waiting_.extract(number);
  if (!ended.empty()) ended.mapped().done(ended.mapped().mark, on_disk);
}

}  // namespace adit::station
