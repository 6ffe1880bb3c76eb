// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "core/time/time.hpp"
#include "perception/map/block.hpp"
#include "perception/stream/map_digest.hpp"
#include "perception/stream/piece.hpp"
#include "perception/types/submap_key.hpp"

namespace adit::station {

struct ChunkStoreParams {
  std::size_t max_robots{64};
  std::size_t max_submaps{4096};      ///< Of one robot.
  std::size_t max_blocks{1'000'000};  ///< Of all robots.
  // Bounds of what other robots than its own sent of a map: they may lie.
  std::size_t max_carried_robots{16};  ///< Of which nothing came directly.
  std::size_t max_carried_blocks{250'000};
  std::size_t max_carriers{8};  ///< Of one robot's map, that are remembered.
};

/// The map of all robots as this station received it: the blocks of each submap at 0.2 m, and the submap's
/// pose in the map. Of each block and pose the highest revision is stored, so that pieces may come late,
/// twice or in another order. Bounded: where there is no room, robots that were not heard since the start of
/// the station are forgotten; what does not fit then is refused and counted.
///
/// Other robots may carry a robot's map here. What they bring is taken if it is newer, and replaced by
/// whatever the robot itself sends later; it makes no room for itself, and replaces nothing that a robot sent
/// that is heard now.
class ChunkStore {
 public:
  struct Block {
    std::uint64_t known{}, occupied{};
    std::uint32_t revision{};
    std::uint32_t received : 31 {};  ///< When, in tenths of a second since `begun`, from 1; 0: unknown.
    std::uint32_t carried : 1 {};    ///< Another robot sent it.
  };
  struct Submap {
    std::map<perception::BlockIndex, Block> blocks{};
    std::optional<Pose3> T_map_submap{};  ///< Nothing: its pose did not arrive yet.
    std::uint32_t pose_revision{};
    bool pose_carried{false};
  };
  /// What another robot sent of a robot's map.
  struct Carried {
    std::uint64_t bytes{}, pieces{};
    std::uint64_t parts{};        ///< Blocks and poses that were newer than those here.
    std::optional<Time> heard{};  ///< Last piece; nothing: all are from before this start of the station.
    std::uint64_t last{};         ///< Rises with each piece of any carrier.
  };
  /// One robot's map.
  struct RobotMap {
    std::map<perception::SubmapKey, Submap> submaps{};
    std::size_t blocks{};
    std::uint64_t bytes{};  ///< Content of pieces received.
    std::uint64_t pieces{};
    std::uint32_t waiting{};      ///< Parts that the robot has still to send, as it said last.
    std::optional<Time> heard{};  ///< Last piece; nothing: all are from before this start of the station.
    std::map<std::string, Carried> carriers{};  ///< By the robot that sent it.
    std::size_t carried_blocks{};               ///< Those of `blocks` that a carrier sent.
    perception::MapDigest digest{};
    /// When each robot of this name (perception::owner_of()) sent a block last itself, as a rising number.
    std::map<std::uint32_t, std::uint64_t> owners{};
  };

  explicit ChunkStore(ChunkStoreParams params = {}) : params_(params) {}

  /// Takes a piece's blocks, those in voxels of 0.4 m where nothing smaller is. `robot`: the sender, which
  /// must be the one that the piece names. Returns whether all of it was taken.
  bool take(const std::string& robot, const perception::MapPiece& piece);
  bool take(const std::string& robot, const perception::SubmapPoses& poses);
  /// Counts a piece of that robot, heard at `now`; nothing: from the disk. Returns false if there is no room
  /// for one more robot.
  bool count(const std::string& robot, std::size_t bytes, std::uint32_t waiting, std::optional<Time> now);

  /// Null: nothing of it is here.
  const Submap* find(const perception::SubmapKey& key) const;
  /// The stored state of a block; nothing: it is not here.
  std::optional<perception::CoarseBlock> find(const perception::SubmapKey& key,
                                              const perception::BlockIndex& index) const;

  // Defined in carried_chunks.cpp.

  /// Takes what `carrier` sent of another robot's map, which the content names, heard at `now` (nothing: from
  /// the disk), and leaves in it what was newer. Returns whether there was room for all of it.
  bool take_carried(const std::string& carrier, perception::MapPiece& piece, std::size_t bytes,
                    std::optional<Time> now);
  /// All poses must be of one robot, and at least one.
  bool take_carried(const std::string& carrier, perception::SubmapPoses& poses, std::size_t bytes,
                    std::optional<Time> now);
  /// Notes how many parts a robot has still to send, if anything came from it.
  void note_waiting(const std::string& robot, std::uint32_t waiting);
  /// The time as Block::received has it; 0 before the first piece.
  std::uint32_t clock(Time now) const;

  /// Forgets everything.
  void clear();

  const std::map<std::string, RobotMap>& robots() const { return robots_; }
  std::size_t blocks() const { return blocks_; }
  /// Number of robots that were forgotten to make room, since the start or clear().
  std::uint64_t evicted() const { return evicted_; }
  /// Number of blocks and poses that did not fit, or were not the sender's.
  std::uint64_t refused() const { return refused_; }
  bool empty() const { return blocks_ == 0; }
  /// Number of blocks and poses of carriers that did not fit.
  std::uint64_t refused_carried() const { return refused_carried_; }
  /// Rises with each block or pose that changed.
  std::uint64_t revision() const { return revision_; }

 private:
  /// Forgets a robot that was not heard since the start, other than this one. False: there is none.
  bool make_room(const std::string& robot);
  Submap* submap(const std::string& robot, const perception::SubmapKey& key);
  /// Stores a block that is newer, or adds one in voxels of 0.4 m to what is known in such.
  void put(RobotMap& robot, Submap& submap, const perception::SubmapKey& key,
           const perception::BlockUpdate& update, bool carried);
  void put(RobotMap& robot, Submap& submap, const perception::SubmapPose& pose, bool carried);
  /// The robot of a carried piece, and its carrier's count. Null: no room.
  RobotMap* count_carried(const std::string& carrier, const std::string& robot, std::size_t bytes,
                          std::optional<Time> now);
  /// Counts what came of a carrier's piece. Returns whether nothing was refused.
  bool note_carried(RobotMap* robot, const std::string& carrier, std::size_t newer, std::size_t refused);
  void set_now(std::optional<Time> now);

  ChunkStoreParams params_;
  std::map<std::string, RobotMap> robots_{};
  std::size_t blocks_{};
  std::size_t carried_blocks_{};
  std::uint64_t refused_{}, evicted_{}, refused_carried_{}, carried_pieces_{};
  std::uint64_t revision_{}, direct_parts_{};
  std::optional<Time> begun_{};  ///< The first piece of this start.
  std::uint32_t now_{};          ///< When the present piece came, as Block::received.
};

/// The submaps of a robot's name, the oldest first. Each start of a robot is later than those before on its
/// disk; of several robots of one name the one that was heard last has the newest. Valid while the map is.
std::vector<const perception::SubmapKey*> by_age(const ChunkStore::RobotMap& robot);

}  // namespace adit::station
