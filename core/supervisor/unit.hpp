#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/component/component.hpp"
#include "core/component/fault.hpp"
#include "core/supervisor/restart_policy_engine.hpp"

namespace adit {

/// A strand and what lives on it.
struct ComponentSlot {
  ComponentSlot() = default;
  ComponentSlot(const ComponentSlot&) = delete;
  ComponentSlot& operator=(const ComponentSlot&) = delete;
  ~ComponentSlot();
  std::shared_ptr<Strand> strand{};
  std::unique_ptr<Component> component{};  ///< touched on the strand only, or after its end
  /// Of the strand: what writes from it or delivers to it counts while that is valid.
  std::shared_ptr<Generation> generation{std::make_shared<Generation>()};
  std::shared_ptr<void> io{};  ///< what delivers to the strand; dropped before it
};

/// Slots whose task hangs: kept, for it may still use them, until their unit goes.
struct LeftBehind {
  LeftBehind() = default;
  LeftBehind(const LeftBehind&) = delete;
  LeftBehind& operator=(const LeftBehind&) = delete;
  ~LeftBehind();
  std::vector<std::shared_ptr<ComponentSlot>> slots{};
};

struct UnitParams {
  std::string name{};
  bool dedicated{false};  ///< lives on a Runtime::dedicated_strand
  /// Makes an instance; on the strand.
  std::function<Result<std::unique_ptr<Component>>(Executor& strand)> make{};
  /// Made with each strand, before its first instance; nothing when null. Hold the slot weakly, and bind
  /// writers and readers to its generation (wire::ComponentIo), which is revoked when the strand is left
  /// behind.
  std::function<Result<std::shared_ptr<void>>(const std::shared_ptr<ComponentSlot>& slot)> open_io{};
};

/// A component that can be made anew: on its strand when it failed, on another one when it hangs. What an
/// instance hands to other strands counts only while its generation is valid. An exception that leaves a
/// callback of the component ends that instance on the spot.
///
/// restart(), replace(), revoke() and abandon() are the supervisor's, on its strand; the rest is for any
/// thread.
class Unit {
 public:
  Unit(Runtime& runtime, UnitParams params);
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  const std::string& name() const { return params_.name; }
  /// Makes the first strand. Errors of `open_io`.
  Result<void> open();
  /// Called from the strand when an instance came up or failed; set before the first restart().
  void on_change(std::function<void()> changed) { changed_ = std::move(changed); }

  void restart();
  void replace();
  /// What the instance hands out no longer counts, nor does what its strand writes and reads.
  void revoke();
  /// Revokes an instance that hangs and leaves its strand behind: queued tasks are dropped, posts refused.
  void abandon();
  /// Ends the strand: nothing of this component runs any more.
  void end();

  HealthSample health_sample() const;
  /// The strand and what lives on it now; rises with each restart: instance().
  std::shared_ptr<ComponentSlot> slot() const;
  std::uint64_t instance() const { return instance_.load(std::memory_order_acquire); }
  /// Has the component throw, or hang, in a callback of its own.
  void inject(ComponentFault fault);

 private:
  /// What an instance reports to the supervisor.
  struct Record {
    std::mutex mutex{};
    std::shared_ptr<const HealthState> health_state{};
    bool failed{};
    std::string text{};
    std::shared_ptr<Generation> generation{std::make_shared<Generation>()};
  };
  void report_failure(Record& record, const std::string& text) const;
  void begin(ComponentSlot& slot, const std::shared_ptr<Record>& record);

  Runtime& runtime_;
  UnitParams params_;
  std::function<void()> changed_{};
  std::atomic<std::uint64_t> instance_{0};
  mutable std::mutex mutex_{};  // guards the two pointers
  std::shared_ptr<ComponentSlot> slot_{};
  std::shared_ptr<Record> record_{std::make_shared<Record>()};
  LeftBehind left_behind_{};  // bounded by SupervisionParams::hangs
};

}  // namespace adit
