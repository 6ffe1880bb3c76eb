// SPDX-License-Identifier: Apache-2.0
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

/// A strand with its component and its endpoints.
struct ComponentSlot {
  ComponentSlot() = default;
  ComponentSlot(const ComponentSlot&) = delete;
  ComponentSlot& operator=(const ComponentSlot&) = delete;
  ~ComponentSlot();
  std::shared_ptr<Strand> strand{};
  std::unique_ptr<Component> component{};  ///< Accessed only on the strand, or after its end.
  /// Generation of the strand: writes from it and deliveries to it count only while this is valid.
  std::shared_ptr<Generation> generation{std::make_shared<Generation>()};
  std::shared_ptr<void> io{};  ///< Endpoints that deliver to the strand; destroyed before it.
};

/// Slots whose task hangs. They live until their unit is destroyed, as the task may still use them.
struct LeftBehind {
  LeftBehind() = default;
  LeftBehind(const LeftBehind&) = delete;
  LeftBehind& operator=(const LeftBehind&) = delete;
  ~LeftBehind();
  std::vector<std::shared_ptr<ComponentSlot>> slots{};
};

/// Parameters of a Unit.
struct UnitParams {
  std::string name{};
  bool dedicated{false};  ///< Runs on a Runtime::dedicated_strand.
  /// Creates an instance, on the strand.
  std::function<Result<std::unique_ptr<Component>>(Executor& strand)> make{};
  /// Opens the endpoints of each strand before its first instance; may be null. The function must hold the
  /// slot weakly, and bind writers and readers to its generation (wire::ComponentIo), which is revoked when
  /// the strand is abandoned.
  std::function<Result<std::shared_ptr<void>>(const std::shared_ptr<ComponentSlot>& slot)> open_io{};
};

/// A component that can be restarted: on its strand when it failed, on another one when it hangs. Whatever an
/// instance passes to other strands counts only while its generation is valid. An exception thrown by a
/// callback of the component ends that instance at once.
///
/// Only the supervisor calls restart(), replace(), revoke() and abandon(), on its strand; all other functions
/// are safe to call from any thread.
class Unit {
 public:
  Unit(Runtime& runtime, UnitParams params);
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  const std::string& name() const { return params_.name; }
  /// Creates the first strand. Errors are those of `open_io`.
  Result<void> open();
  /// Sets the function called from the strand when an instance started or failed. Call it before the first
  /// restart().
  void on_change(std::function<void()> changed) { changed_ = std::move(changed); }

  void restart();
  void replace();
  /// Invalidates the instance and everything that its strand writes and reads.
  void revoke();
  /// Revokes an instance that hangs and abandons its strand: queued tasks are dropped, posts refused.
  void abandon();
  /// Ends the strand: no code of this component runs any more.
  void end();

  HealthSample health_sample() const;
  /// The current strand with its component. instance() is a number that rises with each restart.
  std::shared_ptr<ComponentSlot> slot() const;
  std::uint64_t instance() const { return instance_.load(std::memory_order_acquire); }
  /// Makes the component throw, or hang, in a callback of its own.
  void inject(ComponentFault fault);

 private:
  /// Report of an instance to the supervisor.
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
  mutable std::mutex mutex_{};  // Guards the two pointers.
  std::shared_ptr<ComponentSlot> slot_{};
  std::shared_ptr<Record> record_{std::make_shared<Record>()};
  LeftBehind left_behind_{};  // Bounded by SupervisionParams::hangs.
};

}  // namespace adit
