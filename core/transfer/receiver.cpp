// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/receiver.hpp"

#include <algorithm>
#include <utility>

namespace adit::transfer {
namespace {

constexpr Duration kForgotten = 30s;  // A sender that was silent for longer needs no receipt.

/// Marks `id` as received. Returns false if it was before.
bool mark(Receipt& receipt, std::uint32_t id) {
  if (id > receipt.newest) {
    const std::uint32_t by = id - receipt.newest;
    auto& [low, high] = receipt.received;
    if (by >= 128)
      low = high = 0;
    else if (by >= 64)
      high = low << (by - 64), low = 0;
    else
      high = high << by | low >> (64 - by), low <<= by;
    low |= 1;
    receipt.newest = id;
    return true;
  }
  const std::uint32_t back = receipt.newest - id;
  if (back >= Receipt::kSpan) return true;  // Too old to be known, and its content may be new.
  std::uint64_t& word = receipt.received[back / 64];
  const std::uint64_t bit = std::uint64_t{1} << (back % 64);
  const bool first = (word & bit) == 0;
  word |= bit;
  return first;
}

}  // namespace

bool Receiver::take(const std::string& sender, std::uint32_t session, std::uint32_t id, Time now) {
  if (session == 0 || id == 0) return false;
  const auto found = senders_.find(sender);
  if (found == senders_.end() && senders_.size() >= params_.max_senders)
    senders_.erase(std::min_element(senders_.begin(), senders_.end(), [](const auto& a, const auto& b) {
      return a.second.heard < b.second.heard;
    }));
  Reception& from = senders_[sender];
  from.heard = now;
  from.news = news_ = true;
  if (from.receipt.session != session) from.receipt = {session, 0, {}};
  return mark(from.receipt, id);
}

void Receiver::refused(const std::string& sender) {
  if (const auto found = senders_.find(sender); found != senders_.end()) found->second.news = news_ = true;
}

std::optional<std::vector<std::pair<std::string, Receipt>>> Receiver::due(Time now, double bandwidth) {
  const bool thin = bandwidth > 0.0 && bandwidth < params_.thin;
  const Duration pause = !news_ ? params_.idle : thin ? params_.slow : params_.fast;
  if (acknowledged_ && now - *acknowledged_ < pause) return std::nullopt;
  acknowledged_ = now;
  std::vector<std::pair<std::string, Receipt>> out;
  const auto add = [&](const auto& is_wanted) {
    auto next = senders_.upper_bound(turn_);
    for (std::size_t n = 0; n < senders_.size() && out.size() < params_.max_receipts; ++n, ++next) {
      if (next == senders_.end()) next = senders_.begin();
      auto& [name, sender] = *next;
      if (!is_wanted(sender) || now - sender.heard > kForgotten) continue;
      out.emplace_back(name, sender.receipt);
      sender.acknowledged = now;
      sender.again = std::exchange(sender.news, false);
    }
  };
  const auto with_news =
      std::count_if(senders_.begin(), senders_.end(), [](const auto& s) { return s.second.news; });
  if (with_news == 0) {
    add([](const Reception&) { return true; });  // A receipt that was lost is repeated while nothing arrives.
  } else {
    // Or beside others.
    add([](const Reception& sender) { return sender.news; });
    if (static_cast<std::size_t>(with_news) <= params_.max_receipts)
      add([now](const Reception& sender) { return sender.again && sender.acknowledged != now; });
  }
  turn_ = out.size() < params_.max_receipts ? std::string{} : out.back().first;
  news_ = static_cast<std::size_t>(with_news) > params_.max_receipts;
  return out;
}

}  // namespace adit::transfer
