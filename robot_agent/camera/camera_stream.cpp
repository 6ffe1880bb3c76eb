// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/camera_stream.hpp"

#include <algorithm>
#include <utility>

namespace adit::agent {
namespace {

constexpr double kLeastRate = 0.1;  // Pictures/s that a station can ask for.

}  // namespace

void CameraStream::look(const transfer::PeerId& station, const contract::CameraView& view, Time now) {
  if (!lookers_.contains(station) && lookers_.size() >= kMaxLookers) {
    std::erase_if(lookers_, [&](const auto& each) { return each.second.until < now; });
    if (lookers_.size() >= kMaxLookers) return;
  }
  Looker& looker = lookers_[station];
  if (view.shot != looker.view.shot) looker.shot_since = now;
  const bool begins = looker.until < now || looker.view.width == 0;
  if (view.width > 0 && begins) {
    all_stripes_ = true;
    looker.reported = false;
    if (!is_watched(now)) base_ = {}, outgoing_.clear();  // What is left is of another time.
  }
  if (view.run == run_ && view.frame <= frame_) {
    // What was sent before a station began to look, or as it did, says nothing of its link.
    if (looker.reported && view.arrived >= looker.arrived && pieces_ >= looker.sent) {
      arrivals_.sent += pieces_ - looker.sent;
      arrivals_.arrived += view.arrived - looker.arrived;
    }
    looker.reported = true;
    looker.arrived = view.arrived;
    looker.sent = pieces_;
    if (view.frame >= format_since_ && !begins) {
      missing_.resize(std::max(missing_.size(), view.missing.size()));
      for (std::size_t i = 0; i < view.missing.size(); ++i) missing_[i] |= view.missing[i];
    }
  }
  looker.view = view;
  looker.until = now + kLooks;
}

bool CameraStream::is_watched(Time now) const {
  return std::ranges::any_of(
      lookers_, [&](const auto& each) { return each.second.until > now && each.second.view.width > 0; });
}

bool CameraStream::shot_wanted(Time now) const {
  return std::ranges::any_of(lookers_, [&](const auto& each) { return each.second.wants_shot(now); });
}

void CameraStream::adapt(double bytes_per_second, Time now) {
  perception::LadderInput input{.bytes_per_second = bytes_per_second};
  for (const auto& [station, looker] : lookers_)
    if (looker.until > now) {
      input.most_width = std::max(input.most_width, looker.view.width);
      if (looker.view.width > 0)
        input.most_rate =
            std::max(input.most_rate, std::max(kLeastRate, static_cast<double>(looker.view.rate)));
    }
  choice_ = ladder_.choose(input, now);
}

bool CameraStream::is_ready(Time now) const {
  return !coding_ && outgoing_.empty() && now >= base_ + choice_.period && choice_.rung.width > 0 &&
         choice_.period < perception::Ladder::kNoPicture && is_watched(now);
}

void CameraStream::begin(Time now) {
  coding_ = true;
  // From the time at which it was due, so that a rate is kept, but never earlier than half a period from now.
  base_ = std::max(base_ + choice_.period, now - choice_.period / 2);
}

void CameraStream::failed() {
  coding_ = false;
  // A job that hangs may still use the one before.
  encoder_ = std::make_shared<perception::StripeEncoder>();
}

void CameraStream::prepare_encoder() {
  if (std::exchange(all_stripes_, false)) encoder_->reset();
  if (!missing_.empty()) encoder_->missing(missing_);
  missing_.clear();
}

void CameraStream::coded(perception::StripeEncoder::Coded picture, std::uint64_t stamp,
                         const std::optional<Pose3>& T_map_camera, Time exposed, std::size_t most, Time now) {
  coding_ = false;
  if (!is_watched(now)) return;
  ++frame_;
  if (picture.format != format_) {
    format_ = picture.format;
    format_since_ = frame_;
  }
  perception::PictureHeader header{
      .run = run_, .frame = frame_, .format = picture.format, .stamp = stamp, .digest = picture.digest};
  if (T_map_camera) {
    const Eigen::Vector3f at = T_map_camera->position.cast<float>();
    const Eigen::Quaternionf q = T_map_camera->orientation.cast<float>().normalized();
    header.pose = perception::CameraPose{{at.x(), at.y(), at.z()}, {q.x(), q.y(), q.z(), q.w()}};
  }
  const bool whole = picture.whole;
  std::size_t bytes = 0;
  for (perception::PicturePiece& piece : perception::cut(header, std::move(picture.stripes), most)) {
    for (const perception::Stripe& stripe : piece.stripes)
      bytes += stripe.data.size() + perception::kStripeBytes;
    bytes += perception::kPictureHeaderBytes + transfer::kPieceOverhead;
    outgoing_.push_back(std::move(piece));
  }
  ladder_.coded(choice_.rung, bytes, whole);
  exposed_ = exposed;
}

std::vector<std::uint8_t> CameraStream::next_piece(Time now) {
  perception::PicturePiece piece = std::move(outgoing_.front());
  outgoing_.pop_front();
  ++pieces_;
  const auto age = std::max<std::int64_t>(0, (now - exposed_) / std::chrono::milliseconds(1));
  piece.header.age = static_cast<std::uint16_t>(std::min<std::int64_t>(age, UINT16_MAX));
  return encode(piece);
}

std::vector<std::pair<transfer::PeerId, std::uint32_t>> CameraStream::wanted_shots(Time now) const {
  std::vector<std::pair<transfer::PeerId, std::uint32_t>> out;
  for (const auto& [station, looker] : lookers_)
    if (looker.wants_shot(now)) out.emplace_back(station, looker.view.shot);
  return out;
}

void CameraStream::took_shot(const transfer::PeerId& station, std::uint32_t number) {
  const auto looker = lookers_.find(station);
  if (looker != lookers_.end()) looker->second.shot_done = number;
}

CameraStream::Arrivals CameraStream::take_arrivals() { return std::exchange(arrivals_, {}); }

}  // namespace adit::agent
