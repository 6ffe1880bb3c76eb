// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "perception/map/block.hpp"
#include "perception/stream/piece.hpp"
#include "perception/types/submap_key.hpp"

namespace adit::station {

struct ChunkStoreParams {
  std::size_t max_robots{64};
  std::size_t max_submaps{4096};      ///< Of one robot.
  std::size_t max_blocks{1'000'000};  ///< Of all robots.
};

/// The map of all robots as this station received it: the blocks of each submap at 0.2 m, and the submap's
/// pose in the map. Of each block and pose the highest revision is stored, so that pieces may come late,
/// twice or in another order. Bounded: where there is no room, robots that were not heard since the start of
/// the station are forgotten; what does not fit then is refused and counted.
class ChunkStore {
 public:
  struct Block {
    std::uint64_t known{}, occupied{};
    std::uint32_t revision{};
  };
  struct Submap {
    std::map<perception::BlockIndex, Block> blocks{};
    std::optional<Pose3> T_map_submap{};  ///< Nothing: its pose did not arrive yet.
    std::uint32_t pose_revision{};
  };
  struct Robot {
    std::map<perception::SubmapKey, Submap> submaps{};
    std::size_t blocks{};
    std::uint64_t bytes{};  ///< Content of pieces received.
    std::uint64_t pieces{};
    std::uint32_t waiting{};      ///< Parts that the robot has still to send, as it said last.
    std::optional<Time> heard{};  ///< Last piece; nothing: all are from before this start of the station.
  };

  explicit ChunkStore(ChunkStoreParams params = {}) : params_(params) {}

  /// Takes a piece's blocks. `robot`: the sender, which must be the one that the piece names. Returns whether
  /// all of it was taken.
  bool take(const std::string& robot, const perception::MapPiece& piece);
  bool take(const std::string& robot, const perception::SubmapPoses& poses);
  /// Counts a piece of that robot, heard at `now`; nothing: from the disk. Returns false if there is no room
  /// for one more robot.
  bool count(const std::string& robot, std::size_t bytes, std::uint32_t waiting, std::optional<Time> now);

  /// The stored state of a block; nothing: it is not here.
  std::optional<perception::CoarseBlock> find(const perception::SubmapKey& key,
                                              const perception::BlockIndex& index) const;

  /// Forgets everything.
  void clear();

  const std::map<std::string, Robot>& robots() const { return robots_; }
  std::size_t blocks() const { return blocks_; }
  /// Number of robots that were forgotten to make room, since the start or clear().
  std::uint64_t evicted() const { return evicted_; }
  /// Number of blocks and poses that did not fit, or were not the sender's.
  std::uint64_t refused() const { return refused_; }
  bool empty() const { return blocks_ == 0; }
  /// Rises with each block or pose that changed.
  std::uint64_t revision() const { return revision_; }
  /// Area of the ground seen, by robot; "" for all: columns of 0.2 m of which anything is known, m2.
  double area(const std::string& robot = {}) const;

 private:
  /// Forgets a robot that was not heard since the start, other than this one. False: there is none.
  bool make_room(const std::string& robot);
  Submap* submap(const std::string& robot, const perception::SubmapKey& key);

  ChunkStoreParams params_;
  std::map<std::string, Robot> robots_{};
  std::size_t blocks_{};
  std::uint64_t refused_{}, evicted_{};
  std::uint64_t revision_{};
};

}  // namespace adit::station
