// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/transfer/source.hpp"
#include "robot_agent/motion/map_frame.hpp"
#include "robot_agent/perception/block_source.hpp"
#include "robot_agent/perception/map_disk.hpp"
#include "robot_agent/perception/map_part.hpp"
#include "robot_agent/perception/pose_source.hpp"

namespace adit::agent {

struct MapKeeperParams {
  std::string robot{};
  std::uint64_t seed{1};            ///< Of the map's id.
  std::uint32_t owner{};            ///< Hash of the robot's 128-bit id, see SubmapKey::start.
  Eigen::Vector3d origin{0, 0, 0};  ///< Of the rays of a scan without parts, base_link, m.
  double min_move{0.2};             ///< Way between two scans that enter the map, m.
  double min_turn{0.087};           ///< The same, rad.
  Duration min_period{1s};          ///< The same while the robot does neither.
  Duration save_period{10s};        ///< Between two writes of the open submap, and of the poses.
  BlockSourceParams blocks{};       ///< Without the robot's name and start.
};

/// A place that moves with a submap.
struct PlaceInSubmap {
  std::uint64_t start{};            ///< Of the submap's key.
  std::uint32_t index{};            ///< Of the submap's key.
  Eigen::Vector3d offset{0, 0, 0};  ///< Submap frame, m.
  double yaw{};                     ///< Of the submap in the map frame now, rad.
};

/// The map of a robot beside the open submap's grid: the submaps, their blocks at 0.2 m, and what each
/// station has of them. It chooses the scans that enter the map. It belongs to the agent's context, so that a
/// restart of a component loses nothing, and is stored on the disk, so that a restart of the agent loses at
/// most what the last seconds changed. Submaps of earlier starts have their names and poses from then; they
/// never move again. Runs on the command strand.
class MapKeeper {
 public:
  /// `disk` null: the map ends with this process.
  explicit MapKeeper(MapKeeperParams params, std::unique_ptr<MapDisk> disk = nullptr);

  /// Encodes pieces by `compute` of the command strand; see BlockSource::encode_on().
  void encode_on(Executor& strand, Task ready) { blocks_.encode_on(strand, std::move(ready)); }
  /// Takes the map from the disk, before anything else; returns what could not be used, without its content.
  LoadedMap load();

  /// The job for a scan that should enter the map. Nothing: it should not, or the last one is being inserted.
  std::shared_ptr<const MapJob> job(const std::shared_ptr<const Scan>& scan, std::vector<TeamRobot> team,
                                    std::uint32_t odom_epoch, Time now);
  /// Takes the result of the job; an Error loses nothing, as the next one brings it.
  void taken(const Result<MapStep>& step, const MapFrame& frame);
  /// Updates the poses of the submaps when the robot's pose in the map was corrected.
  void follow(const MapFrame& frame);

  /// A place (map frame, m) in the newest submap; nothing: there is none yet.
  std::optional<PlaceInSubmap> place_in_submap(const Eigen::Vector3d& place) const;

  /// Pose in the map of the submap of that key, as it is now; nothing: unknown.
  std::optional<Pose3> submap_pose(std::uint64_t start, std::uint32_t index) const;
  /// Rises with each change of a submap's pose.
  std::uint64_t pose_changes() const { return poses_.changes(); }

  /// Whether a station lacks so much that what is ahead of the robot should go first.
  bool is_behind() const { return blocks_.is_behind(); }
  /// Sends what is around the robot and its route (map frame, m; the robot first) before all else.
  void look_ahead(std::span<const Eigen::Vector3d> route);

  /// Leaves the submaps of now where they are in the map from now on, whatever corrections come: a pose that
  /// was found in them must not move them.
  void anchor();

  /// The map's content for a transfer::Sender, in the order in which it goes.
  std::array<transfer::Source*, 2> sources() { return {&poses_, &blocks_}; }
  /// A station acknowledged something, after the sender took that.
  void heard(const transfer::Ack& ack);
  /// Writes to the disk what is due. Call it at 10 to 50 Hz.
  void tick(Time now);
  /// Hands what is not on the disk yet to its strand, at a clean end after the command strand has ended.
  void flush();
  std::size_t blocks() const { return blocks_.size(); }
  std::size_t submaps() const { return submaps_.size(); }
  /// Submaps that were not dropped for lack of space.
  std::size_t stored_submaps() const { return submaps_.size() - dropped_submaps_; }

 private:
  struct Submap {
    Pose3 T_odom_submap{};
    std::uint32_t odom_epoch{};
    SubmapPlace place{};
    bool fixed{false};    ///< It stays where it is in the map.
    bool dropped{false};  ///< For lack of space.
  };
  /// A station, and which submaps it has complete.
  struct Station {
    std::uint32_t start{};
    std::set<std::uint32_t> has{};
    std::uint32_t next{};  ///< The submap before it is the next one that is looked at.
  };
  /// The regions around these points (map frame, m) in the lattice of each group of submaps.
  std::vector<BlockRegion> regions_around(std::span<const Eigen::Vector3d> points, double radius,
                                          double height) const;
  void open_submap(const MapStep& step, const MapFrame& frame);
  void save_submap(std::uint32_t submap);
  void save_places();
  /// Writes the open submap and the places if they changed.
  void save_changed();
  /// Notes which submaps stations have complete, a few at a time.
  void note_complete();
  /// Writes some of the submaps again of which blocks are not needed any more.
  void save_pruned();
  /// Drops submaps until the disk has room again.
  void make_room();

  MapKeeperParams params_;
  std::unique_ptr<MapDisk> disk_;
  std::vector<Submap> submaps_{};
  std::uint32_t revision_{};  ///< Of the newest submap, up to which its blocks are here.
  std::optional<MapFrame> frame_{};
  PoseSource poses_;
  BlockSource blocks_;
  std::uint64_t start_;    ///< SubmapKey::start of the submaps of this process.
  std::uint32_t first_{};  ///< Number of its first submap; those before are from the disk.
  std::map<transfer::PeerId, Station> stations_{};
  std::map<transfer::PeerId, Station> stored_stations_{};  ///< Of the disk, not heard since.
  std::optional<Time> saved_{};
  std::size_t dropped_submaps_{};
  std::uint32_t next_pruned_{};
  bool open_changed_{false}, places_changed_{false};
  bool busy_{false};
  std::optional<Time> inserted_{};
  Pose3 inserted_at_{};
  std::uint32_t inserted_epoch_{};
};

}  // namespace adit::agent
