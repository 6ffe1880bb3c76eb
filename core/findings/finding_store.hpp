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

struct FindingStoreParams {
  std::size_t max_findings{512};  ///< findings, [1, 65536]
  Duration write{3ms};            ///< what a batch takes in rehearsal
  Duration retry{1s};             ///< after a batch of which nothing could be written
};

/// What load() could not use. No file is deleted: a damaged one is renamed to NAME.bad (at most 64 of them,
/// the others stay), the rest stay as they are.
struct LoadReport {
  std::size_t damaged{};     ///< torn, corrupt, or under the name of another finding
  std::size_t newer{};       ///< of another version of this program
  std::size_t unreadable{};  ///< refused by the disk: perhaps readable at the next start
  std::size_t surplus{};     ///< beyond FindingStoreParams::max_findings; the most important ones are loaded
  std::string error{};       ///< the folder cannot be listed; empty when it can
  bool operator==(const LoadReport&) const = default;
  /// For operators; empty when everything was loaded.
  std::string text() const;
};

/// Findings in memory and on disk, a file each, written in batches beside the strand it lives on.
class FindingStore {
 public:
  struct Outputs {
    std::function<void(const Key&)> kept{};  ///< it is on disk now
    /// The disk began to fail (with the reason), or works again.
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  /// `disk` null: memory alone. `writer`: a strand for a disk that takes time; null: the executor's pool.
  FindingStore(FindingStoreParams params, std::shared_ptr<store::Disk> disk, Executor& home,
               std::shared_ptr<Executor> writer, Outputs outputs);
  ~FindingStore();
  FindingStore(const FindingStore&) = delete;
  FindingStore& operator=(const FindingStore&) = delete;

  /// Reads what the disk has, before anything is put.
  LoadReport load();
  /// False when it is full, or not valid. One that is there already stays as it is.
  bool put(Finding finding);
  void drop(const Key& key);
  /// At a clean end, after the home strand has ended: hands all that is not on disk yet to the writer's
  /// strand, the most important first. Nothing without such a strand, so that in rehearsal an end is a crash.
  void flush();

  const std::map<Key, Finding>& all() const { return all_; }
  bool full() const { return all_.size() >= params_.max_findings; }
  /// It is on disk, or there is none.
  bool kept(const Key& key) const { return all_.contains(key) && !unsaved_.contains(key); }

 private:
  struct Batch;
  /// Keys whose file has to be written or removed, with the number of the last try that failed; 0: none yet.
  using Pending = std::map<Key, std::uint64_t>;

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
  Pending unsaved_{}, dropped_{};  ///< dropped_: their files are still there
  std::set<std::string>
      foreign_{};  ///< files that load() left: renamed to NAME.aside before a finding takes the name
  std::size_t bad_files_{};
  std::uint64_t tries_{};
  /// The batch under way. It expires when it was written, and also when the strand or the pool dropped it.
  std::weak_ptr<Batch> writing_{};
  bool failing_{};
  Timer modelled_{}, retry_{};
  std::shared_ptr<FindingStore*> self_;  ///< what writes under way find; null inside when it is gone
};

}  // namespace adit::findings
