// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/ladder.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr double kRoomUp = 1.5;  ///< Times the least rate, before a rung is entered.
constexpr Duration kRoomTime = 3s;
constexpr double kLearn = 0.2;     ///< Weight of a picture in the means.
constexpr int kFirstPictures = 5;  ///< Of a rung, from which its own size is learned.
constexpr double kMinOwn = 0.25, kMaxOwn = 4.0;

struct RungPrior {
  Rung rung{};
  double bytes{};  ///< Of a whole picture, measured on drives through streets (bench_camera).
};

constexpr std::array kLadder{
    RungPrior{{80, 60, false, 20, 0.1, 2.0}, 1'000},       RungPrior{{160, 120, false, 15, 0.9, 2.0}, 1'900},
    RungPrior{{160, 120, false, 25, 1.1, 2.0}, 2'400},     RungPrior{{160, 120, true, 30, 1.3, 4.0}, 3'200},
    RungPrior{{320, 240, true, 25, 1.3, 4.0}, 7'000},      RungPrior{{320, 240, true, 35, 1.4, 4.0}, 8'500},
    RungPrior{{320, 240, true, 50, 3.0, 10.0}, 11'000},    RungPrior{{640, 480, true, 35, 6.0, 15.0}, 26'000},
    RungPrior{{640, 480, true, 50, 10.0, 15.0}, 33'000},   RungPrior{{640, 480, true, 70, 9.6, 15.0}, 46'000},
    RungPrior{{1280, 720, true, 75, 10.0, 15.0}, 140'000},
};

constexpr auto kAllRungs = [] {
  std::array<Rung, kLadder.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = kLadder[i].rung;
  return all;
}();

}  // namespace

std::span<const Rung> rungs() { return kAllRungs; }

Ladder::Ladder() {
  static_assert(kRungs == kLadder.size());
  own_.fill(1.0);
}

double Ladder::whole_bytes(std::size_t rung) const { return kLadder[rung].bytes * scene_ * own_[rung]; }

std::size_t Ladder::highest(const LadderInput& input, double room) const {
  // More pixels than are looked at are of no use.
  std::uint16_t widest = kLadder.back().rung.width;
  for (std::size_t i = kRungs; i-- > 0;)
    if (kLadder[i].rung.width >= input.most_width) widest = kLadder[i].rung.width;
  std::size_t best = 0;
  for (std::size_t i = 1; i < kRungs; ++i) {
    if (kLadder[i].rung.width > widest) break;
    const double rate = std::min(kLadder[i].rung.least_rate * room, input.most_rate);
    if (whole_bytes(i) * rate <= input.bytes_per_second) best = i;
  }
  return best;
}

Ladder::Choice Ladder::choose(const LadderInput& input, Time now) {
  const bool wanted = input.most_width > 0 && input.most_rate > 0.0 && input.bytes_per_second > 0.0;
  if (!wanted) return {kLadder[rung_.value_or(0)].rung, kNoPicture};
  const std::size_t before = rung_.value_or(kRungs);
  const std::size_t up = highest(input, kRoomUp), stay = highest(input, 1.0);
  if (!rung_) {
    rung_ = up;
  } else if (stay < *rung_) {
    rung_ = stay;
    room_since_.reset();
  } else if (up <= *rung_) {
    room_since_.reset();
  } else if (!room_since_) {
    room_since_ = now;
    room_for_ = up;
  } else {
    room_for_ = std::min(room_for_, up);
    if (now - *room_since_ >= kRoomTime) {
      rung_ = room_for_;
      room_since_.reset();
    }
  }
  if (*rung_ != before) actual_.reset();
  const Rung& rung = kLadder[*rung_].rung;
  const double bytes = std::max(1.0, actual_.value_or(whole_bytes(*rung_)));
  const double rate = std::min({input.bytes_per_second / bytes, rung.most_rate, input.most_rate});
  return {rung, std::min(kNoPicture, from_seconds(1.0 / std::max(rate, 1e-6)))};
}

void Ladder::coded(const Rung& rung, std::size_t bytes, bool whole) {
  const auto found = std::ranges::find(kAllRungs, rung);
  if (found == kAllRungs.end() || bytes == 0) return;
  const auto index = static_cast<std::size_t>(found - kAllRungs.begin());
  const auto size = static_cast<double>(bytes);
  if (whole) {
    const double ratio = size / whole_bytes(index);
    // The difference of a rung's first pictures is the rung's, that of later ones is the scene's.
    if (!first_) first_ = index;
    const bool is_new = learned_[index] < kFirstPictures;
    const double weight = is_new ? 1.0 / ++learned_[index] : kLearn;
    double& factor = is_new && *first_ != index ? own_[index] : scene_;
    factor = factor * std::pow(ratio, weight);
    own_[index] = std::clamp(own_[index], kMinOwn, kMaxOwn);
  }
  // At once when pictures grow, as the link is overloaded otherwise; slowly when they shrink.
  if (rung_ == index) actual_ = std::max(size, actual_.value_or(size) * (1.0 - kLearn) + size * kLearn);
}

}  // namespace adit::perception
