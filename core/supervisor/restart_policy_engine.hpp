#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/processor_use.hpp"
#include "core/result/result.hpp"
#include "core/time/time.hpp"

namespace adit {

/// Who starts a component that failed or hangs.
enum class RestartPolicy : std::uint8_t { automatic, by_operator };

enum class PartState : std::uint8_t {
  starting,  ///< ordered, its loop did not report yet
  up,
  waiting,  ///< failed; started again after a pause
  failed,   ///< failed; waits for the operator
  hung      ///< does not return; waits for the operator
};

struct SupervisionParams {
  Duration period{50ms};    ///< how often the hearts are looked at, [10 ms, 500 ms]
  Duration silence{700ms};  ///< without a beat for longer, waits for a processor apart: hung, [200 ms, 60 s]
  Duration start{5s};       ///< without a first beat for longer: hung, [silence, 60 s]
  Duration first_pause{10ms};  ///< before the first restart in a window; four times as long at each next
  Duration longest_pause{2s};
  int attempts{5};  ///< restarts of one component within the window, [1, 100]; then the agent is restarted
  Duration window{30s};  ///< [1 s, 1 h]
  int hangs{1};          ///< threads that may be left behind, [0, 16]; the next hang restarts the agent
};

struct PartSpec {
  std::string name{};
  RestartPolicy policy{RestartPolicy::automatic};
  bool replaceable{true};  ///< can be made anew on another strand while the old one hangs
  bool always{false};      ///< its policy is automatic and stays it
};

/// What is seen of a component.
struct HealthSample {
  bool running{};  ///< this instance of it started
  bool failed{};   ///< this instance ended with an exception, or did not start
  std::uint64_t heartbeats{};
  std::string text{};  ///< why it failed
  /// What its thread had of the processor; asked for in RestartPolicyEngine::doubts(). Nothing: all time
  /// counts.
  std::optional<ProcessorUse> use{};
};

struct PartStatus {
  PartSpec spec{};
  PartState state{PartState::starting};
  std::uint32_t restarts{};  ///< that brought it back
  std::uint32_t hangs{};     ///< threads that it left behind
  Duration silent{};         ///< since its loop last beat, as far as the watcher lived
  Duration stalled{};        ///< of that, what was no wait for a processor
  std::string text{};        ///< the last failure, "" when there was none
};

/// What is to be done.
struct RestartAction {
  enum class Kind : std::uint8_t {
    restart,  ///< make the component anew on its strand
    replace,  ///< leave its strand behind and make it anew on another
    abandon,  ///< Leave its strand behind; the operator restarts it.
    escalate  ///< restart the agent
  };
  Kind kind{};
  std::size_t part{};
  bool operator==(const RestartAction&) const = default;
};

/// What is to be told.
struct PartEvent {
  enum class Kind : std::uint8_t { failed, hung, back, escalated };
  Kind kind{};
  std::size_t part{};
  std::string text{};
};

/// Decides what becomes of components that fail or hang: policy, back-off, attempts in a window, then
/// escalation to the agent (docs/supervision.md). Pure: it is shown samples and told the time. Silence counts
/// only while the engine itself is in time, so that a machine that slept does not look hung, and only while
/// the silent one was not waiting for a processor, so that a busy machine does not either.
class RestartPolicyEngine {
 public:
  struct Decision {
    std::vector<RestartAction> actions{};
    std::vector<PartEvent> events{};
  };

  explicit RestartPolicyEngine(SupervisionParams params = {}) : params_(params) {}
  /// Before the first look. Its place is the index of samples, actions and status().
  void add(PartSpec spec);

  /// One sample per part. Every params.period, and at once when something failed.
  Decision poll(const std::vector<HealthSample>& samples, Time now);
  /// It is silent for so long that its next samples must tell what its thread had of the processor. No
  /// sooner: it is asked of the system.
  bool doubts(std::size_t part) const { return status_[part].silent >= params_.silence / 4; }
  /// The operator's word; a component that works is made anew, too. Errors: bad_argument.
  Result<Decision> restart(const std::string& part, Time now);
  /// Errors: bad_argument, not_supported (the component takes the operators' word itself).
  Result<Decision> set_policy(const std::string& part, RestartPolicy policy, Time now);

  const std::vector<PartStatus>& status() const { return status_; }
  bool escalated() const { return escalated_; }

 private:
  struct History {
    std::uint64_t heartbeats{};
    bool was_down{};                    ///< since it was last up
    Time resume{};                      ///< end of the pause
    std::optional<ProcessorUse> use{};  ///< at the last look
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
