// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "adit/bulk.h"
#include "basestation/map/map_receiver.hpp"
#include "basestation/map/merged_map.hpp"
#include "bench/map_link/counted_source.hpp"
#include "bench/map_link/rule.hpp"
#include "core/contract/bulk.hpp"
#include "core/transfer/receiver.hpp"
#include "core/transfer/sender.hpp"
#include "core/wire/typed.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/pose_source.hpp"

namespace adit::bench {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;

constexpr std::uint64_t kStart = 0x0123456789abcdefU;
constexpr transfer::PeerId kStation{1, 2, 3};

/// One robot's side.
struct AditRobot {
  AditRobot(std::string robot, std::uint32_t session, perception::FindStored find_stored)
      : name(std::move(robot)),
        poses(name, kStart),
        blocks({.robot = name, .start = kStart}),
        counted(blocks, std::move(find_stored)),
        sender({.session = session}) {
    sender.add(poses);
    sender.add(counted);
  }

  std::string name;
  agent::PoseSource poses;
  agent::BlockSource blocks;
  CountedSource counted;
  transfer::Sender sender;
  std::map<std::uint32_t, BlockIndex> offsets{};  ///< By submap.
  std::uint64_t pose_bytes{};
  Account rounds{};
  /// All that this robot ever saw, by submap.
  std::map<std::uint32_t, std::map<BlockIndex, CoarseBlock>> own{};
  LatticeMap merged{};
  LatticeMap shown{};  ///< At the station.
};

class AditRule final : public Rule {
 public:
  explicit AditRule(const Mission& mission) : mission_(mission) {
    for (std::size_t i = 0; i < mission.robots.size(); ++i)
      robots_.push_back(std::make_unique<AditRobot>(
          mission.robots[i].robot, static_cast<std::uint32_t>(2 * (mission.seed + i) + 1), find_stored()));
  }

  void update(std::size_t robot, const MapUpdate& update) override {
    AditRobot& r = *robots_[robot];
    const agent::MapStep& step = update.step;
    const auto [found, opened] = r.offsets.try_emplace(step.submap, lattice_offset(step.T_odom_submap));
    if (opened) {
      r.blocks.open(step.submap, {kStart, step.submap, step.odom_epoch, found->second});
      r.poses.open(step.submap, kStart, step.submap, 0);
      r.poses.update(step.submap, mission_.robots[robot].T_map_odom * step.T_odom_submap);
    }
    r.blocks.tick(mission_.air.now());
    for (const CoarseBlock& block : step.blocks) {
      r.blocks.update(step.submap, block);
      r.own[step.submap][block.index] = block;
      mission_.watch.robot_has(robot, r.merged.set(step.submap, block, found->second), mission_.air.now());
    }
  }

  void tick() override {
    for (std::size_t i = 0; i < robots_.size(); ++i) send(i);
    if (++ticks_ % 2 == 0) acknowledge();
  }

  bool settled() const override {
    return std::all_of(robots_.begin(), robots_.end(), [](const auto& r) {
      return r->sender.in_flight() == 0 && r->blocks.missing(kStation) == 0 &&
             r->poses.missing(kStation) == 0 && r->sender.peers() > 0;
    });
  }

  Account account() const override {
    Account out;
    for (const auto& r : robots_) {
      out.add(r->counted.account());
      out.add(r->rounds);
      out.content += r->pose_bytes;
      out.poses += r->pose_bytes;
    }
    return out;
  }

  std::size_t different_voxels() const override {
    std::size_t out = 0;
    for (const auto& r : robots_) out += different_voxels(*r);
    return out;
  }

 private:
  perception::FindStored find_stored() const {
    return [this](const auto& key, const BlockIndex& index) { return station_.chunks().find(key, index); };
  }

  void send(std::size_t robot) {
    AditRobot& r = *robots_[robot];
    Air& air = mission_.air;
    const std::size_t missing = r.counted.missing(kStation);
    const std::uint64_t asked = r.counted.asked();
    const std::vector<transfer::Piece> pieces = r.sender.due(air.now(), air.sender(Air::robot(robot)));
    ++r.rounds.ticks;
    if (missing > 0 && pieces.empty()) ++(r.counted.asked() > asked ? r.rounds.held : r.rounds.paced);
    for (const transfer::Piece& piece : pieces) {
      if (piece.kind == transfer::Kind::map_poses)
        r.pose_bytes += piece.data.size();
      else
        note_sent(robot, piece);
      wire::encode(
          encode(contract::BulkPiece{r.name, r.sender.session(), piece.id,
                                     static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data}),
          buffer_);
      air.send(Air::robot(robot), Air::kStation, buffer_.size(),
               [this, robot, session = r.sender.session(), piece] { arrived(robot, session, piece); });
    }
  }

  void note_sent(std::size_t robot, const transfer::Piece& piece) {
    const auto decoded = perception::decode(piece.data, find_stored());
    if (!decoded) return;
    for (const perception::BlockUpdate& update : decoded->blocks)
      mission_.watch.was_sent(robot, lattice(robot, decoded->key.index, update.block.index),
                              update.block.known, mission_.air.now());
  }

  void arrived(std::size_t robot, std::uint32_t session, const transfer::Piece& piece) {
    AditRobot& r = *robots_[robot];
    const Time now = mission_.air.now();
    const auto decoded = perception::decode(piece.data, find_stored());
    const auto kind = static_cast<std::uint8_t>(piece.kind);
    if (!station_.take(r.name, kind, piece.waiting, piece.data, now)) return;
    receiver_.take(r.name, session, piece.id, now);
    std::set<std::uint32_t> placed;
    if (piece.kind == transfer::Kind::map_poses) {
      // Blocks that were here before the pose of their submap are shown from now on.
      for (const auto& pose : perception::decode_poses(piece.data)->poses) placed.insert(pose.key.index);
      for (const std::uint32_t submap : placed)
        if (const auto* known = stored(r, submap))
          for (const auto& [index, block] : known->blocks) show(robot, submap, index, block);
      return;
    }
    const auto* known = stored(r, decoded->key.index);
    if (known == nullptr || !known->T_map_submap) return;
    for (const perception::BlockUpdate& update : decoded->blocks)
      show(robot, decoded->key.index, update.block.index, known->blocks.at(update.block.index));
  }

  void show(std::size_t robot, std::uint32_t submap, const BlockIndex& index,
            const station::ChunkStore::Block& block) {
    AditRobot& r = *robots_[robot];
    const CoarseBlock shown = r.shown.set(submap, {index, block.known, block.occupied}, r.offsets.at(submap));
    mission_.watch.station_shows(robot, shown, mission_.air.now());
  }

  void acknowledge() {
    const auto receipts = receiver_.due(mission_.air.now(), mission_.air.link().bandwidth);
    if (!receipts) return;
    const contract::BulkAck sent{
        .station = "base", .station_id = kStation, .start = 1, .receipts = *receipts};
    wire::encode(encode(sent), buffer_);
    for (std::size_t i = 0; i < robots_.size(); ++i)
      mission_.air.send(Air::kStation, Air::robot(i), buffer_.size(),
                        [this, i, ack = sent.to(robots_[i]->name)] {
                          robots_[i]->sender.acknowledged(ack, mission_.air.now());
                        });
  }

  BlockIndex lattice(std::size_t robot, std::uint32_t submap, const BlockIndex& index) const {
    const BlockIndex offset = robots_[robot]->offsets.at(submap);
    return {index.x + offset.x, index.y + offset.y, index.z + offset.z};
  }

  const station::ChunkStore::Submap* stored(const AditRobot& r, std::uint32_t submap) const {
    return station_.chunks().find({r.name, kStart, submap});
  }

  /// Merges all that the robot saw, and what the station has, in the lattice of the robot's odometry.
  std::size_t different_voxels(const AditRobot& r) const {
    std::vector<station::MapPart> own, shown;
    for (const auto& [submap, blocks] : r.own) {
      const BlockIndex& offset = r.offsets.at(submap);
      const Pose3 at{static_cast<double>(BlockIndex::kSize) * Eigen::Vector3d(offset.x, offset.y, offset.z),
                     Eigen::Quaterniond::Identity()};
      station::MapPart all{at, {}, false}, there{at, {}, false};
      for (const auto& [index, block] : blocks) all.blocks.push_back(block);
      own.push_back(std::move(all));
      const auto* known = stored(r, submap);
      if (known == nullptr || !known->T_map_submap) continue;
      for (const auto& [index, block] : known->blocks)
        there.blocks.push_back({index, block.known, block.occupied});
      shown.push_back(std::move(there));
    }
    const auto a = station::merged(own, nullptr, 0.2), b = station::merged(shown, nullptr, 0.2);
    std::size_t out = 0;
    a.for_each([&](const auto& at, perception::Voxel voxel) { out += b.at(at) != voxel ? 1 : 0; });
    b.for_each([&](const auto& at, perception::Voxel voxel) {
      out += voxel != perception::Voxel::unknown && a.at(at) == perception::Voxel::unknown ? 1 : 0;
    });
    return out;
  }

  Mission mission_;
  std::vector<std::unique_ptr<AditRobot>> robots_{};
  station::MapReceiver station_{};
  transfer::Receiver receiver_{};
  std::vector<std::uint8_t> buffer_{};
  std::uint64_t ticks_{};
};

}  // namespace

std::unique_ptr<Rule> make_adit_rule(const Mission& mission) { return std::make_unique<AditRule>(mission); }

}  // namespace adit::bench
