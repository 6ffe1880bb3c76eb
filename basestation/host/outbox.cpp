// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/outbox.hpp"

#include <algorithm>
#include <utility>

namespace adit::station::host {

bool Outbox::reply(std::string line) {
  reply_bytes_ += line.size();
  waiting_.push_back({false, std::move(line)});
  return reply_bytes_ <= kMaxReplyBytes;
}

void Outbox::event(std::string line) {
  if (events_ == kMaxEvents) {
    waiting_.erase(std::ranges::find(waiting_, true, &Line::is_event));
    ++missed_;
    --events_;
  }
  ++events_;
  waiting_.push_back({true, std::move(line)});
}

void Outbox::clear() { *this = {}; }

std::optional<std::string> Outbox::next() {
  if (missed_ > 0) return "{\"missed\":" + std::to_string(std::exchange(missed_, 0)) + "}";
  if (waiting_.empty()) return std::nullopt;
  Line line = std::move(waiting_.front());
  waiting_.pop_front();
  if (line.is_event)
    --events_;
  else
    reply_bytes_ -= line.text.size();
  return std::move(line.text);
}

}  // namespace adit::station::host
