// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/pose_source.hpp"

namespace adit::agent {

void PoseSource::open(std::uint32_t submap, std::uint64_t start, std::uint32_t index,
                      std::uint32_t revision) {
  names_[submap] = {start, index, revision};
}

perception::SubmapPose PoseSource::content(std::uint32_t submap, const PlacedSubmap& entry) const {
  const auto named = names_.find(submap);
  if (named == names_.end()) return {{robot_, start_, submap}, entry.T_map_submap, entry.revision};
  const Name& name = named->second;
  return {{robot_, name.start, name.index}, entry.T_map_submap, entry.revision};
}

std::vector<std::pair<std::uint32_t, perception::SubmapPose>> PoseSource::poses() const {
  std::vector<std::pair<std::uint32_t, perception::SubmapPose>> out;
  for (const auto& [submap, entry] : poses_) out.emplace_back(submap, content(submap, entry));
  return out;
}

std::optional<perception::SubmapPose> PoseSource::pose(std::uint32_t submap) const {
  const auto found = poses_.find(submap);
  if (found == poses_.end()) return std::nullopt;
  return content(submap, found->second);
}

void PoseSource::drop(std::uint32_t submap) {
  ++changes_;
  poses_.erase(submap);
  names_.erase(submap);
  for (auto& [id, lacks] : peers_) lacks.erase(submap);
}

void PoseSource::update(std::uint32_t submap, const Pose3& T_map_submap) {
  ++changes_;
  const auto [found, added] = poses_.try_emplace(submap);
  const auto named = names_.find(submap);
  if (added && named != names_.end()) found->second.revision = named->second.revision;
  found->second.T_map_submap = T_map_submap;
  ++found->second.revision;
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
  if (first == peers_.end() || first->second.empty()) return std::nullopt;
  perception::SubmapPoses piece;
  std::vector<Part> parts;
  for (auto it = first->second.rbegin();
       it != first->second.rend() && parts.size() < perception::kMaxPiecePoses; ++it) {
    const PlacedSubmap& entry = poses_.at(*it);
    piece.poses.push_back(content(*it, entry));
    parts.push_back({*it, entry.revision});
  }
  std::vector<std::uint8_t> bytes = perception::pack(piece, max_bytes);
  if (bytes.empty()) return std::nullopt;
  parts.resize(piece.poses.size());
  for (const Part& part : parts)
    for (const transfer::PeerId& id : peers)
      if (const auto peer = peers_.find(id); peer != peers_.end()) peer->second.erase(part.submap);
  flights_[++tokens_] = std::move(parts);
  return Content{tokens_, std::move(bytes)};
}

void PoseSource::lost(const transfer::PeerId& peer, std::uint64_t token) {
  const auto found = peers_.find(peer);
  const auto flight = flights_.find(token);
  if (found == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second) {
    const auto pose = poses_.find(part.submap);
    if (pose != poses_.end() && pose->second.revision == part.revision) found->second.insert(part.submap);
  }
}

}  // namespace adit::agent
