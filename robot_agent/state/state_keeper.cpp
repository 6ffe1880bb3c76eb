// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/state_keeper.hpp"

#include <cmath>

#include "robot_agent/state/restored.hpp"

namespace adit::agent {
namespace {

constexpr std::size_t kWaiting = 256;

/// Writes the state, not on the command strand, one write at a time. After a failed write the old file is
/// removed, because an outdated state would be a guess.
Result<void> write(const std::shared_ptr<store::Disk>& disk, std::uint64_t generation,
                   const store::Bytes& payload, bool mark) {
  Result<void> done{};
  if (mark) done = disk->replace(kMarkerFile, {});
  if (done) done = store::StateFile(disk, kStateFile, kSnapshotFormat).save(generation, payload);
  if (!done) (void)disk->remove(kStateFile);  // Only the first error is reported.
  return done;
}

}  // namespace

/// Shared with the pending writes, which outlive the keeper when its component ends.
struct StateKeeper::Writer : std::enable_shared_from_this<StateKeeper::Writer> {
  KeeperParams params;
  std::shared_ptr<store::Disk> disk;
  Executor& command;
  std::shared_ptr<Executor> strand;
  Outputs outputs;

  std::optional<Snapshot> state{};         ///< The last state passed.
  std::uint64_t needed{};                  ///< Generation that last changed the state: answers wait for it.
  std::uint64_t accepted{};                // Commands accepted when that state was queued.
  std::optional<store::Bytes> next{};      ///< Not being written yet.
  std::uint64_t asked{}, done{};           ///< Generations: passed, and written or failed.
  std::optional<std::uint64_t> writing{};  ///< Generation of the pending write.
  Time since{};                            ///< Start of the pending write, or of the last one.
  std::optional<StoredFrames> placed{};    // Place in the last state queued for writing.
  Time placed_at{};
  bool marked{}, failed{}, stuck{};
  std::optional<Time> retry{};
  std::deque<std::pair<std::uint64_t, Task>> waiting{};
  Timer modelled{};

  Writer(KeeperParams p, std::shared_ptr<store::Disk> d, Executor& c, std::shared_ptr<Executor> s, Outputs o)
      : params(p), disk(std::move(d)), command(c), strand(std::move(s)), outputs(std::move(o)) {}

  /// Whether a restart would compare the odometry with a place that the robot has left.
  bool place_due(const Snapshot& now) const {
    constexpr double kMoved = 0.05, kTurned = 0.05;  // In m and rad.
    if (!now.place || !now.place->newest || command.now() - placed_at < params.place) return false;
    if (!placed || !placed->newest) return true;
    const Pose3 &a = placed->newest->T_odom_base, &b = now.place->newest->T_odom_base;
    return (b.position - a.position).norm() > kMoved || std::fabs(wrap_angle(b.yaw() - a.yaw())) > kTurned;
  }

  void start() {
    if (writing || !next) return;
    writing = asked;
    since = command.now();
    retry.reset();
    auto bytes = std::make_shared<store::Bytes>(std::move(*next));
    next.reset();
    const auto work = [disk = disk, bytes, generation = asked, mark = !marked] {
      return write(disk, generation, *bytes, mark);
    };
    const std::weak_ptr<Writer> back = weak_from_this();
    if (disk->instant() || !strand) {
      modelled = command.after(params.write, [back, work, bytes] {
        if (const auto self = back.lock()) self->finished(work(), *bytes);
      });
    } else {
      const bool taken = strand->post([back, work, bytes, to = command.inbox()] {
        auto result = std::make_shared<Result<void>>(work());
        if (back.expired()) return;
        to->post_control([back, result, bytes] {
          if (const auto self = back.lock()) self->finished(*result, *bytes);
        });
      });
      if (!taken) finished(Error{Reason::queue_full, "the disk's queue is full"}, *bytes);
    }
  }

  void finished(const Result<void>& result, const store::Bytes& bytes) {
    done = writing.value_or(done);
    writing.reset();
    stuck = false;
    if (result) {
      marked = true;
      set_failed(false, "the state is kept again");
    } else {
      set_failed(true, result.error().text);
    }
    release(done);
    // A newer state is written at once, whether this write succeeded or not, because answers wait for it.
    if (next) return start();
    if (result) return;
    next = bytes;
    retry = command.now() + params.retry;
  }

  void set_failed(bool now_failing, const std::string& text) {
    if (failed == now_failing) return;
    failed = now_failing;
    outputs.failing(failed, text);
  }

  void release(std::uint64_t up_to) {
    while (!waiting.empty() && waiting.front().first <= up_to) {
      const Task task = std::move(waiting.front().second);
      waiting.pop_front();
      task();
    }
  }

  void tick() {
    const Time now = command.now();
    if (writing && !stuck && now - since >= params.patience) {
      stuck = true;
      set_failed(true, disk->where() + " does not answer");
      release(asked);
    }
    if (retry && now >= *retry) start();
  }
};

StateKeeper::StateKeeper(KeeperParams params, std::shared_ptr<store::Disk> disk, Executor& command,
                         std::shared_ptr<Executor> writer, std::uint64_t generation, Outputs outputs)
    : writer_(
          std::make_shared<Writer>(params, std::move(disk), command, std::move(writer), std::move(outputs))) {
  writer_->asked = writer_->done = writer_->needed = generation;
  writer_->since = command.now();
}

StateKeeper::~StateKeeper() = default;

void StateKeeper::save(Snapshot state, const std::function<std::vector<StoredAnswers>()>& answers,
                       std::uint64_t accepted) {
  Writer& w = *writer_;
  const bool same = w.state && w.state->same_state(state);
  if (same && w.accepted == accepted && !w.place_due(state)) {
    w.state->place = state.place;
    return;
  }
  w.placed = state.place;
  w.placed_at = w.command.now();
  w.accepted = accepted;
  state.answers = answers();
  w.state = std::move(state);
  if (!w.disk) return;
  w.next = encode(*w.state);
  ++w.asked;
  if (!same) w.needed = w.asked;
  w.start();
}

void StateKeeper::when_safe(Task task) {
  Writer& w = *writer_;
  if (w.done >= w.needed || w.stuck) return task();
  if (w.waiting.size() >= kWaiting) w.waiting.pop_front();
  w.waiting.emplace_back(w.needed, std::move(task));
}

void StateKeeper::flush() {
  Writer& w = *writer_;
  if (!w.disk || w.disk->instant() || !w.strand || !w.next) return;
  w.strand->post([disk = w.disk, bytes = std::move(*w.next), generation = w.asked, mark = !w.marked] {
    (void)write(disk, generation, bytes, mark);  // The last write: no strand is left to report an error to.
  });
  w.next.reset();
}

void StateKeeper::tick() { writer_->tick(); }
bool StateKeeper::failing() const { return writer_->failed; }
const std::optional<Snapshot>& StateKeeper::given() const { return writer_->state; }

}  // namespace adit::agent
