// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_receiver.hpp"

#include "core/command/words.hpp"
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
  if (transfer::is_carried(kind)) {
    // The robot that it is of does not count on it, so what does not fit is no loss.
    Result<void> taken = take_carried(robot, kind, 0, data, std::nullopt).taken;
    return !taken && taken.reason() == Reason::queue_full ? Result<void>() : taken;
  }
  if (!chunks_.count(robot, data.size(), 0, std::nullopt))
    return {Reason::queue_full, "no room for one more robot's map"};
  return store(robot, kind, data);
}

MapReceiver::Carried MapReceiver::store_carried(const std::string& carrier, std::uint8_t kind,
                                                std::span<const std::uint8_t> data, std::optional<Time> now) {
  if (data.size() > transfer::kMaxPieceBytes)
    return {{Reason::malformed, "a piece is longer than any robot sends"}, {}};
  const auto is_other = [&](const std::string& robot) {
    return robot != carrier && command::valid_name(robot);
  };
  Carried out;
  const auto note = [&out](bool complete) {
    if (!complete) out.taken = {Reason::queue_full, "no room for more of the maps that robots carry"};
  };
  if (kind == static_cast<std::uint8_t>(transfer::Kind::carried_blocks)) {
    auto piece = perception::decode(data);
    if (!piece) return {piece.error(), {}};
    if (!is_other(piece->key.robot))
      return {{Reason::malformed, "a carried piece that names no other robot"}, {}};
    note(chunks_.take_carried(carrier, *piece, data.size(), now));
    if (!piece->blocks.empty()) out.newer = perception::encode(*piece);
    return out;
  }
  auto poses = perception::decode_poses(data);
  if (!poses) return {poses.error(), {}};
  if (poses->poses.empty()) return out;
  for (const perception::SubmapPose& pose : poses->poses)
    if (!is_other(pose.key.robot) || pose.key.robot != poses->poses.front().key.robot)
      return {{Reason::malformed, "carried poses that name no other robot, or several"}, {}};
  note(chunks_.take_carried(carrier, *poses, data.size(), now));
  if (!poses->poses.empty()) out.newer = perception::encode(*poses);
  return out;
}

MapReceiver::Carried MapReceiver::take_carried(const std::string& carrier, std::uint8_t kind,
                                               std::uint32_t waiting, std::span<const std::uint8_t> data,
                                               std::optional<Time> now) {
  chunks_.note_waiting(carrier, waiting);
  Carried carried = store_carried(carrier, kind, data, now);
  if (!carried.taken) ++refused_;
  return carried;
}

}  // namespace adit::station
