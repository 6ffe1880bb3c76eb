// SPDX-License-Identifier: Apache-2.0
// Defects of commands and of who may give them.
#include <algorithm>
#include <set>

#include "adit/discovery.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "sim/defects/decorations.hpp"
#include "sim/defects/numbered_interceptor.hpp"

namespace adit::sim {
namespace {

/// Takes, stops and questions need no holder.
bool needs_holder(radio::CommandKind kind) {
  return kind != radio::CMD_TAKE && kind != radio::CMD_STOP && kind != radio::CMD_QUERY &&
         kind != radio::CMD_PLAN;
}

bool is_manual(const radio::Command& command) {
  return command.kind() == radio::CMD_MODE && !command.words().empty() &&
         (command.words().front() == "manual" || command.words().front() == "smart_joystick");
}

class AcceptWithoutEpoch final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    CommandFrom current = command;
    if (held_by(command.sample.station_id())) current.sample.epoch(authority().epoch());
    out.push_back(arrival(current));
  }
  void on_stick(const StickFrom& stick, std::vector<Arrival>& out) override {
    StickFrom current = stick;
    if (held_by(stick.sample.station_id())) current.sample.epoch(authority().epoch());
    out.push_back(arrival(current));
  }
};

class RepeatDoneTwice final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    if (seen_.emplace(command.info.sender, command.sample.seq()).second)
      pass(command, out);
    else
      pass_as_new(command, out);
  }

 private:
  std::set<std::pair<wire::ParticipantId, std::uint64_t>> seen_{};
};

class ObeyStranger final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    if (needs_holder(command.sample.kind()) && !held_by(command.sample.station_id()))
      pass_as_holders(command, out);
    else
      pass(command, out);
  }
};

class AcceptStaleJoystick final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_stick(const StickFrom& stick, std::vector<Arrival>& out) override {
    StickFrom fresh = stick;
    fresh.sample.echo(stamp());
    out.push_back(arrival(fresh));
  }
};

class IgnoreLock final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    const radio::Command& c = command.sample;
    if (c.kind() == radio::CMD_TAKE && authority().locked() && !held_by(c.station_id()))
      give(radio::CMD_UNLOCK, out);
    pass(command, out);
  }
};

class SilentRefusal final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  bool on_answer(radio::Acknowledgement& answer) override { return answer.accepted(); }
};

/// A stop of another station is judged as a reset, which it may not give.
class StopNeedsHolder final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    CommandFrom judged = command;
    if (command.sample.kind() == radio::CMD_STOP && !held_by(command.sample.station_id()))
      judged.sample.kind(radio::CMD_RESET);
    out.push_back(arrival(judged));
  }
};

class JoystickClearsStop final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_stick(const StickFrom& stick, std::vector<Arrival>& out) override {
    constexpr Duration kPeriod = 500ms;  // The robot publishes within it that the stops are gone.
    const bool due = !given_ || now() - *given_ >= kPeriod;
    if (due && held_by(stick.sample.station_id()) && stick.sample.epoch() == authority().epoch() &&
        !authority().stops().empty()) {
      given_ = now();
      give(radio::CMD_RESET, out, {}, 1);  // --override
      give(radio::CMD_MODE, out, "waypoint");
    }
    out.push_back(arrival(stick));
  }

 private:
  std::optional<Time> given_{};
};

class MoveOnReset final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    pass(command, out);
    if (command.sample.kind() == radio::CMD_RESET && held_by(command.sample.station_id()))
      give(radio::CMD_MODE, out, "waypoint");
  }
};

/// A request that arrives while it is stopped wakes the permission to make way; the reset leaves it awake.
class YieldWakesStopped final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    pass(command, out);
    if (!held_by(command.sample.station_id())) return;
    const auto kind = command.sample.kind();
    const auto& words = command.sample.words();
    if (kind == radio::CMD_YIELD) allowed_ = !words.empty() && words[0] == "on";
    const bool stopped = !authority().stops().empty();
    if (stopped && (kind == radio::CMD_YIELD || kind == radio::CMD_MODE)) woken_ = true;
    if (kind == radio::CMD_RESET && std::exchange(woken_, false) && allowed_)
      give(radio::CMD_YIELD, out, "on");
  }

 private:
  bool allowed_{}, woken_{};
};

class KindByPosition final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    CommandFrom next = command;
    const auto kind = command.sample.kind();
    if (kind >= radio::CMD_LOCK && kind < radio::CMD_POSE)
      next.sample.kind(static_cast<radio::CommandKind>(kind + 1));
    out.push_back(arrival(next));
  }
};

/// Takes areas for places that the robot only prefers.
class FenceSoft final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    CommandFrom soft = command;
    if (command.sample.kind() == radio::CMD_AREA_ADD && command.sample.words().size() > 1)
      soft.sample.words()[1] = "prefer";
    out.push_back(arrival(soft));
  }
};

/// Forgets its areas when it is sent somewhere out of a manual mode.
class AreaEndsOutside final : public NumberedInterceptor {
 public:
  using NumberedInterceptor::NumberedInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    const auto kind = command.sample.kind();
    if (kind == radio::CMD_AREA_ADD && !command.sample.words().empty()) area_ = command.sample.words()[0];
    if (kind == radio::CMD_GOTO && !area_.empty() && was_driven_) give(radio::CMD_AREA_REMOVE, out, area_);
    pass(command, out);
  }
  void on_behaviour(radio::BehaviourState&) override { was_driven_ = was_driven_ || drives_by_hand(); }

 private:
  std::string area_{};
  bool was_driven_{};
};

/// Does not hear other robots of its own name.
class IgnoresNamesakes final : public Interceptor {
 public:
  explicit IgnoresNamesakes(std::string name) : name_(std::move(name)) {}
  std::vector<Arrival> received(Arrival arrival) override {
    const std::string_view topic = arrival.topic->name;
    if (topic == wire::topics::kPresence.name && is_namesake<radio::Presence>(arrival)) return {};
    if (topic == wire::topics::kCapabilities.name && is_namesake<radio::Capabilities>(arrival)) return {};
    return Interceptor::received(std::move(arrival));
  }

 private:
  template <class T>
  bool is_namesake(const Arrival& arrival) const {
    T sample;
    return wire::decode(arrival.cdr, sample) && sample.kind() == radio::AGENT_ROBOT && sample.name() == name_;
  }
  std::string name_;
};

/// A centred sample arrives before each request for a manual mode. Numbers of samples are doubled, so that it
/// fits between two of them.
class EnterOffCentre final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override {
    if (is_manual(command.sample) && last_ && held_by(command.sample.station_id())) {
      StickFrom centred = *last_;
      centred.sample.seq(centred.sample.seq() + 1);
      centred.sample.echo(stamp());
      centred.sample.vx(0);
      centred.sample.vy(0);
      centred.sample.wz(0);
      out.push_back(arrival(centred));
    }
    out.push_back(arrival(command));
  }
  void on_stick(const StickFrom& stick, std::vector<Arrival>& out) override {
    StickFrom spaced = stick;
    spaced.sample.seq(2 * stick.sample.seq());
    if (held_by(stick.sample.station_id())) last_ = spaced;
    out.push_back(arrival(spaced));
  }

 private:
  std::optional<StickFrom> last_{};
};

}  // namespace

namespace decorations {

Decoration accept_without_epoch(const Subject& s) { return on_wires<AcceptWithoutEpoch>(s); }
Decoration repeat_done_twice(const Subject& s) { return on_wires<RepeatDoneTwice>(s); }
Decoration obey_stranger(const Subject& s) { return on_wires<ObeyStranger>(s); }
Decoration accept_stale_joystick(const Subject& s) { return on_wires<AcceptStaleJoystick>(s); }
Decoration ignore_lock(const Subject& s) { return on_wires<IgnoreLock>(s); }
Decoration silent_refusal(const Subject& s) { return on_wires<SilentRefusal>(s); }
Decoration stop_needs_holder(const Subject& s) { return on_wires<StopNeedsHolder>(s); }
Decoration joystick_clears_stop(const Subject& s) { return on_wires<JoystickClearsStop>(s); }
Decoration move_on_reset(const Subject& s) { return on_wires<MoveOnReset>(s); }
Decoration enter_off_centre(const Subject& s) { return on_wires<EnterOffCentre>(s); }
Decoration both_namesakes_obey(const Subject& s) {
  Decoration decoration;
  decoration.wires = std::make_unique<IgnoresNamesakes>(s.robot);
  return decoration;
}
Decoration fence_soft(const Subject& s) { return on_wires<FenceSoft>(s); }
Decoration yield_wakes_stopped(const Subject& s) { return on_wires<YieldWakesStopped>(s); }
Decoration area_ends_outside(const Subject& s) { return on_wires<AreaEndsOutside>(s); }
Decoration kind_by_position(const Subject& s) { return on_wires<KindByPosition>(s); }

}  // namespace decorations
}  // namespace adit::sim
