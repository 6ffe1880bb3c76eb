// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/transfer/sender.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/perception/map_keeper.hpp"

namespace adit::agent {

/// The one sender of what a robot has for the stations in class `bulk`: its findings, then the poses of its
/// map, then the map's blocks. It belongs to the agent's context and runs on the command strand.
class ContentSender {
 public:
  /// `map` null: this robot makes none. Both must outlive this. `seed`: of the session, another one at each
  /// start.
  ContentSender(std::uint64_t seed, FindingSource& findings, MapKeeper* map);

  /// Takes what a station has of this robot's pieces; only the station itself may say that.
  void acknowledged(const transfer::Ack& ack, Time now);
  /// The pieces to send now. Call it at 10 to 50 Hz; it also writes to the disk what is due.
  std::vector<transfer::Piece> due(Time now, const wire::SenderState& link);
  std::uint32_t session() const { return sender_.session(); }

 private:
  FindingSource& findings_;
  MapKeeper* map_;
  transfer::Sender sender_;
};

}  // namespace adit::agent
