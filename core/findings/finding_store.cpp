// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_store.hpp"

#include <algorithm>
#include <tuple>

#include "core/store/background.hpp"

namespace adit::findings {
namespace {

constexpr std::size_t kBatch = 16;
constexpr std::size_t kMaxBadFiles = 64;
constexpr const char* kBad = ".bad";

}  // namespace

std::string LoadReport::text() const {
  if (!error.empty()) return error;
  std::string out;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(damaged, "damaged");
  add(newer, "of another version");
  add(unreadable, "unreadable");
  add(surplus, "more than there is room for");
  return out.empty() ? out : "findings on the disk: " + out + "; no file was deleted";
}

/// A batch of writes that runs on another strand; the home strand reads the results afterwards.
struct FindingStore::Batch {
  struct Save {
    Key key{};
    store::Bytes bytes{};
    std::uint32_t revision{};
    std::uint64_t change{};  ///< As of Work.
    bool aside{};            ///< A file of another version has this name: it is renamed first.
  };
  std::vector<Save> save{};
  std::vector<Key> remove{};
  bool ran{};
  std::set<Key> failed{};
  std::string error{};  ///< The first error.

  void run(store::Disk& disk) {
    ran = true;
    for (const Key& key : remove) note(key, disk.remove(file_name(key)));
    for (const Save& s : save) {
      const std::string name = file_name(s.key);
      Result<void> done{};
      if (s.aside && exists(disk, name)) done = disk.rename(name, name + ".aside");
      note(s.key, done ? disk.replace(name, s.bytes) : done);
    }
  }
  static bool exists(const store::Disk& disk, const std::string& name) {
    const auto names = disk.list();
    return !names || std::find(names->begin(), names->end(), name) != names->end();
  }
  void note(const Key& key, const Result<void>& done) {
    if (done) return;
    failed.insert(key);
    if (error.empty()) error = done.error().text;
  }
};

FindingStore::FindingStore(FindingStoreParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                           std::shared_ptr<Executor> writer, Outputs outputs)
    : params_(params),
      disk_(std::move(disk)),
      home_(home),
      writer_(std::move(writer)),
      outputs_(std::move(outputs)),
      self_(std::make_shared<FindingStore*>(this)) {}

FindingStore::~FindingStore() { *self_ = nullptr; }

LoadReport FindingStore::load() {
  LoadReport report{};
  if (!disk_) return report;
  const auto names = disk_->list();
  if (!names) {
    report.error = names.error().text;
    return report;
  }
  bad_files_ = static_cast<std::size_t>(
      std::count_if(names->begin(), names->end(), [](const std::string& n) { return n.ends_with(kBad); }));
  std::vector<Finding> found;
  for (const std::string& name : *names)
    if (is_finding_file(name)) load_file(name, report, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const Finding& a, const Finding& b) { return a.importance > b.importance; });
  for (Finding& finding : found) {
    if (full()) {
      ++report.surplus;
      report.surplus_revision = std::max(report.surplus_revision, finding.revision);
      continue;
    }
    all_.emplace(finding.key, std::move(finding));
  }
  ++changes_;
  return report;
}

void FindingStore::load_file(const std::string& name, LoadReport& report, std::vector<Finding>& found) {
  const auto bytes = disk_->read(name, kMaxFindingFile);
  if (!bytes || !*bytes) {
    ++report.unreadable;
    foreign_.insert(name);
    return;
  }
  FindingFile file = read_finding(**bytes);
  if (file.found == store::LoadStatus::newer || file.found == store::LoadStatus::older) {
    ++report.newer;
    foreign_.insert(name);
    return;
  }
  if (file.finding && file_name(file.finding->key) == name) {
    found.push_back(std::move(*file.finding));
    return;
  }
  ++report.damaged;
  if (bad_files_ < kMaxBadFiles && disk_->rename(name, name + kBad)) ++bad_files_;
}

bool FindingStore::put(Finding finding) {
  if (!valid(finding)) return false;
  const Key key = finding.key;
  const std::uint32_t revision = finding.revision;
  const auto found = all_.find(key);
  if (found != all_.end() && revision <= found->second.revision) return true;
  if (found == all_.end() && full()) return false;
  all_.insert_or_assign(key, std::move(finding));
  ++changes_;
  if (!disk_) {
    outputs_.stored(key, revision);
    return true;
  }
  dropped_.erase(key);
  unsaved_.try_emplace(key, Work{.order = tries_}).first->second.change = changes_;
  write();
  return true;
}

void FindingStore::drop(const Key& key) {
  if (all_.erase(key) == 0) return;
  ++changes_;
  if (!disk_) return;
  unsaved_.erase(key);
  dropped_.emplace(key, Work{.change = changes_, .order = tries_});
  write();
}

void FindingStore::write() {
  if (unsaved_.empty() && dropped_.empty()) return;
  // The retry timer also covers a batch that is lost, for example because its strand's queue is full.
  if (!retry_.active()) retry_ = home_.after(params_.retry, [this] { write(); });
  if (!writing_.expired()) return;
  auto batch = std::make_shared<Batch>();
  // Findings whose last attempt failed come last, so that a file that cannot be written does not delay
  // others. Those that wait longest come first, so that one that changes all the time does not, either.
  const auto first = [](const Pending& pending) {
    std::vector<std::tuple<bool, std::uint64_t, Key>> keys;
    for (const auto& [key, work] : pending) keys.emplace_back(work.failed, work.order, key);
    std::sort(keys.begin(), keys.end());
    keys.resize(std::min(keys.size(), kBatch));
    return keys;
  };
  for (const auto& [failed, order, key] : first(dropped_)) batch->remove.push_back(key);
  for (const auto& [failed, order, key] : first(unsaved_)) add_save(*batch, key);
  writing_ = batch;
  start(batch);
}

void FindingStore::add_save(Batch& batch, const Key& key) const {
  const Finding& finding = all_.at(key);
  batch.save.push_back(
      {key, to_file(finding), finding.revision, unsaved_.at(key).change, foreign_.contains(file_name(key))});
}

void FindingStore::flush() {
  if (!disk_ || disk_->instant() || !writer_ || (unsaved_.empty() && dropped_.empty())) return;
  auto batch = std::make_shared<Batch>();
  for (const auto& [key, work] : dropped_) batch->remove.push_back(key);
  std::vector<const Finding*> left;
  for (const auto& [key, work] : unsaved_) left.push_back(&all_.at(key));
  std::stable_sort(left.begin(), left.end(),
                   [](const Finding* a, const Finding* b) { return a->importance > b->importance; });
  for (const Finding* finding : left) add_save(*batch, finding->key);
  writer_->post([disk = disk_, batch] { batch->run(*disk); });
}

void FindingStore::start(const std::shared_ptr<Batch>& batch) {
  const auto back = [self = self_, batch] {
    if (*self) (*self)->written(*batch);
  };
  modelled_ = store::run_in_background(
      *disk_, home_, writer_, {.name = "findings", .modelled = params_.write, .pool = PoolKind::io},
      [disk = disk_, batch] { batch->run(*disk); }, back);
}

void FindingStore::written(const Batch& batch) {
  writing_.reset();
  if (!batch.ran) return;  // The batch was dropped; the retry timer still runs.
  ++tries_;
  std::vector<std::pair<Key, std::uint32_t>> saved;
  for (const Key& key : batch.remove) {
    const auto entry = dropped_.find(key);
    if (entry == dropped_.end()) continue;
    if (batch.failed.contains(key))
      entry->second.failed = true, entry->second.order = tries_;
    else
      dropped_.erase(entry);
  }
  for (const Batch::Save& s : batch.save) {
    const auto entry = unsaved_.find(s.key);
    if (!batch.failed.contains(s.key)) foreign_.erase(file_name(s.key));
    if (entry == unsaved_.end()) continue;  // Removed from the store meanwhile.
    Work& work = entry->second;
    work.failed = batch.failed.contains(s.key);
    work.order = tries_;
    if (work.failed) continue;
    saved.emplace_back(s.key, s.revision);
    if (work.change == s.change) unsaved_.erase(entry);  // Else it was changed meanwhile.
  }
  const auto failed = [](const Pending& pending) {
    return std::any_of(pending.begin(), pending.end(), [](const auto& entry) { return entry.second.failed; });
  };
  const bool failing = failed(unsaved_) || failed(dropped_);
  if (failing != failing_ && (!failing || !batch.error.empty())) {
    failing_ = failing;
    outputs_.failing(failing, failing ? batch.error : "findings are stored again");
  }
  for (const auto& [key, revision] : saved) outputs_.stored(key, revision);
  // When nothing of the batch could be written, the retry timer decides.
  if (batch.failed.size() < batch.save.size() + batch.remove.size()) write();
}

}  // namespace adit::findings
