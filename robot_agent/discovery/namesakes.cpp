// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/namesakes.hpp"

#include <algorithm>
#include <tuple>

namespace adit::agent {

void Namesakes::station(Time now) {
  if (!station_since_) station_since_ = now;
}

void Namesakes::claim(const Claim& own, Time now) {
  claim_ = own;
  if (!own.held) held_since_.reset();
  if (own.held && !held_since_) held_since_ = now;
}

void Namesakes::held_before() {
  claim_.held = true;
  held_since_ = Time::min();
}

Namesakes::Other* Namesakes::find(const wire::ParticipantId& from, Time now) {
  if (from == own_) return nullptr;
  for (Other& other : others_) {
    if (other.participant != from) continue;
    other.last = now;
    return &other;
  }
  if (others_.size() >= kCapacity) return nullptr;
  const auto settled = [now](const std::optional<Time>& since) { return since && *since <= now - kSettled; };
  others_.push_back({from, now, now, settled(station_since_) || settled(held_since_), false, {}});
  return &others_.back();
}

void Namesakes::heard(const wire::ParticipantId& from, Time now) { (void)find(from, now); }

void Namesakes::described(const wire::ParticipantId& from, const std::optional<Claim>& claim, Time now) {
  if (Other* other = find(from, now)) other->claim = claim;
}

void Namesakes::left(const wire::ParticipantId& participant) {
  std::erase_if(others_, [&](const Other& other) { return other.participant == participant; });
}

bool Namesakes::all_give_way() const {
  return std::all_of(others_.begin(), others_.end(),
                     [](const Other& other) { return other.claim.has_value(); });
}

Namesakes::Verdict Namesakes::judge() const {
  const bool confirmed =
      std::any_of(others_.begin(), others_.end(), [](const Other& other) { return other.confirmed; });
  if (others_.empty()) return Verdict::alone;
  if (verdict_ == Verdict::stays) return Verdict::stays;
  if (verdict_ != Verdict::gives_way) {
    const bool first = std::all_of(others_.begin(), others_.end(), [](const Other& o) { return o.newer; });
    if (first) return confirmed ? Verdict::stays : Verdict::alone;
    return confirmed ? Verdict::gives_way : Verdict::undecided;
  }
  if (!all_give_way()) return Verdict::gives_way;
  const auto rank = [](const Claim& claim, const wire::ParticipantId& who) {
    return std::tuple(!claim.held, claim.start, who);
  };
  const bool wins = std::all_of(others_.begin(), others_.end(), [&](const Other& other) {
    return rank(claim_, own_) < rank(*other.claim, other.participant);
  });
  return wins ? Verdict::stays : Verdict::gives_way;
}

std::optional<wire::ParticipantId> Namesakes::tick(Time now) {
  std::optional<wire::ParticipantId> news;
  std::erase_if(others_, [now](const Other& other) { return now - other.last >= kForget; });
  for (Other& other : others_) {
    if (other.confirmed || other.last - other.first < kConfirm) continue;
    other.confirmed = true;
    news = other.participant;
  }
  const Verdict is = judge();
  if (is != verdict_ && (is == Verdict::stays || is == Verdict::gives_way))
    news = others_.front().participant;
  verdict_ = is;
  return news;
}

std::optional<Namesakes::Claim> Namesakes::announced() const {
  return verdict_ == Verdict::gives_way ? std::optional(claim_) : std::nullopt;
}

bool Namesakes::obeys(std::uint64_t start) const {
  if (verdict_ == Verdict::undecided || verdict_ == Verdict::gives_way) return false;
  return verdict_ == Verdict::alone || start == 0 || start == claim_.start || all_give_way();
}

}  // namespace adit::agent
