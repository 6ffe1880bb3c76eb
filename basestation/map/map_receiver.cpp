// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_receiver.hpp"

#include "core/transfer/piece.hpp"

namespace adit::station {

Result<void> MapReceiver::store(const std::string& robot, std::uint8_t kind,
                                std::span<const std::uint8_t> data) {
  if (data.size() > transfer::kMaxPieceBytes)
    return {Reason::malformed, "a piece is longer than any robot sends"};
  if (kind == static_cast<std::uint8_t>(transfer::Kind::map_blocks)) {
    const auto piece = perception::decode(data, [this](const auto& key, const perception::BlockIndex& index) {
      return chunks_.find(key, index);
    });
    if (!piece) return piece.error();
    if (piece->key.robot != robot) return {Reason::malformed, "a piece of another robot's map"};
    if (!chunks_.take(robot, *piece)) return {Reason::queue_full, "no room for more of the map"};
    return {};
  }
  if (kind == static_cast<std::uint8_t>(transfer::Kind::map_poses)) {
    const auto poses = perception::decode_poses(data);
    if (!poses) return poses.error();
    for (const perception::SubmapPose& pose : poses->poses)
      if (pose.key.robot != robot) return {Reason::malformed, "poses of another robot's map"};
    if (!chunks_.take(robot, *poses)) return {Reason::queue_full, "no room for more of the map"};
    return {};
  }
  return {Reason::not_supported, "a piece of a kind that this release does not know"};
}

Result<void> MapReceiver::take(const std::string& robot, std::uint8_t kind, std::uint32_t waiting,
                               std::span<const std::uint8_t> data, Time now) {
  if (!chunks_.count(robot, data.size(), waiting, now)) {
    ++refused_;
    return {Reason::queue_full, "no room for one more robot's map"};
  }
  const Result<void> stored = store(robot, kind, data);
  if (!stored) ++refused_;
  return stored;
}

Result<void> MapReceiver::restore(const std::string& robot, std::uint8_t kind,
                                  std::span<const std::uint8_t> data) {
  if (!chunks_.count(robot, data.size(), 0, std::nullopt))
    return {Reason::queue_full, "no room for one more robot's map"};
  return store(robot, kind, data);
}

}  // namespace adit::station
