// SPDX-License-Identifier: Apache-2.0
#include "basestation/camera/shot_desk.hpp"

#include <algorithm>
#include <set>

#include "core/store/crc32c.hpp"
#include "core/transfer/shot_piece.hpp"

namespace adit::station {

using transfer::kShotBlock;

std::uint32_t ShotDesk::await(const std::string& robot, const std::string& camera, Time now, Done done) {
  if (all_.size() >= kMost) return 0;
  if (++last_ == 0) ++last_;
  all_[last_] = {.robot = robot, .camera = camera, .order = ++orders_, .since = now, .done = std::move(done)};
  return last_;
}

std::uint32_t ShotDesk::awaited(const std::string& robot, const std::string& camera) const {
  std::uint32_t oldest = 0;
  for (const auto& [number, awaited] : all_)
    if (awaited.robot == robot && awaited.camera == camera &&
        (oldest == 0 || awaited.order < all_.at(oldest).order))
      oldest = number;
  return oldest;
}

void ShotDesk::asked(std::uint32_t number, Time now) {
  const auto found = all_.find(number);
  if (found != all_.end() && !found->second.last) found->second.last = now;
}

std::vector<std::pair<std::string, std::string>> ShotDesk::awaited_cameras() const {
  std::set<std::pair<std::string, std::string>> out;
  for (const auto& [number, awaited] : all_) out.emplace(awaited.robot, awaited.camera);
  return {out.begin(), out.end()};
}

Result<void> ShotDesk::take(const std::string& robot, std::span<const std::uint8_t> bytes, Time now) {
  const auto piece = transfer::decode_shot_piece(bytes);
  if (!piece) return piece.error();
  const auto found = all_.find(piece->number);
  if (found == all_.end() || found->second.robot != robot || found->second.camera != piece->camera) return {};
  Awaited& awaited = found->second;
  if (awaited.blocks.empty() || awaited.crc != piece->crc || awaited.bytes != piece->bytes) {
    // The first piece; or the robot was restarted, and took another picture.
    awaited.bytes = piece->bytes;
    awaited.crc = piece->crc;
    awaited.here = 0;
    awaited.blocks.assign((piece->bytes + kShotBlock - 1) / kShotBlock, false);
    awaited.jpeg.assign(piece->bytes, 0);
  }
  awaited.last = now;
  std::copy(piece->data.begin(), piece->data.end(),
            awaited.jpeg.begin() + static_cast<std::ptrdiff_t>(piece->first * kShotBlock));
  const std::size_t count = (piece->data.size() + kShotBlock - 1) / kShotBlock;
  for (std::size_t i = piece->first; i < piece->first + count; ++i) {
    awaited.here += awaited.blocks[i] ? 0 : 1;
    awaited.blocks[i] = true;
  }
  if (awaited.here < awaited.blocks.size()) return {};
  if (crc32c(awaited.jpeg) != awaited.crc) {
    awaited.blocks.clear();
    return {Reason::malformed, "a picture is damaged as a whole"};
  }
  finish(piece->number,
         ShotPicture{std::move(awaited.jpeg), static_cast<double>(piece->age) / 1000.0, piece->place});
  return {};
}

void ShotDesk::finish(std::uint32_t number, const Result<ShotPicture>& result) {
  const auto ended = all_.extract(number);
  if (!ended.empty()) ended.mapped().done(result);
}

void ShotDesk::tick(Time now) {
  std::vector<std::uint32_t> late;
  for (const auto& [number, awaited] : all_) {
    const Duration patience = awaited.blocks.empty() ? kFirst : kSilence;
    if (awaited.last ? now - *awaited.last > patience : now - awaited.since > kPatience)
      late.push_back(number);
  }
  for (const std::uint32_t number : late) {
    const Awaited& awaited = all_.at(number);
    const std::string text = awaited.blocks.empty()
                                 ? "no picture came: does its camera " + awaited.camera + " work? `health " +
                                       awaited.robot + "` says what its driver sends"
                                 : "the rest of the picture does not come: the robot is not heard";
    finish(number, Error{Reason::no_answer, text});
  }
}

void ShotDesk::cancel_all() {
  while (!all_.empty()) finish(all_.begin()->first, Error{Reason::cancelled, "the station ends"});
}

double ShotDesk::progress(std::uint32_t number) const {
  const auto found = all_.find(number);
  if (found == all_.end() || found->second.blocks.empty()) return 0.0;
  return static_cast<double>(found->second.here) / static_cast<double>(found->second.blocks.size());
}

}  // namespace adit::station
