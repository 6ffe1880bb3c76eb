// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/outbox.hpp"

#include <algorithm>
#include <utility>

namespace adit::station::host {

bool Outbox::reply(std::string line) {
  reply_bytes_ += line.size();
  waiting_.push_back({Kind::reply, std::move(line)});
  return reply_bytes_ <= kMaxReplyBytes;
}

void Outbox::event(std::string line) {
  if (events_ == kMaxEvents) {
    waiting_.erase(std::find_if(waiting_.begin(), waiting_.end(),
                                [](const Line& waits) { return waits.kind == Kind::event; }));
    ++missed_;
    --events_;
  }
  ++events_;
  waiting_.push_back({Kind::event, std::move(line)});
}

void Outbox::snapshot(std::string line) {
  const auto slot = std::find_if(waiting_.begin(), waiting_.end(),
                                 [](const Line& waits) { return waits.kind == Kind::snapshot; });
  if (slot == waiting_.end())
    waiting_.push_back({Kind::snapshot, std::move(line)});
  else
    slot->text = std::move(line);
}

void Outbox::clear() { *this = {}; }

std::optional<std::string> Outbox::next(bool client_is_done) {
  if (missed_ > 0) return "{\"missed\":" + std::to_string(std::exchange(missed_, 0)) + "}";
  const auto ready = std::find_if(waiting_.begin(), waiting_.end(), [&](const Line& waits) {
    return waits.kind != Kind::snapshot || client_is_done;
  });
  if (ready == waiting_.end()) return std::nullopt;
  Line line = std::move(*ready);
  waiting_.erase(ready);
  if (line.kind == Kind::reply) reply_bytes_ -= line.text.size();
  if (line.kind == Kind::event) --events_;
  return std::move(line.text);
}

}  // namespace adit::station::host
