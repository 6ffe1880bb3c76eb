#include "core/wire/fastdds/live_link.hpp"

#include "core/wire/cost.hpp"
#include "core/wire/fastdds/ports.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"

namespace adit::wire {
namespace {

constexpr std::size_t most_waiting = 4096;  // datagrams; the queue's age bounds them long before
/// Between two tries to give a full socket more. The kernel holds 40 kB (outlet.cpp), so that a radio of less
/// than 300 Mbit/s does not run dry meanwhile. Polling the socket would not do: the interface's queue can be
/// full while the socket's is not.
constexpr Duration kRetry = 1ms;

LiveLink::Socket sockets_of(const std::vector<std::string>& interfaces) {
  return
      [outlet = std::make_shared<Outlet>(interfaces)](auto message, in_addr_t address, std::uint16_t port) {
        return outlet->send(message, address, port);
      };
}

}  // namespace

LiveLink::LiveLink(std::optional<LinkProfile> link, std::uint64_t seed,
                   const std::vector<std::string>& interfaces, Outputs outputs)
    : LiveLink(std::move(link), seed, sockets_of(interfaces), std::move(outputs)) {}

LiveLink::LiveLink(std::optional<LinkProfile> link, std::uint64_t seed, Socket socket, Outputs outputs)
    : link_(std::move(link)), outputs_(std::move(outputs)), socket_(std::move(socket)), random_(seed) {
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

bool LiveLink::put_in_socket(std::span<const std::uint8_t> message, in_addr_t address,
                             std::uint16_t port) const {
  if (!socket_(message, address, port)) return false;
  if (outputs_.sent) outputs_.sent(message, address, port);
  return true;
}

LiveLink::Waiting LiveLink::classify(std::span<const std::uint8_t> message, in_addr_t address,
                                     std::uint16_t port) const {
  const RtpsPeek seen = peek(message);
  Class what{WireCost::discovery_priority, false, false};
  if (seen.writer) {
    const auto known = writers_.find(*seen.writer);
    if (known != writers_.end()) what = known->second;
  }
  // The newest sample of a stream stands for those before it of the same key, a repair or a heartbeat for the
  // same one that waits: else a repair that is requested again while it waits is sent once per request.
  const std::optional<std::uint64_t> key = what.keyed ? sample_key(message) : 0;
  const bool newest = what.newest_wins && seen.whole && key;
  std::uint64_t number = newest ? *seen.writer ^ *key : seen.meaning;
  if (number != 0) {
    number = (number ^ (static_cast<std::uint64_t>(address) << 16 | port)) * 0x9e3779b97f4a7c15ULL;
    number |= 1;
  }
  Packet packet{{message.begin(), message.end()}, address, port, what.priority};
  const Duration cost = airtime(packet);
  return {.item = std::move(packet),
          .priority = what.priority,
          .supersedes = number,
          .again = !newest,
          .since = now(),
          .patience = patience(link_.value_or(LinkProfile{}), what.priority),
          .airtime = cost};
}

void LiveLink::send(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port) {
  {
    const std::lock_guard lock(mutex_);
    const bool closed = close_at_ != Duration::max();
    if (!link_ && !closed && !refused_ && queue_.size() == 0 && put_in_socket(message, address, port)) return;
    Waiting waiting = classify(message, address, port);
    if (closed || queue_.size() >= most_waiting) {
      queue_.note_dropped(waiting.priority);
      return;
    }
    (void)queue_.push(std::move(waiting));
  }
  wake_.notify_one();
}

Duration LiveLink::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.oldest(now());
}

SenderState LiveLink::sender() const {
  const std::lock_guard lock(mutex_);
  SenderState state{profile(), link_ ? queue_.waiting() : queue_.ages(now()), queue_.dropped()};
  if (refused_) {
    Duration& age = state.queue[static_cast<std::size_t>(refused_->priority)];
    age = std::max(age, now() - refused_->since);
  }
  return state;
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

Duration LiveLink::step(Duration at) {
  while (free_at_ <= at) {
    auto next = queue_.next(
        at, [this](const Packet& packet) { return airtime(packet); }, [](const Packet&) {});
    if (!next) break;
    // A thread that woke late has not lost the time: the air was free since then, and this waited.
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

Duration LiveLink::refill(Duration at) {
  const auto taken = [this](const Waiting& w) {
    return put_in_socket(w.item.bytes, w.item.address, w.item.port);
  };
  if (refused_) {
    const bool stale = at - refused_->since > refused_->patience;
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

Duration LiveLink::airtime(const Packet& packet) const {
  if (!link_ || link_->window > 0.0) return Duration{};
  return from_seconds(static_cast<double>(packet.bytes.size() + WireCost::udp_and_ip) * 8.0 /
                      link_->bandwidth);
}

void LiveLink::put_on_air(Packet packet, Duration at, Duration airtime) {
  const auto bytes = static_cast<std::uint32_t>(packet.bytes.size()) + WireCost::udp_and_ip;
  if (link_->window > 0.0 && !window_.admit(*link_, bytes, at)) {
    queue_.note_dropped(packet.priority);
    return;
  }
  if (outputs_.sent) outputs_.sent(packet.bytes, packet.address, packet.port);
  const Path path = outputs_.path ? outputs_.path(packet.address, packet.port) : Path{};
  // Multicast is one frame: all hear it or nobody does.
  if (channels_[peer_of(packet)].lost(*link_, path, bytes, std::nullopt, random_)) return;
  in_air_.emplace(at + airtime + transit(*link_, random_), std::move(packet));
}

std::uint64_t LiveLink::peer_of(const Packet& packet) const {
  // On one machine participants differ by port; the pair of discovery and data ports is one peer.
  return static_cast<std::uint64_t>(packet.address) << 16 | participant_of_port(packet.port);
}

}  // namespace adit::wire
