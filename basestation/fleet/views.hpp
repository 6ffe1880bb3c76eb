// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "basestation/fleet/links.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/notice.hpp"
#include "basestation/model/robot.hpp"
#include "core/contract/authority.hpp"
#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::station {

using contract::Id;

/// The state of one robot as received: what front ends receive of it, and what only the station needs.
/// `age`, `troubles` and `stopped` are complete after described().
struct RobotView : Robot {
  wire::ParticipantId participant{};
  Time first_heard{};
  Time last_heard{};  ///< Last RobotState, or the first heartbeat before that.
  Time spoke{};       ///< Last sample of any kind.
  Time last_sign{};   ///< Last heartbeat, sent once a second beside RobotState.

  std::vector<std::string> modes{};  ///< As in its capabilities.

  wire::ParticipantId stamped_by{};  ///< The participant of the last RobotState.

  bool owned{false};  ///< An AuthorityStatus was received.
  Id holder_id{};
  std::vector<contract::Party> latches{};  ///< The stops, with the stations' identities.

  std::uint64_t behaviour_count{};  ///< Number of BehaviourStates received.

  std::vector<ComponentHealth> components{};
};

/// What front ends receive of a robot. The station adds a centred stick to a mode that is driven by hand: a
/// mode that only lacks the stick is available.
Robot described(const RobotView& robot, Time now);

struct StationView {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
  Time last_heard{};
  std::optional<std::array<float, 3>> place{};  ///< Position of the station, map frame, m; unset: unknown.
};

/// A notice as the station stores it: with the time of the event in place of its age.
struct StoredNotice : Notice {
  /// Time of the event, by this station's clock. While `stamp` is not 0 the robot's clock is unknown, and
  /// this is the time of reception; it is moved back to the event later.
  Time at{};
  wire::ParticipantId said_by{};
};

/// What front ends receive of a notice.
Notice described(const StoredNotice& notice, Time now);

/// The last report of an agent, or this station's own.
struct TrafficView : contract::LinkReport {
  Time last_heard{};
};

}  // namespace adit::station
