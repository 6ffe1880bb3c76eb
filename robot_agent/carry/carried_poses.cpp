// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/carried_poses.hpp"

#include <algorithm>

namespace adit::agent {
namespace {

using perception::MapDigest;
using transfer::PeerId;

}  // namespace

std::size_t CarriedPoses::Robot::missing(std::size_t slot) const {
  return static_cast<std::size_t>(std::count_if(poses.begin(), poses.end(), [slot](const auto& entry) {
    return (entry.second.had_by & PeerSlots::bit(slot)) == 0;
  }));
}

bool CarriedPoses::take(const std::string& name, const perception::SubmapPoses& poses) {
  if (!robots_.contains(name) && robots_.size() >= bounds_.max_robots) return false;
  Robot& robot = robots_[name];
  bool complete = true;
  for (const perception::SubmapPose& pose : poses.poses) {
    const auto known = robot.poses.find(pose.key);
    if (known == robot.poses.end() && robot.poses.size() >= bounds_.max_submaps) {
      complete = false;
      continue;
    }
    if (known != robot.poses.end()) {
      if (pose.revision <= known->second.pose.revision) continue;
      robot.sum -= MapDigest::hash(pose.key, known->second.pose.revision);
    }
    robot.sum += MapDigest::hash(pose.key, pose.revision);
    robot.poses[pose.key] = {pose, 0};
  }
  return complete;
}

void CarriedPoses::compare(const PeerId& station, const transfer::ContentDigest& digest) {
  const auto slot = slots_.find(station);
  const auto robot = robots_.find(digest.robot);
  if (!slot || robot == robots_.end() || robot->second.sum != digest.parts[MapDigest::kPoses]) return;
  for (auto& [key, entry] : robot->second.poses) entry.had_by |= PeerSlots::bit(*slot);
}

void CarriedPoses::join(const PeerId& peer) {
  const auto slot = slots_.join(peer);
  if (!slot) return;
  for (auto& [name, robot] : robots_)
    for (auto& [key, entry] : robot.poses) entry.had_by &= static_cast<std::uint16_t>(~PeerSlots::bit(*slot));
}

std::size_t CarriedPoses::missing(const PeerId& peer) const {
  const auto slot = slots_.find(peer);
  if (!slot) return 0;
  std::size_t out = 0;
  for (const auto& [name, robot] : robots_)
    if (wants_(peer, name)) out += robot.missing(*slot);
  return out;
}

std::optional<transfer::Source::Content> CarriedPoses::next(std::span<const PeerId> peers,
                                                            std::size_t max_bytes, Time) {
  Robot* from = nullptr;
  std::size_t first = 0;
  for (auto peer = peers.begin(); peer != peers.end() && from == nullptr; ++peer) {
    const auto slot = slots_.find(*peer);
    for (auto robot = robots_.begin(); slot && robot != robots_.end() && from == nullptr; ++robot)
      if (wants_(*peer, robot->first) && robot->second.missing(*slot) > 0) {
        from = &robot->second;
        first = *slot;
      }
  }
  if (from == nullptr) return std::nullopt;
  perception::SubmapPoses piece;
  for (auto it = from->poses.rbegin();
       it != from->poses.rend() && piece.poses.size() < perception::kMaxPiecePoses; ++it)
    if ((it->second.had_by & PeerSlots::bit(first)) == 0) piece.poses.push_back(it->second.pose);
  std::vector<std::uint8_t> bytes = perception::pack(piece, max_bytes);
  if (bytes.empty()) return std::nullopt;
  Flight& flight = flights_[++tokens_];
  for (const perception::SubmapPose& pose : piece.poses) {
    flight.emplace_back(pose.key, pose.revision);
    for (const PeerId& peer : peers)
      if (const auto slot = slots_.find(peer)) from->poses.at(pose.key).had_by |= PeerSlots::bit(*slot);
  }
  return Content{tokens_, std::move(bytes)};
}

void CarriedPoses::lost(const PeerId& peer, std::uint64_t token) {
  const auto slot = slots_.find(peer);
  const auto flight = flights_.find(token);
  if (!slot || flight == flights_.end()) return;
  for (const auto& [key, revision] : flight->second) {
    CarriedPose& entry = robots_.at(key.robot).poses.at(key);
    if (entry.pose.revision == revision) entry.had_by &= static_cast<std::uint16_t>(~PeerSlots::bit(*slot));
  }
}

}  // namespace adit::agent
