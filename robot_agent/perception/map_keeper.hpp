// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/transfer/sender.hpp"
#include "robot_agent/motion/map_frame.hpp"
#include "robot_agent/perception/block_source.hpp"
#include "robot_agent/perception/map_part.hpp"
#include "robot_agent/perception/pose_source.hpp"

namespace adit::agent {

struct MapKeeperParams {
  std::string robot{};
  std::uint64_t seed{1};            ///< Of the map's id and of the sender's session.
  Eigen::Vector3f origin{0, 0, 0};  ///< Of the rays, in base_link, m.
  double min_move{0.2};             ///< Way between two scans that enter the map, m.
  double min_turn{0.087};           ///< The same, rad.
  Duration min_period{1s};          ///< The same while the robot does neither.
};

/// What a robot knows of its map beside the open submap's grid: the submaps, their blocks at 0.2 m, and what
/// each station has of them. It chooses the scans that enter the map and sends the map to the stations. It
/// belongs to the agent's context, so that a restart of a component loses nothing; on the disk it is not yet.
/// Runs on the command strand.
class MapKeeper {
 public:
  explicit MapKeeper(MapKeeperParams params);

  /// The job for a scan that should enter the map. Nothing: it should not, or the last one is being inserted.
  std::shared_ptr<const MapJob> job(const std::shared_ptr<const Scan>& scan, std::vector<TeamRobot> team,
                                    std::uint32_t odom_epoch, Time now);
  /// Takes the result of the job; an Error loses nothing, as the next one brings it.
  void taken(const Result<MapStep>& step, const MapFrame& frame);
  /// Updates the poses of the submaps when the robot's pose in the map was corrected.
  void follow(const MapFrame& frame);

  void acknowledged(const transfer::Ack& ack, Time now) { sender_.acknowledged(ack, now); }
  /// The pieces to send now.
  std::vector<transfer::Piece> due(Time now, const wire::SenderState& link) { return sender_.due(now, link); }
  std::uint32_t session() const { return sender_.session(); }
  std::size_t blocks() const { return blocks_.size(); }
  std::size_t submaps() const { return submaps_.size(); }

 private:
  struct Submap {
    Pose3 T_odom_submap{};
    std::uint32_t odom_epoch{};
  };
  MapKeeperParams params_;
  std::vector<Submap> submaps_{};
  std::uint32_t revision_{};  ///< Of the newest submap, up to which its blocks are here.
  std::optional<MapFrame> frame_{};
  PoseSource poses_;
  BlockSource blocks_;
  transfer::Sender sender_;
  bool busy_{false};
  std::optional<Time> inserted_{};
  Pose3 inserted_at_{};
  std::uint32_t inserted_epoch_{};
};

}  // namespace adit::agent
