// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/pose_source.hpp"

#include "perception/stream/piece.hpp"

namespace adit::agent {
namespace {

constexpr std::size_t kPosesInPiece = 40;
constexpr std::size_t kPoseBytes = 40;  // Of one pose in a piece, at most.
constexpr std::size_t kHeadBytes = 64;  // Of a piece beside them.

}  // namespace

void PoseSource::update(std::uint32_t submap, const Pose3& T_map_submap) {
  poses_[submap] = {T_map_submap, ++revisions_};
  for (auto& [id, lacks] : peers_) lacks.insert(submap);
}

void PoseSource::join(const transfer::PeerId& peer) {
  std::set<std::uint32_t>& lacks = peers_[peer];
  for (const auto& [submap, entry] : poses_) lacks.insert(submap);
}

std::size_t PoseSource::missing(const transfer::PeerId& peer) const {
  const auto found = peers_.find(peer);
  return found == peers_.end() ? 0 : found->second.size();
}

std::optional<transfer::Source::Content> PoseSource::next(std::span<const transfer::PeerId> peers,
                                                          std::size_t max_bytes, Time) {
  const auto first = peers_.find(peers.front());
  if (first == peers_.end() || first->second.empty() || max_bytes < kHeadBytes + kPoseBytes)
    return std::nullopt;
  const std::size_t room = std::min(kPosesInPiece, (max_bytes - kHeadBytes) / kPoseBytes);
  perception::SubmapPoses piece;
  std::vector<Part>& parts = flights_[++tokens_];
  for (auto it = first->second.rbegin(); it != first->second.rend() && parts.size() < room; ++it) {
    const Entry& entry = poses_.at(*it);
    piece.poses.push_back({{robot_, start_, *it}, entry.T_map_submap, entry.revision});
    parts.push_back({*it, entry.revision});
  }
  for (const Part& part : parts)
    for (const transfer::PeerId& id : peers)
      if (const auto peer = peers_.find(id); peer != peers_.end()) peer->second.erase(part.submap);
  return Content{tokens_, perception::encode(piece)};
}

void PoseSource::lost(const transfer::PeerId& peer, std::uint64_t token) {
  const auto found = peers_.find(peer);
  const auto flight = flights_.find(token);
  if (found == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second)
    if (poses_.at(part.submap).revision == part.revision) found->second.insert(part.submap);
}

}  // namespace adit::agent
