// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/findings/finding.hpp"

namespace adit::findings {

/// Parameters of FindingStore.
struct FindingStoreParams {
  std::size_t max_findings{512};  ///< Largest number of findings, [1, 65536].
  Duration write{3ms};            ///< Duration of a batch in rehearsal.
  Duration retry{1s};             ///< Delay after a batch of which nothing could be written.
};

/// Files that load() could not use. No file is deleted: a damaged one is renamed to NAME.bad (at most 64 of
/// them; further ones are not renamed), the others stay unchanged.
struct LoadReport {
  std::size_t damaged{};     ///< Truncated, corrupt, or under the name of another finding.
  std::size_t newer{};       ///< Written by another version of this program.
  std::size_t unreadable{};  ///< Refused by the disk: perhaps readable at the next start.
  std::size_t surplus{};     ///< Beyond FindingStoreParams::max_findings; the most important ones are loaded.
  std::uint32_t surplus_revision{};  ///< The highest of those.
  std::string error{};               ///< Error when the folder cannot be listed; else empty.
  bool operator==(const LoadReport&) const = default;
  /// Text for operators; empty when everything was loaded.
  std::string text() const;
};

/// Stores findings in memory and on disk, one file each, written in batches in parallel to the home strand.
class FindingStore {
 public:
  /// Callbacks of the store, on its strand.
  struct Outputs {
    /// Called when this revision of a finding is on disk. A newer one may have been put meanwhile.
    std::function<void(const Key&, std::uint32_t revision)> stored{};
    /// Called when the disk begins to fail (with the reason), or works again.
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  /// `disk` null: memory only. `writer`: a strand for a disk whose writes take time; null: the executor's
  /// pool.
  FindingStore(FindingStoreParams params, std::shared_ptr<store::Disk> disk, Executor& home,
               std::shared_ptr<Executor> writer, Outputs outputs);
  ~FindingStore();
  FindingStore(const FindingStore&) = delete;
  FindingStore& operator=(const FindingStore&) = delete;

  /// Loads the findings on the disk; call it before put().
  LoadReport load();
  /// Adds a finding, or replaces an older revision of it. One of the same or of a newer revision stays
  /// unchanged. Returns false when the finding is not valid, or is a new one and the store is full.
  bool put(Finding finding);
  void drop(const Key& key);
  /// Passes all findings that are not on disk yet to the writer's strand, the most important first. Called at
  /// a clean end, after the home strand has ended. Without a writer's strand it does nothing, so that in
  /// rehearsal every end is a crash.
  void flush();

  const std::map<Key, Finding>& all() const { return all_; }
  /// Rises with each change of all().
  std::uint64_t changes() const { return changes_; }
  bool full() const { return all_.size() >= params_.max_findings; }
  /// Whether the finding is on disk in its newest revision.
  bool is_stored(const Key& key) const { return all_.contains(key) && !unsaved_.contains(key); }

 private:
  struct Batch;
  /// A file that must be written or removed.
  struct Work {
    std::uint64_t change{};  ///< Number of the put() or drop() that made it necessary.
    bool failed{};           ///< The last attempt failed.
    std::uint64_t order{};   ///< Batches that were written before it was put, or failed; those go first.
  };
  using Pending = std::map<Key, Work>;

  void load_file(const std::string& name, LoadReport& report, std::vector<Finding>& found);
  void write();
  void add_save(Batch& batch, const Key& key) const;
  void start(const std::shared_ptr<Batch>& batch);
  void written(const Batch& batch);

  FindingStoreParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  Outputs outputs_;
  std::map<Key, Finding> all_{};
  Pending unsaved_{}, dropped_{};  ///< For `dropped_`, the files still exist.
  /// Files that load() did not use: renamed to NAME.aside before a finding takes the name.
  std::set<std::string> foreign_{};
  std::size_t bad_files_{};
  std::uint64_t tries_{}, changes_{};
  /// The running batch. It expires when it is written, and also when the strand or the pool drops it.
  std::weak_ptr<Batch> writing_{};
  bool failing_{};
  Timer modelled_{}, retry_{};
  /// Running batches use it to find the store; null inside when the store is gone.
  std::shared_ptr<FindingStore*> self_;
};

}  // namespace adit::findings
