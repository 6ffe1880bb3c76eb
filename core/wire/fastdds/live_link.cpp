#include "core/wire/fastdds/live_link.hpp"

#include "core/wire/cost.hpp"
#include "core/wire/fastdds/ports.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"

namespace adit::wire {
namespace {

constexpr std::size_t most_waiting = 4096;  // datagrams; the queue's age bounds them long before
constexpr std::uint32_t udp_and_ip = 28;

}  // namespace

LiveLink::LiveLink(LinkProfile link, std::uint64_t seed, const std::vector<std::string>& interfaces,
                   Outputs outputs)
    : link_(std::move(link)), outputs_(std::move(outputs)), outlet_(interfaces), random_(seed) {
  thread_ = std::thread([this] { run(); });
}

LiveLink::~LiveLink() { close(); }

Duration LiveLink::now() { return std::chrono::steady_clock::now().time_since_epoch(); }

void LiveLink::add_writer(std::uint32_t entity, int priority, bool newest_wins, bool keyed) {
  const std::lock_guard lock(mutex_);
  writers_[entity] = {priority, newest_wins, keyed};
}

void LiveLink::remove_writer(std::uint32_t entity) {
  const std::lock_guard lock(mutex_);
  writers_.erase(entity);
}

void LiveLink::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) {
  const RtpsPeek seen = peek(message);
  {
    const std::lock_guard lock(mutex_);
    Class what{WireCost::discovery_priority, false, false};
    if (seen.writer) {
      const auto known = writers_.find(*seen.writer);
      if (known != writers_.end()) what = known->second;
    }
    if (close_at_ != Duration::max() || queue_.size() >= most_waiting) {
      queue_.note_dropped(what.priority);
      return;
    }
    // The newest sample of a stream stands for those before it of the same key, a repair or a heartbeat for
    // the same one that waits: else a repair that is requested again while it waits is sent once per request.
    const std::optional<std::uint64_t> key = what.keyed ? sample_key(message) : 0;
    const bool newest = what.newest_wins && seen.whole && key;
    std::uint64_t number = newest ? *seen.writer ^ *key : seen.meaning;
    if (number != 0) {
      number = (number ^ (static_cast<std::uint64_t>(address) << 16 | port)) * 0x9e3779b97f4a7c15ULL;
      number |= 1;
    }
    Packet packet{{message.begin(), message.end()}, address, port};
    const Duration cost = airtime(packet);
    (void)queue_.push({.item = std::move(packet),
                       .priority = what.priority,
                       .supersedes = number,
                       .again = !newest,
                       .since = now(),
                       .patience = patience(link_, what.priority),
                       .airtime = cost});
  }
  wake_.notify_one();
}

Duration LiveLink::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.oldest(now());
}

SenderState LiveLink::sender() const {
  const std::lock_guard lock(mutex_);
  return {&link_, queue_.waiting(), queue_.dropped()};
}

void LiveLink::close() {
  {
    const std::lock_guard lock(mutex_);
    if (close_at_ == Duration::max()) close_at_ = now() + 1s;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LiveLink::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    const Duration at = now();
    const Duration next = step(at);
    const bool closing = close_at_ != Duration::max();
    if (closing && (at >= close_at_ || (queue_.size() == 0 && in_air_.empty()))) return;
    const auto until = std::chrono::steady_clock::time_point(std::min(next, close_at_));
    if (next == Duration::max() && !closing) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, until);
    }
  }
}

Duration LiveLink::step(Duration at) {
  while (free_at_ <= at) {
    auto next = queue_.next(
        at, [this](const Packet& packet) { return airtime(packet); }, [](const Packet&) {});
    if (!next) break;
    // A thread that woke late has not lost the time: the air was free since then, and this waited.
    const Duration start = std::max({free_at_, at - 5ms, next->message.since});
    free_at_ = start + next->airtime;
    put_on_air(std::move(next->message.item), next->message.priority, start, next->airtime);
  }
  while (!in_air_.empty() && in_air_.begin()->first <= at) {
    const Packet& packet = in_air_.begin()->second;
    outlet_.send(packet.bytes, packet.address, packet.port);
    in_air_.erase(in_air_.begin());
  }
  Duration soonest = in_air_.empty() ? Duration::max() : in_air_.begin()->first;
  if (const auto ready = queue_.ready(at)) soonest = std::min(soonest, std::max(*ready, free_at_));
  return soonest;
}

Duration LiveLink::airtime(const Packet& packet) const {
  if (link_.window > 0.0) return Duration{};
  return from_seconds(static_cast<double>(packet.bytes.size() + udp_and_ip) * 8.0 / link_.bandwidth);
}

void LiveLink::put_on_air(Packet packet, int priority, Duration at, Duration airtime) {
  const auto bytes = static_cast<std::uint32_t>(packet.bytes.size()) + udp_and_ip;
  if (link_.window > 0.0 && !window_.admit(link_, bytes, at)) {
    queue_.note_dropped(priority);
    return;
  }
  if (outputs_.sent) outputs_.sent(packet.bytes, packet.address, packet.port);
  const Path path = outputs_.path ? outputs_.path(packet.address, packet.port) : Path{};
  // Multicast is one frame: all hear it or nobody does.
  if (channels_[peer_of(packet)].lost(link_, path, bytes, std::nullopt, random_)) return;
  in_air_.emplace(at + airtime + transit(link_, random_), std::move(packet));
}

std::uint64_t LiveLink::peer_of(const Packet& packet) const {
  // On one machine participants differ by port; the pair of discovery and data ports is one peer.
  return static_cast<std::uint64_t>(packet.address) << 16 | participant_of_port(packet.port);
}

}  // namespace adit::wire
