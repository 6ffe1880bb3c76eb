// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/findings/photo_source.hpp"
#include "core/transfer/sender.hpp"
#include "robot_agent/camera/shot_source.hpp"
#include "robot_agent/carry/carrier.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/perception/map_keeper.hpp"

namespace adit::agent {

/// The one sender of what a robot has for the stations in class `bulk`: its findings, then the thumbnails of
/// their photos, the single pictures that a station asked for, the poses of its map, the map's blocks, the
/// maps that it carries, and last the photos. Where no station is heard, its own map goes to carriers. It
/// belongs to the agent's context and runs on the command strand.
class ContentSender {
 public:
  /// `map` null: this robot makes none. `carrier` null: it carries none. `shots` null: it has
  /// no camera. All must outlive this. `seed`: of
  /// the session, another one at each start.
  ContentSender(std::uint64_t seed, FindingSource& findings, findings::PhotoSources& photos, MapKeeper* map,
                Carrier* carrier = nullptr, ShotSource* shots = nullptr);

  /// Takes what a station or a carrier has of this robot's pieces; only the peer itself may say that.
  void acknowledged(const transfer::Ack& ack, Time now);
  /// The pieces to send now. Call it at 10 to 50 Hz; it also writes to the disk what is due.
  std::vector<transfer::Piece> due(Time now, const wire::SenderState& link);
  std::uint32_t session() const { return sender_.session(); }
  /// Whether carriers should get the map, as no station is heard.
  bool needs_carriers(Time now) const { return map_ != nullptr && sender_.serves_carriers(now); }

 private:
  FindingSource& findings_;
  findings::PhotoSources& photos_;
  MapKeeper* map_;
  Carrier* carrier_;
  ShotSource* shots_;
  transfer::Sender sender_;
};

}  // namespace adit::agent
