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

/// What the robot itself sent of its map, or what carriers did.
void add_pieces(const std::string& name, const ChunkStore::RobotMap& robot, bool carried,
                std::vector<JournalPiece>& out) {
  const auto latest =
      std::max_element(robot.carriers.begin(), robot.carriers.end(),
                       [](const auto& a, const auto& b) { return a.second.last < b.second.last; });
  if (carried && latest == robot.carriers.end()) return;
  const std::string& sender = carried ? latest->first : name;
  const auto add = [&](transfer::Kind direct, transfer::Kind kind, std::vector<std::uint8_t> bytes) {
    out.push_back({sender, static_cast<std::uint8_t>(carried ? kind : direct), std::move(bytes)});
  };
  perception::SubmapPoses poses;
  const auto add_poses = [&] {
    if (poses.poses.empty()) return;
    add(transfer::Kind::map_poses, transfer::Kind::carried_poses, perception::encode(poses));
    poses.poses.clear();
  };
  // In this order, so that reading them gives the same order of the robots of one name.
  for (const perception::SubmapKey* named : by_age(robot)) {
    const perception::SubmapKey& key = *named;
    const ChunkStore::Submap& submap = robot.submaps.at(key);
    if (submap.T_map_submap && submap.pose_carried == carried)
      poses.poses.push_back({key, *submap.T_map_submap, submap.pose_revision});
    if (poses.poses.size() == perception::kMaxPiecePoses) add_poses();
    std::vector<perception::BlockUpdate> blocks;
    for (const auto& [index, block] : submap.blocks)
      if ((block.carried != 0) == carried) {
        const bool coarse = block.revision == perception::BlockUpdate::kCoarseRevision;
        // Of a block in large voxels the revision does not matter, and equal ones take no space.
        const std::uint32_t revision = !coarse ? block.revision : blocks.empty() ? 1 : blocks.back().revision;
        blocks.push_back({{index, block.known, block.occupied}, revision, coarse});
      }
    for (std::span<const perception::BlockUpdate> left(blocks); !left.empty();) {
      auto packed = perception::pack(key, left.first(std::min(left.size(), perception::kMaxPieceBlocks)),
                                     transfer::kMaxPieceBytes);
      if (packed.count == 0) break;
      left = left.subspan(packed.count);
      add(transfer::Kind::map_blocks, transfer::Kind::carried_blocks, std::move(packed.bytes));
    }
  }
  add_poses();
}

}  // namespace

std::vector<JournalPiece> pieces_of(const ChunkStore& chunks) {
  std::vector<JournalPiece> out;
  for (const auto& [name, robot] : chunks.robots())
    for (const bool carried : {false, true}) add_pieces(name, robot, carried, out);
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
  if (transfer::is_carried(kind)) return take_carried(robot, kind, waiting, data, std::move(stored));
  const Result<void> taken = receiver_.take(robot, kind, waiting, data, home_.now());
  if (chunks().evicted() != evicted_) forget_evicted();
  if (taken) {
    written_.insert(robot);
    journal_.add({robot, kind, {data.begin(), data.end()}}, std::move(stored));
  } else if (transfer::is_acknowledged(taken.reason())) {
    journal_.end_start(std::move(stored));  // Perhaps the next process understands it, or has room.
  }
  return taken;
}

/// Writes that robots were forgotten, before the piece of the robot that took their room: when the file is
/// read, there may be no room for both.
void MapReplica::forget_evicted() {
  evicted_ = chunks().evicted();
  std::erase_if(written_, [this](const std::string& name) {
    if (chunks().robots().contains(name)) return false;
    journal_.forget(name);
    return true;
  });
}

Result<void> MapReplica::take_carried(const std::string& carrier, std::uint8_t kind, std::uint32_t waiting,
                                      std::span<const std::uint8_t> data, std::function<void()> stored) {
  MapReceiver::Carried carried = receiver_.take_carried(carrier, kind, waiting, data, home_.now());
  // Only what was stored is written, as the reader of the file cannot know which robots were heard.
  if (!carried.newer.empty())
    journal_.add({carrier, kind, std::move(carried.newer)}, std::move(stored));
  else if (carried.taken || transfer::is_acknowledged(carried.taken.reason()))
    stored();
  return carried.taken;
}

void MapReplica::forget(std::uint32_t start) {
  start_ = start;
  receiver_.forget();
  written_.clear();
  evicted_ = 0;
  journal_.begin(start_, {});
}

}  // namespace adit::station
