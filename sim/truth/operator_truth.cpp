// SPDX-License-Identifier: Apache-2.0
#include "sim/truth/operator_truth.hpp"

#include <algorithm>
#include <utility>

#include "adit/authority.h"
#include "adit/robot.h"
#include "core/contract/authority.hpp"
#include "core/contract/robot.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace adit::sim {
namespace {

namespace topics = wire::topics;
using contract::GoalState;

constexpr Duration kTrack{2s};
constexpr double kDriven = 1.0;  // Metres in kTrack: such a robot drives.
constexpr double kStood = 0.1;   // m

template <class T>
auto read(const wire::SampleEvent& frame) -> decltype(contract::decode(std::declval<T>())) {
  T sample;
  if (!wire::decode(frame.bytes, sample)) return std::nullopt;
  return contract::decode(sample);
}

void set(bool& value, Duration& since, bool now_is, Duration at) {
  if (now_is && !value) since = at;
  value = now_is;
}

/// Whether the robot has a task and does not do it. Hold by request, a stop and a new holder are none.
bool stands_still(const contract::BehaviourState& state) {
  if (state.stopped) return false;
  if (state.goal_state == GoalState::blocked) return true;
  return !state.moving_allowed && state.reason != Reason::none && state.reason != Reason::not_holder &&
         state.reason != Reason::stopped;
}

}  // namespace

void OperatorTruth::take(View& view, const wire::SampleEvent& frame) const {
  if (frame.topic == topics::kAuthority.name) {
    const auto status = read<radio::AuthorityStatus>(frame);
    if (!status) return;
    set(view.held, view.held_since, status->holder && status->holder->name == station_, frame.at);
    const bool by_another = std::ranges::any_of(
        status->stops, [&](const contract::Party& stopper) { return stopper.name != station_; });
    if (view.stopped) view.stopped_until = frame.at;
    set(view.stopped, view.stopped_since, by_another, frame.at);
  } else if (frame.topic == topics::kBehaviour.name) {
    const auto state = read<radio::BehaviourState>(frame);
    if (!state) return;
    if (view.stands) view.stands_until = frame.at;
    set(view.stands, view.stands_since, stands_still(*state), frame.at);
    const bool drives = state->moving_allowed && state->goal_state == GoalState::active;
    set(view.drives, view.drives_since, drives, frame.at);
  }
}

void OperatorTruth::see(const wire::SampleEvent& frame) {
  const bool sign = frame.topic == topics::kRobotState.name || frame.topic == topics::kPresence.name;
  if (!sign && frame.topic != topics::kAuthority.name && frame.topic != topics::kBehaviour.name) return;
  const std::string from(frame.from_name);
  if (frame.kind == wire::SampleEvent::Kind::sent) {
    take(robots_[from].sent, frame);
  } else if (frame.kind == wire::SampleEvent::Kind::delivered && frame.to_name == station_) {
    Robot& robot = robots_[from];
    if (sign) {
      if (!robot.heard || frame.at - *robot.heard > kSilence) robot.heard_since = frame.at;
      robot.heard = frame.at;
    }
    take(robot.arrived, frame);
  }
}

void OperatorTruth::station_restarted() {
  for (auto& [name, robot] : robots_) {
    robot.arrived = {};
    robot.heard.reset();
  }
}

void OperatorTruth::moved(const std::string& name, Duration at, const Eigen::Vector2d& position) {
  Robot& robot = robots_[name];
  robot.way.emplace_back(at, position);
  while (robot.way.front().first < at - kTrack) robot.way.pop_front();
  if (robot.way.size() == 1 || (position - robot.stood_at).norm() > kStood) {
    robot.stood_at = position;
    robot.stood_since = at;
  }
}

std::optional<Duration> OperatorTruth::lasts(const std::string& name, Loss loss, Duration now) const {
  const auto found = robots_.find(name);
  if (found == robots_.end() || !found->second.heard || !found->second.arrived.held) return std::nullopt;
  const Robot& robot = found->second;
  const Duration silent = now - *robot.heard;
  const auto since = [&](Duration begun) {
    return now - std::max({begun, robot.arrived.held_since, robot.heard_since});
  };
  switch (loss) {
    case Loss::contact:
      return silent > kSilence ? std::optional(since(*robot.heard + kSilence)) : std::nullopt;
    case Loss::stopped:
      return robot.arrived.stopped && silent <= kSilence ? std::optional(since(robot.arrived.stopped_since))
                                                         : std::nullopt;
    case Loss::motion:
      return robot.arrived.stands && !robot.arrived.stopped && silent <= kSilence
                 ? std::optional(since(robot.arrived.stands_since))
                 : std::nullopt;
  }
  return std::nullopt;
}

bool OperatorTruth::is_true(const std::string& name, Loss loss, Duration now) const {
  const auto found = robots_.find(name);
  if (found == robots_.end()) return false;
  const Robot& robot = found->second;
  const auto recent = [&](bool is, const std::optional<Duration>& until) {
    return is || (until && now - *until <= kRecent);
  };
  switch (loss) {
    case Loss::contact:
      // The station looks a few times a second.
      return !robot.heard || now - *robot.heard > kSilence - 200ms;
    case Loss::stopped:
      return recent(robot.sent.stopped, robot.sent.stopped_until);
    case Loss::motion: {
      const bool driving = !robot.way.empty() && now - robot.way.front().first >= kTrack - 200ms &&
                           (robot.way.back().second - robot.way.front().second).norm() > kDriven;
      return !driving && recent(robot.sent.stands, robot.sent.stands_until);
    }
  }
  return false;
}

std::optional<Duration> OperatorTruth::stands_with_goal(const std::string& name, Duration now) const {
  const auto found = robots_.find(name);
  if (found == robots_.end()) return std::nullopt;
  const Robot& robot = found->second;
  if (!robot.sent.held || !robot.sent.drives || robot.sent.stopped) return std::nullopt;
  return now - std::max(robot.stood_since, robot.sent.drives_since);
}

}  // namespace adit::sim
