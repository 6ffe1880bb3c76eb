// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/processor_use.hpp"
#include "core/result/result.hpp"
#include "core/supervisor/part_state.hpp"
#include "core/time/time.hpp"

namespace adit {

/// The party that restarts a component that failed or hangs.
enum class RestartPolicy : std::uint8_t { automatic, by_operator };

struct SupervisionParams {
  Duration period{50ms};  ///< Period of the heartbeat checks, [10 ms, 500 ms].
  /// A component without a heartbeat for longer, CPU wait excluded, counts as hung, [200 ms, 60 s].
  Duration silence{700ms};
  Duration start{5s};  ///< A component without a first heartbeat for longer counts as hung, [silence, 60 s].
  /// Backoff delay before the first restart in a window; it quadruples with each further restart.
  Duration first_pause{10ms};
  Duration longest_pause{2s};
  /// Restarts of one component within the window, [1, 100]; beyond them the agent is restarted.
  int attempts{5};
  Duration window{30s};  ///< Length of the window, [1 s, 1 h].
  int hangs{1};          ///< Threads that may be abandoned, [0, 16]; a further hang restarts the agent.
};

struct PartSpec {
  std::string name{};
  RestartPolicy policy{RestartPolicy::automatic};
  bool replaceable{true};  ///< Can be replaced by an instance on another strand while the old one hangs.
  bool always{false};      ///< The policy is automatic, and the operator cannot change it.
};

/// Observed state of a component.
struct HealthSample {
  bool running{};  ///< This instance of it started.
  bool failed{};   ///< This instance ended with an exception, or did not start.
  std::uint64_t heartbeats{};
  std::string text{};  ///< Reason of the failure.
  /// Processor use of its thread; requested when RestartPolicyEngine::doubts() is true. Nothing: all time
  /// counts.
  std::optional<ProcessorUse> use{};
};

struct PartStatus {
  PartSpec spec{};
  PartState state{PartState::starting};
  std::uint32_t restarts{};  ///< Restarts that brought it up again.
  std::uint32_t hangs{};     ///< Threads abandoned in hangs.
  Duration silent{};         ///< Time since the last heartbeat of its loop, counted while the watcher ran.
  Duration stalled{};        ///< The part of `silent` that was no wait for a processor.
  std::string text{};        ///< The last failure, "" when there was none.
};

/// An order to the supervisor.
struct RestartAction {
  enum class Kind : std::uint8_t {
    restart,  ///< Restart the component on its strand.
    replace,  ///< Abandon its strand and restart it on another one.
    abandon,  ///< Abandon its strand; the operator restarts it.
    escalate  ///< Restart the agent.
  };
  Kind kind{};
  std::size_t part{};
  bool operator==(const RestartAction&) const = default;
};

/// An event to report.
struct PartEvent {
  enum class Kind : std::uint8_t { failed, hung, back, escalated };
  Kind kind{};
  std::size_t part{};
  std::string text{};
};

/// Decides how components that fail or hang are restarted: policy, backoff, attempts in a window, then
/// escalation to the agent (docs/supervision.md). It has neither clock nor threads: the caller passes samples
/// and the time. Silence counts only while the engine itself is polled in time, so that components do not
/// seem hung after the machine slept, and only while the silent component was not waiting for a processor, so
/// that they do not seem hung on a busy machine.
class RestartPolicyEngine {
 public:
  struct Decision {
    std::vector<RestartAction> actions{};
    std::vector<PartEvent> events{};
  };

  explicit RestartPolicyEngine(SupervisionParams params = {}) : params_(params) {}
  /// Adds a component before the first poll. Its position is the index of samples, actions and status().
  void add(PartSpec spec);

  /// Processes one sample per component. Call it every params.period, and at once when a component failed.
  Decision poll(const std::vector<HealthSample>& samples, Time now);
  /// Whether a component is silent for so long that its next samples must contain the processor use of its
  /// thread. Not requested earlier, because it needs system calls.
  bool doubts(std::size_t part) const { return status_[part].silent >= params_.silence / 4; }
  /// Restarts a component on the operator's command, even one that works. Errors: bad_argument.
  Result<Decision> restart(const std::string& part, Time now);
  /// Sets the policy of a component. Errors: bad_argument, not_supported (the operator cannot change it).
  Result<Decision> set_policy(const std::string& part, RestartPolicy policy, Time now);

  const std::vector<PartStatus>& status() const { return status_; }
  bool escalated() const { return escalated_; }

 private:
  struct History {
    std::uint64_t heartbeats{};
    bool was_down{};                    ///< It was down since it was last up.
    Time resume{};                      ///< End of the backoff delay.
    std::optional<ProcessorUse> use{};  ///< Processor use at the last poll.
    std::deque<Time> attempts{};
  };
  Result<std::size_t> find(const std::string& part) const;
  void watch(std::size_t part, const HealthSample& sample, Duration lived, Time now, Decision& decision);
  void failed(std::size_t part, const std::string& text, Time now, Decision& decision);
  void hung(std::size_t part, Decision& decision);
  void add_action(std::size_t part, RestartAction::Kind kind, Decision& decision);
  void escalate(std::size_t part, const std::string& why, Decision& decision);

  SupervisionParams params_;
  std::vector<PartStatus> status_{};
  std::vector<History> histories_{};
  std::optional<Time> polled_{};
  Duration allowance_{};
  int left_behind_{};
  bool escalated_{};
};

}  // namespace adit
