// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/carrier.hpp"

#include "core/time/random.hpp"

namespace adit::agent {

Carrier::Carrier(std::uint64_t seed, CarryBounds bounds)
    : poses_(bounds, [this](const transfer::PeerId& station,
                            const std::string& robot) { return views_.wants(station, robot, now_); }),
      blocks_(bounds, [this](const transfer::PeerId& station, const std::string& robot) {
        return views_.wants(station, robot, now_);
      }) {
  Random random(seed);
  for (std::uint8_t& byte : id_) byte = static_cast<std::uint8_t>(random.below(256));
}

Result<void> Carrier::store(const contract::BulkPiece& piece) {
  const Error no_room{Reason::queue_full, "no room to carry more of the map"};
  if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::map_blocks)) {
    const auto blocks = perception::decode(
        piece.data,
        [this](const auto& key, const perception::BlockIndex& index) { return blocks_.find(key, index); });
    if (!blocks) return blocks.error();
    if (blocks->key.robot != piece.robot) return {Reason::malformed, "a piece of another robot's map"};
    if (!blocks_.take(*blocks)) return no_room;
    return {};
  }
  if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::map_poses)) {
    const auto poses = perception::decode_poses(piece.data);
    if (!poses) return poses.error();
    for (const perception::SubmapPose& pose : poses->poses)
      if (pose.key.robot != piece.robot) return {Reason::malformed, "poses of another robot's map"};
    if (!poses_.take(piece.robot, *poses)) return no_room;
    return {};
  }
  return {Reason::not_supported, "no part of a map"};
}

Result<void> Carrier::take(const contract::BulkPiece& piece, Time now) {
  const Result<void> stored = store(piece);
  if (!stored) ++refused_;
  if (stored || transfer::is_acknowledged(stored.reason()))
    (void)receiver_.take(piece.robot, piece.session, piece.id, now);
  return stored;
}

void Carrier::heard(const transfer::Ack& ack, Time now) {
  now_ = now;
  views_.heard(ack, now);
  for (const transfer::ContentDigest& digest : ack.digests) {
    poses_.compare(ack.peer, digest);
    blocks_.compare(ack.peer, digest);
  }
}

}  // namespace adit::agent
