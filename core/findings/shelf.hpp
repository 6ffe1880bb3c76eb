#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "core/exec/executor.hpp"
#include "core/findings/finding.hpp"

namespace adit::findings {

struct ShelfParams {
  std::size_t most{512};  ///< findings, [1, 65536]
  Duration write{3ms};    ///< what a batch takes in rehearsal
  Duration retry{1s};     ///< after a write that failed
};

/// Findings in memory and on disk, a file each, written in batches beside the strand it lives on.
class Shelf {
 public:
  struct Outputs {
    std::function<void(const Key&)> kept{};  ///< it is on disk now
    /// The disk began to fail (with the reason), or works again.
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  /// `disk` null: memory alone. `writer`: a strand for a disk that takes time; null: the executor's pool.
  Shelf(ShelfParams params, std::shared_ptr<store::Disk> disk, Executor& home,
        std::shared_ptr<Executor> writer, Outputs outputs);
  ~Shelf();
  Shelf(const Shelf&) = delete;
  Shelf& operator=(const Shelf&) = delete;

  /// Reads what the disk has, before anything is put. Files that are damaged are removed: their number.
  std::size_t load();
  /// False when it is full, or not valid. One that is there already stays as it is.
  bool put(Finding finding);
  void drop(const Key& key);

  const std::map<Key, Finding>& all() const { return all_; }
  bool full() const { return all_.size() >= params_.most; }
  /// It is on disk, or there is none.
  bool kept(const Key& key) const { return all_.contains(key) && !unsaved_.contains(key); }

 private:
  struct Batch;
  void write();
  void written(const Batch& batch, const Result<void>& result);

  ShelfParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  Outputs outputs_;
  std::map<Key, Finding> all_{};
  std::set<Key> unsaved_{}, dropped_{};  ///< dropped_: their files are still there
  bool writing_{}, failed_{};
  Timer timer_{};
  std::shared_ptr<Shelf*> self_;  ///< what writes under way find; null inside when it is gone
};

}  // namespace adit::findings
