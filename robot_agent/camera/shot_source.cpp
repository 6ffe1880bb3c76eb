// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/shot_source.hpp"

#include <algorithm>

#include "core/store/crc32c.hpp"
#include "core/transfer/shot_piece.hpp"

namespace adit::agent {

using transfer::kShotBlock;

void ShotSource::add(TakenShot shot, Time now) {
  if (shot.jpeg.empty() || shot.jpeg.size() > transfer::ShotPiece::kMaxPicture) return;
  std::erase_if(shots_, [&](const Shot& each) {  // A repeated request.
    return each.taken.station == shot.station && each.taken.number == shot.number;
  });
  if (shots_.size() >= kMost) {  // A station never costs another one its picture.
    const auto own =
        std::ranges::find_if(shots_, [&](const Shot& each) { return each.taken.station == shot.station; });
    if (own == shots_.end()) return;
    shots_.erase(own);
  }
  Shot& added = shots_.emplace_back();
  added.id = ++ids_;
  added.crc = crc32c(shot.jpeg);
  added.added = now;
  added.blocks.begin((shot.jpeg.size() + kShotBlock - 1) / kShotBlock);
  added.taken = std::move(shot);
}

void ShotSource::wanted(const transfer::PeerId& station, const std::string& camera, std::uint32_t number) {
  std::erase_if(shots_, [&](const Shot& each) {
    return each.taken.station == station && each.taken.camera == camera && each.taken.number != number;
  });
}

void ShotSource::tick(Time now) {
  std::erase_if(shots_, [&](const Shot& shot) { return now - shot.added > kPatience; });
}

ShotSource::Shot* ShotSource::find(std::uint64_t id) {
  const auto found = std::ranges::find(shots_, id, &Shot::id);
  return found != shots_.end() ? &*found : nullptr;
}

void ShotSource::join(const transfer::PeerId& peer) {
  for (Shot& shot : shots_)
    if (shot.taken.station == peer) shot.blocks.begin(shot.blocks.has.size());
}

void ShotSource::leave(const transfer::PeerId& peer) {
  for (Shot& shot : shots_)
    if (shot.taken.station == peer) shot.blocks.lost(0, shot.blocks.has.size());
}

std::size_t ShotSource::missing(const transfer::PeerId& peer) const {
  std::size_t sum = 0;
  for (const Shot& shot : shots_)
    if (shot.taken.station == peer) sum += shot.blocks.left;
  return sum;
}

std::optional<transfer::Source::Content> ShotSource::next(std::span<const transfer::PeerId> peers,
                                                          std::size_t max_bytes, Time now) {
  const auto wanted = std::ranges::find_if(shots_, [&](const Shot& shot) {
    return shot.blocks.left > 0 && !peers.empty() && shot.taken.station == peers.front();
  });
  if (wanted == shots_.end()) return std::nullopt;
  Shot& shot = *wanted;
  std::size_t first = 0;
  while (!shot.blocks.lacks(first)) ++first;  // It lacks one, as some are left.
  transfer::ShotPiece piece{.camera = shot.taken.camera,
                            .number = shot.taken.number,
                            .stamp = shot.taken.stamp,
                            .age = shot.taken.age + static_cast<std::uint32_t>((now - shot.added) / 1ms),
                            .bytes = static_cast<std::uint32_t>(shot.taken.jpeg.size()),
                            .crc = shot.crc,
                            .first = static_cast<std::uint16_t>(first)};
  if (shot.taken.T_map_base) {
    const Eigen::Vector3d& at = shot.taken.T_map_base->position;
    piece.place = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()),
                   static_cast<float>(shot.taken.T_map_base->yaw())};
  }
  const std::size_t room = max_bytes > piece.head() ? max_bytes - piece.head() : 0;
  const std::size_t most = std::max<std::size_t>(1, room / kShotBlock);
  std::size_t count = 0;
  for (; count < most && shot.blocks.lacks(first + count); ++count) shot.blocks.sent(first + count);
  const std::size_t begin = first * kShotBlock;
  const std::size_t end = std::min(shot.taken.jpeg.size(), (first + count) * kShotBlock);
  piece.data.assign(shot.taken.jpeg.begin() + static_cast<std::ptrdiff_t>(begin),
                    shot.taken.jpeg.begin() + static_cast<std::ptrdiff_t>(end));
  flights_[++tokens_] = {shot.id, first, count};
  return Content{tokens_, encode(piece)};
}

void ShotSource::acknowledged(const transfer::PeerId& peer, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end()) return;
  Shot* shot = find(flight->second.shot);
  if (shot == nullptr || shot->taken.station != peer) return;
  shot->blocks.acknowledged(flight->second.first, flight->second.count);
  if (shot->blocks.complete())
    std::erase_if(shots_, [id = shot->id](const Shot& each) { return each.id == id; });
}

void ShotSource::lost(const transfer::PeerId& peer, std::uint64_t token) {
  const auto flight = flights_.find(token);
  if (flight == flights_.end()) return;
  Shot* shot = find(flight->second.shot);
  if (shot == nullptr || shot->taken.station != peer) return;
  shot->blocks.lost(flight->second.first, flight->second.count);
}

}  // namespace adit::agent
