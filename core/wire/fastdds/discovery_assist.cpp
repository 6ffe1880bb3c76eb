// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/discovery_assist.hpp"

#include <algorithm>

namespace adit::wire {
namespace {

// Interval between two unicast announcements to a peer that knows us.
constexpr Duration kUnicastInterval = 20s;
constexpr int kRepeats = 3;            // Repetitions of a heartbeat until the library sends the next one.
constexpr std::uint32_t kCounts = 16;  // Number of our heartbeat counts for each count of the library.

bool of_discovery(std::uint32_t writer) {
  return writer == kPublicationsWriter || writer == kSubscriptionsWriter;
}

}  // namespace

DiscoveryAssist::Peer* DiscoveryAssist::at(in_addr_t address, std::uint16_t port) {
  for (auto& [id, peer] : peers_) {
    if (peer.address == address && peer.port == port) return &peer;
  }
  return nullptr;
}

bool DiscoveryAssist::sent(std::span<std::uint8_t> message, in_addr_t address, std::uint16_t port,
                           Duration now) {
  const RtpsPeek seen = peek(message);
  if (!seen.source) return true;
  const std::lock_guard lock(mutex_);
  own_ = *seen.source;
  if (seen.writer == kAnnouncingWriter) {
    if (!announced_address(message)) return true;  // The datagram says goodbye.
    announcement_.assign(message.begin(), message.end());
    Peer* peer = at(address, port);
    if (peer == nullptr) return true;
    if (peer->knows_us && now - peer->announced < kUnicastInterval) return false;
    peer->announced = now;
    return true;
  }
  change_heartbeat_counts(message, of_discovery, kCounts, 0);
  const auto beat = lone_heartbeat(message);
  Peer* peer = beat && of_discovery(beat->writer) ? at(address, port) : nullptr;
  if (peer != nullptr && beat->last >= beat->first)
    peer->beats[beat->writer] = {
        {message.begin(), message.end()}, beat->last, 0, now + Discovery::kHeartbeat};
  return true;
}

DiscoveryAssist::Peer& DiscoveryAssist::meet(const ParticipantId& id, const PeerAddress& locator,
                                             Duration now) {
  const auto known = peers_.find(id);
  if (known != peers_.end() && now - known->second.heard >= Discovery::kLease) peers_.erase(known);
  if (!peers_.contains(id)) {
    // The participant that had this address before has left.
    std::erase_if(peers_, [&](const auto& entry) {
      return entry.second.address == locator.address && entry.second.port == locator.port;
    });
    if (peers_.size() >= kMaxPeers)
      peers_.erase(std::min_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
        return a.second.heard < b.second.heard;
      }));
  }
  std::erase_if(silent_, [&](const auto& entry) {
    const bool same_place = entry.second.address == locator.address && entry.second.port == locator.port;
    return entry.first == id || same_place;
  });
  Peer& peer = peers_[id];
  peer.address = locator.address, peer.port = locator.port, peer.heard = now;
  return peer;
}

void DiscoveryAssist::received(std::span<const std::uint8_t> message, Duration now) {
  const RtpsPeek seen = peek(message);
  if (!seen.source) return;
  const std::lock_guard lock(mutex_);
  if (*seen.source == own_) return;
  if (seen.writer == kAnnouncingWriter) {
    const auto locator = announced_address(message);
    if (!locator) {
      silent_.erase(*seen.source);
      return (void)peers_.erase(*seen.source);
    }
    Peer& peer = meet(*seen.source, *locator, now);
    if (peer.knows_us || (reachable_ && !reachable_(peer.address))) return;
    peer.announcements_left = Discovery::kAnnounceRetries;
    if (peer.announce_at == Duration::max()) peer.announce_at = now + Discovery::kAnnounceRetryPeriod;
    return;
  }
  const auto known = peers_.find(*seen.source);
  // When its lease has expired, the library has forgotten the peer: only an announcement shows that it is
  // back.
  if (known == peers_.end() || now - known->second.heard >= Discovery::kLease) return;
  Peer& peer = known->second;
  peer.heard = now;
  if (seen.destination == own_) {
    peer.knows_us = true;
    peer.announce_at = Duration::max();
  }
  if (const auto answer = acknowledgement(message)) {
    const auto beat = peer.beats.find(answer->writer);
    if (beat == peer.beats.end()) return;
    if (answer->base > beat->second.last) {
      peer.beats.erase(beat);
    } else {
      // The library is sending the samples that the peer requested.
      beat->second.at = std::max(beat->second.at, now + Discovery::kHeartbeat);
    }
  }
}

void DiscoveryAssist::dropped(const ParticipantId& id, Duration now) {
  const std::lock_guard lock(mutex_);
  const auto known = peers_.extract(id);
  if (!known || !known.mapped().knows_us) return;  // It said goodbye, or it never heard us.
  if (silent_.size() >= kMaxSilent)
    silent_.erase(std::min_element(silent_.begin(), silent_.end(), [](const auto& a, const auto& b) {
      return a.second.since < b.second.since;
    }));
  if (silent_.empty()) search_at_ = now;
  silent_[id] = {known.mapped().address, known.mapped().port, now};
}

void DiscoveryAssist::search(Duration now, std::vector<Out>& out) {
  std::erase_if(silent_, [&](const auto& entry) { return now - entry.second.since > Discovery::kSearch; });
  if (silent_.empty() || search_at_ > now) return;
  const auto count = static_cast<Duration::rep>(silent_.size());
  search_at_ = now + std::max(Discovery::kSearchPeriod / count, Discovery::kSearchStep);
  auto next = silent_.upper_bound(searched_last_);
  if (next == silent_.end()) next = silent_.begin();
  searched_last_ = next->first;
  if (!announcement_.empty()) out.push_back({announcement_, next->second.address, next->second.port});
}

void DiscoveryAssist::announce(Duration now, std::vector<Out>& out) {
  if (now - second_ >= 1s) second_ = now, announced_ = 0;
  auto next = peers_.upper_bound(announced_last_);
  for (std::size_t i = 0; i < peers_.size(); ++i, ++next) {
    if (next == peers_.end()) next = peers_.begin();
    auto& [id, peer] = *next;
    if (peer.announce_at > now) continue;
    if (announced_ >= kMaxAnnouncements) {
      peer.announce_at = second_ + 1s;
      continue;
    }
    peer.announce_at =
        --peer.announcements_left > 0 ? now + Discovery::kAnnounceRetryPeriod : Duration::max();
    if (announcement_.empty()) continue;
    ++announced_;
    announced_last_ = id;
    out.push_back({announcement_, peer.address, peer.port});
  }
}

void DiscoveryAssist::repeat_heartbeats(Peer& peer, Duration now, bool link_idle, std::vector<Out>& out) {
  for (auto beat = peer.beats.begin(); beat != peer.beats.end();) {
    Beat& b = beat->second;
    if (b.at > now) {
      ++beat;
      continue;
    }
    b.at = now + Discovery::kHeartbeat;
    if (link_idle) {
      ++b.repeats;
      change_heartbeat_counts(b.message, of_discovery, 1, 1);
      out.push_back({b.message, peer.address, peer.port});
    }
    beat = b.repeats >= kRepeats ? peer.beats.erase(beat) : std::next(beat);
  }
}

void DiscoveryAssist::repeat(Duration now, bool link_idle, const Send& send) {
  std::vector<Out> out;
  {
    const std::lock_guard lock(mutex_);
    announce(now, out);
    search(now, out);
    for (auto& [id, peer] : peers_) repeat_heartbeats(peer, now, link_idle, out);
  }
  for (const Out& one : out) send(one.message, one.address, one.port);
}

ParticipantId DiscoveryAssist::own() const {
  const std::lock_guard lock(mutex_);
  return own_;
}

Duration DiscoveryAssist::next() const {
  const std::lock_guard lock(mutex_);
  Duration soonest = silent_.empty() ? Duration::max() : search_at_;
  for (const auto& [id, peer] : peers_) {
    soonest = std::min(soonest, peer.announce_at);
    for (const auto& [writer, beat] : peer.beats) soonest = std::min(soonest, beat.at);
  }
  return soonest;
}

DiscoveryAssistThread::DiscoveryAssistThread(DiscoveryAssist& assist, std::function<bool()> link_idle,
                                             DiscoveryAssist::Send send)
    : assist_(assist), link_idle_(std::move(link_idle)), send_(std::move(send)), thread_([this] { run(); }) {}

DiscoveryAssistThread::~DiscoveryAssistThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void DiscoveryAssistThread::wake() {
  const Duration next = assist_.next();
  {
    const std::lock_guard lock(mutex_);
    if (next >= planned_) return;
    planned_ = next;
  }
  changed_.notify_one();
}

void DiscoveryAssistThread::run() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    planned_ = assist_.next();
    if (planned_ == Duration::max()) {
      changed_.wait(lock);
    } else {
      changed_.wait_until(lock, std::chrono::steady_clock::time_point(planned_));
    }
    if (ends_) return;
    lock.unlock();
    assist_.repeat(std::chrono::steady_clock::now().time_since_epoch(), link_idle_(), send_);
    lock.lock();
  }
}

}  // namespace adit::wire
