// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/link_shaper.hpp"

#include "core/wire/cost.hpp"
#include "core/wire/fastdds/ports.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"

namespace adit::wire {
namespace {

constexpr std::size_t kMaxWaiting = 4096;  // Datagrams; the maximum queue age limits the queue long before.
/// Interval between two attempts to send on a full socket. The kernel holds 40 kB (udp_sender.cpp), so a
/// radio below 300 Mbit/s does not run dry meanwhile. Polling the socket would not work: the interface's
/// queue can be full while the socket's is not.
constexpr Duration kRetry = 1ms;

}  // namespace

LinkShaper::LinkShaper(std::optional<LinkProfile> link, std::uint64_t seed, Socket socket, Outputs outputs)
    : link_(std::move(link)), outputs_(std::move(outputs)), socket_(std::move(socket)), random_(seed) {
  thread_ = std::thread([this] { run(); });
}

LinkShaper::~LinkShaper() { close(); }

Duration LinkShaper::now() { return std::chrono::steady_clock::now().time_since_epoch(); }

void LinkShaper::add_writer(std::uint32_t entity, int priority, bool newest_wins, bool keyed) {
  const std::lock_guard lock(mutex_);
  writers_[entity] = {priority, newest_wins, keyed};
}

void LinkShaper::remove_writer(std::uint32_t entity) {
  const std::lock_guard lock(mutex_);
  writers_.erase(entity);
}

bool LinkShaper::put_in_socket(std::span<const std::uint8_t> message, in_addr_t address,
                               std::uint16_t port) const {
  if (!socket_(message, address, port)) return false;
  if (outputs_.sent) outputs_.sent(message, address, port);
  return true;
}

LinkShaper::Waiting LinkShaper::classify(std::span<const std::uint8_t> message, in_addr_t address,
                                         std::uint16_t port) const {
  const RtpsPeek seen = peek(message);
  WriterSettings settings{WireCost::kDiscoveryPriority, false, false};
  if (seen.writer) {
    const auto known = writers_.find(*seen.writer);
    if (known != writers_.end()) settings = known->second;
  }
  // A new sample of a stream replaces a queued one of the same key, and a repair or heartbeat replaces a
  // queued equal one. Otherwise a repair that is requested again while it is queued is sent once per request.
  const std::optional<std::uint64_t> key = settings.keyed ? sample_key(message) : 0;
  const bool newest = settings.newest_wins && seen.complete && key;
  std::uint64_t number = newest ? *seen.writer ^ *key : seen.dedup_key;
  if (number != 0) {
    number = (number ^ (static_cast<std::uint64_t>(address) << 16 | port)) * 0x9e3779b97f4a7c15ULL;
    number |= 1;
  }
  Packet packet{{message.begin(), message.end()}, address, port, settings.priority};
  const Duration cost = airtime(packet);
  return {.item = std::move(packet),
          .priority = settings.priority,
          .supersedes = number,
          .again = !newest,
          .since = now(),
          .max_queue_age = max_queue_age(link_.value_or(LinkProfile{}), settings.priority),
          .airtime = cost};
}

void LinkShaper::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) {
  {
    const std::lock_guard lock(mutex_);
    const bool closed = close_at_ != Duration::max();
    if (!link_ && !closed && !refused_ && queue_.size() == 0 && put_in_socket(message, address, port)) return;
    Waiting waiting = classify(message, address, port);
    if (closed || queue_.size() >= kMaxWaiting) {
      queue_.note_dropped(waiting.priority);
      return;
    }
    (void)queue_.push(std::move(waiting));
  }
  wake_.notify_one();
}

SenderState LinkShaper::sender() const {
  const std::lock_guard lock(mutex_);
  SenderState state{profile(), link_ ? queue_.waiting() : queue_.ages(now()), queue_.dropped()};
  if (refused_) {
    Duration& age = state.queue[static_cast<std::size_t>(refused_->priority)];
    age = std::max(age, now() - refused_->since);
  }
  return state;
}

void LinkShaper::close() {
  {
    const std::lock_guard lock(mutex_);
    if (close_at_ == Duration::max()) close_at_ = now() + 1s;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LinkShaper::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    const Duration at = now();
    const Duration next = link_ ? step(at) : refill(at);
    const bool closing = close_at_ != Duration::max();
    const bool empty = queue_.size() == 0 && in_air_.empty() && !refused_;
    if (closing && (at >= close_at_ || empty)) return;
    const auto until = std::chrono::steady_clock::time_point(std::min(next, close_at_));
    if (next == Duration::max() && !closing) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, until);
    }
  }
}

Duration LinkShaper::step(Duration at) {
  while (free_at_ <= at) {
    auto next = queue_.next(
        at, [this](const Packet& packet) { return airtime(packet); }, [](const Packet&) {});
    if (!next) break;
    // The channel was free while this thread woke late and the datagram waited, so that time may be used.
    const Duration start = std::max({free_at_, at - 5ms, next->message.since});
    free_at_ = start + next->airtime;
    put_on_air(std::move(next->message.item), start, next->airtime);
  }
  while (!in_air_.empty() && in_air_.begin()->first <= at) {
    const Packet& packet = in_air_.begin()->second;
    if (!socket_(packet.bytes, packet.address, packet.port)) queue_.note_dropped(packet.priority);
    in_air_.erase(in_air_.begin());
  }
  Duration soonest = in_air_.empty() ? Duration::max() : in_air_.begin()->first;
  if (const auto ready = queue_.ready(at)) soonest = std::min(soonest, std::max(*ready, free_at_));
  return soonest;
}

Duration LinkShaper::refill(Duration at) {
  const auto taken = [this](const Waiting& w) {
    return put_in_socket(w.item.bytes, w.item.address, w.item.port);
  };
  if (refused_) {
    const bool stale = at - refused_->since > refused_->max_queue_age;
    if (!stale && !taken(*refused_)) return at + kRetry;
    if (stale) queue_.note_dropped(refused_->priority);
    refused_.reset();
  }
  while (auto next = queue_.next(
             at, [](const Packet&) { return Duration{}; }, [](const Packet&) {})) {
    if (taken(next->message)) continue;
    refused_ = std::move(next->message);
    return at + kRetry;
  }
  return Duration::max();
}

Duration LinkShaper::airtime(const Packet& packet) const {
  if (!link_ || link_->window > 0.0) return Duration{};
  return from_seconds(static_cast<double>(packet.bytes.size() + WireCost::kUdpAndIp) * 8.0 /
                      link_->bandwidth);
}

void LinkShaper::put_on_air(Packet packet, Duration at, Duration airtime) {
  const auto bytes = static_cast<std::uint32_t>(packet.bytes.size()) + WireCost::kUdpAndIp;
  if (link_->window > 0.0 && !window_.admit(*link_, bytes, at)) {
    queue_.note_dropped(packet.priority);
    return;
  }
  if (outputs_.sent) outputs_.sent(packet.bytes, packet.address, packet.port);
  const Path path = outputs_.path ? outputs_.path(packet.address, packet.port) : Path{};
  // A multicast is one frame: either all receivers get it or none.
  if (loss_models_[peer_of(packet)].lost(*link_, path, bytes, std::nullopt, random_)) return;
  in_air_.emplace(at + airtime + transit(*link_, random_), std::move(packet));
}

std::uint64_t LinkShaper::peer_of(const Packet& packet) const {
  // Participants of one machine differ by port; a participant's discovery and data ports count as one peer.
  return static_cast<std::uint64_t>(packet.address) << 16 | participant_of_port(packet.port);
}

}  // namespace adit::wire
