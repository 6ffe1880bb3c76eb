// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_replica.hpp"

#include <algorithm>
#include <utility>

#include "core/transfer/piece.hpp"
#include "perception/stream/piece.hpp"

namespace adit::station {
namespace {

// A file is written again when it is long, and most of it was replaced by later pieces. A block takes 3 bytes
// or so.
constexpr std::size_t kLongFile = std::size_t{512} << 10;
constexpr std::size_t kBytesOfBlock = 10;

}  // namespace

std::vector<JournalPiece> pieces_of(const ChunkStore& chunks) {
  std::vector<JournalPiece> out;
  for (const auto& [name, robot] : chunks.robots()) {
    perception::SubmapPoses poses;
    const auto add_poses = [&, &name = name] {
      if (poses.poses.empty()) return;
      out.push_back({name, static_cast<std::uint8_t>(transfer::Kind::map_poses), perception::encode(poses)});
      poses.poses.clear();
    };
    for (const auto& [key, submap] : robot.submaps) {
      if (submap.T_map_submap) poses.poses.push_back({key, *submap.T_map_submap, submap.pose_revision});
      if (poses.poses.size() == perception::kMaxPiecePoses) add_poses();
      std::vector<perception::BlockUpdate> blocks;
      for (const auto& [index, block] : submap.blocks)
        blocks.push_back({{index, block.known, block.occupied}, block.revision});
      for (std::span<const perception::BlockUpdate> left(blocks); !left.empty();) {
        auto packed = perception::pack(key, left.first(std::min(left.size(), perception::kMaxPieceBlocks)),
                                       transfer::kMaxPieceBytes);
        if (packed.count == 0) break;
        left = left.subspan(packed.count);
        out.push_back({name, static_cast<std::uint8_t>(transfer::Kind::map_blocks), std::move(packed.bytes)});
      }
    }
    add_poses();
  }
  return out;
}

MapReplica::MapReplica(std::uint32_t start, std::shared_ptr<store::Disk> disk, Executor& home,
                       std::function<void(const std::string& text)> trouble, MapJournalParams journal)
    : home_(home), start_(start), journal_(journal, std::move(disk), home, std::move(trouble), [this] {
        // The copy takes a small part of the time that packing takes.
        return [chunks = std::make_shared<const ChunkStore>(chunks())] { return pieces_of(*chunks); };
      }) {}

std::string MapReplica::load() {
  LoadedJournal loaded = journal_.load();
  for (const JournalPiece& piece : loaded.pieces)
    if (const auto taken = receiver_.restore(piece.robot, piece.kind, piece.data); !taken) {
      if (loaded.lost.empty())
        loaded.lost =
            "a part of the map on the disk cannot be used, and robots send all again: " + taken.error().text +
            "; a copy is " + journal_.copy_aside();
      loaded.start = 0;
    }
  if (loaded.start != 0) start_ = loaded.start;
  for (const auto& [name, robot] : chunks().robots()) written_.insert(name);
  const bool long_file = loaded.bytes > std::max(kLongFile, kBytesOfBlock * chunks().blocks());
  if (loaded.start == 0 || loaded.unfinished || long_file)
    journal_.begin(start_, pieces_of(chunks()));
  else
    journal_.resume(start_, loaded.bytes);
  return loaded.lost;
}

Result<void> MapReplica::take(const std::string& robot, std::uint8_t kind, std::uint32_t waiting,
                              std::span<const std::uint8_t> data, std::function<void()> stored) {
  const Result<void> taken = receiver_.take(robot, kind, waiting, data, home_.now());
  if (chunks().evicted() != evicted_) forget_evicted();
  if (taken) {
    written_.insert(robot);
    journal_.add({robot, kind, {data.begin(), data.end()}}, std::move(stored));
  } else if (taken.reason() != Reason::malformed && taken.reason() != Reason::out_of_range) {
    // What does not fit, or will never be understood, would come again without end. Perhaps the next process
    // understands it, or has room.
    journal_.end_start(std::move(stored));
  }
  return taken;
}

/// Before a piece of the robot for which they made room: there may be no room for it when the file is read.
void MapReplica::forget_evicted() {
  evicted_ = chunks().evicted();
  std::erase_if(written_, [this](const std::string& name) {
    if (chunks().robots().contains(name)) return false;
    journal_.forget(name);
    return true;
  });
}

void MapReplica::forget(std::uint32_t start) {
  start_ = start;
  receiver_.forget();
  written_.clear();
  evicted_ = 0;
  journal_.begin(start_, {});
}

}  // namespace adit::station
