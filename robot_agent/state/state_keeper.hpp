#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/exec/executor.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

struct KeeperParams {
  Duration write{3ms};    ///< what a write takes in rehearsal, [0, 1 s]
  Duration patience{1s};  ///< a write that takes longer holds back no answer any more
  Duration retry{1s};     ///< after a write that failed
  Duration place{1s};     ///< Between two writes of the place of a robot that drives, (0, 1 s].
};

/// Writes the last known safe state, and holds back what must not be said before it is on disk. One write at
/// a time, the newest state next: nothing piles up. Lives on the command strand; the disk is written on
/// another one. A disk that fails, is full or does not answer holds up nothing: everybody is told, and a
/// state that it could not write is taken away, so that no restart believes an old one.
class StateKeeper {
 public:
  struct Outputs {
    /// The disk began to fail (with the reason), or keeps the state again.
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  /// `disk` null: nothing is kept beyond this process. `writer`: where a disk that takes time is written.
  StateKeeper(KeeperParams params, std::shared_ptr<store::Disk> disk, Executor& command,
              std::shared_ptr<Executor> writer, std::uint64_t generation, Outputs outputs);
  ~StateKeeper();
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  /// The state as it is now; written when it differs from the last one given, or when more commands were
  /// accepted than then: one that changed nothing is answered as before after a restart, too; and once a
  /// second while its place changes, which no answer waits for. `answers` is asked then.
  void save(Snapshot state, const std::function<std::vector<KeptAnswers>()>& answers,
            std::uint64_t accepted = 0);
  /// Runs once every state given so far is on disk: at once when it is, or when the disk fails. At most 256
  /// wait: beyond that the first of them is dropped (who sent it repeats).
  void when_safe(Task task);
  /// At a clean end, after the command strand has ended: hands the newest state to the writer's strand when
  /// it is not on disk yet. Nothing without such a strand, so that in rehearsal an end is a crash.
  void flush();
  /// At 20 Hz: patience and retries.
  void tick();

  bool failing() const;
  /// The state given last, with or without a disk; nothing before the first.
  const std::optional<Snapshot>& given() const;

 private:
  struct Writer;
  std::shared_ptr<Writer> writer_;
};

}  // namespace adit::agent
