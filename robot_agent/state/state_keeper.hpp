// SPDX-License-Identifier: Apache-2.0
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
  Duration write{3ms};    ///< Duration of a write in rehearsal, [0, 1 s].
  Duration patience{1s};  ///< A write that takes longer no longer delays answers.
  Duration retry{1s};     ///< Pause after a failed write.
  Duration place{1s};     ///< Between two writes of the place of a robot that drives, (0, 1 s].
};

/// Writes the last known safe state, and delays answers until the state that they report is on disk. There is
/// one write at a time, and the newest state is next, so that no writes accumulate. Runs on the command
/// strand; the disk is written on another one. A disk that fails, is full or does not answer delays nothing:
/// operators are notified, and the old state file is removed, so that no restart uses an outdated state.
class StateKeeper {
 public:
  struct Outputs {
    /// Reports that the disk began to fail (with the reason), or stores the state again.
    std::function<void(bool failing, const std::string& text)> failing{};
  };

  /// `disk` null: nothing survives this process. `writer`: strand on which a slow disk is written.
  StateKeeper(KeeperParams params, std::shared_ptr<store::Disk> disk, Executor& command,
              std::shared_ptr<Executor> writer, std::uint64_t generation, Outputs outputs);
  ~StateKeeper();
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  /// Passes the present state. It is written if it differs from the last one passed, or if further commands
  /// were accepted, because their answers must survive a restart even if they changed nothing. While only the
  /// place changes, it is written once a second, and no answer waits for that write. `answers` is called only
  /// for a write.
  void save(Snapshot state, const std::function<std::vector<StoredAnswers>()>& answers,
            std::uint64_t accepted = 0);
  /// Runs `task` once every state passed so far is on disk; at once if it already is, or if the disk fails.
  /// At most 256 tasks are queued: beyond that the oldest is dropped, and the station repeats its command.
  void when_safe(Task task);
  /// Hands the newest state to the writer's strand if it is not on disk yet, at a clean end after the command
  /// strand has ended. Does nothing without such a strand, so that in rehearsal an end is a crash.
  void flush();
  /// Checks timeouts and retries. Call it at 20 Hz.
  void tick();

  bool failing() const;
  /// The last state passed, with or without a disk; unset before the first.
  const std::optional<Snapshot>& given() const;

 private:
  struct Writer;
  std::shared_ptr<Writer> writer_;
};

}  // namespace adit::agent
