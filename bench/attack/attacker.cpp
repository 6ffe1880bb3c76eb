// SPDX-License-Identifier: Apache-2.0
#include "bench/attack/attacker.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

#include "core/wire/fastdds/rtps_submessage.hpp"

namespace adit::bench {

namespace bytes = wire::rtps_bytes;
using namespace wire::test;

namespace {

constexpr const char* kAddress = "127.0.0.5";
constexpr int kParticipants = 8;  // Whose ports are tried.
constexpr std::size_t kMaxDatagram = 65536;

std::pair<int, std::uint16_t> open_socket(const char* address) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = ::inet_addr(address);
  socklen_t size = sizeof own;
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0 ||
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0)
    throw std::runtime_error(std::string("no socket at ") + address);
  return {fd, ntohs(own.sin_port)};
}

}  // namespace

Attacker::Attacker(unsigned domain) : domain_(domain) {
  id_ = participant(0x66);
  id_[0] = 1, id_[1] = 15;
  std::tie(socket_, port_) = open_socket(kAddress);
  std::tie(victim_, victim_port_) = open_socket("127.0.0.9");
  const in_addr loopback{htonl(INADDR_LOOPBACK)};
  ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  listener_ = std::thread([this] { listen(socket_, received_, true); });
  victim_listener_ = std::thread([this] { listen(victim_, victim_received_, false); });
}

Attacker::~Attacker() {
  ends_ = true;
  listener_.join();
  victim_listener_.join();
  ::close(socket_);
  ::close(victim_);
}

void Attacker::listen(int socket, std::atomic<std::uint64_t>& count, bool learns) {
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  pollfd poll{socket, POLLIN, 0};
  while (!ends_) {
    if (::poll(&poll, 1, 100) <= 0) continue;
    const ssize_t size = ::recv(socket, buffer.data(), buffer.size(), 0);
    if (size <= 0) continue;
    count += static_cast<std::uint64_t>(size);
    if (learns) learn({buffer.begin(), buffer.begin() + size});
  }
}

void Attacker::learn(const std::vector<std::uint8_t>& message) {
  if (!bytes::has_header(message)) return;
  const auto sender = bytes::prefix_at(message.data() + 8);
  bytes::each_submessage(message, [&](const bytes::Submessage& sub) {
    const bytes::Message body = sub.body;
    if (sub.kind == bytes::kHeartbeat && body.size() >= 28 && bytes::entity(body, 4) == kPublications &&
        bytes::sequence(sub, 16) >= bytes::sequence(sub, 8))
      request(sender, bytes::sequence(sub, 8), bytes::sequence(sub, 16));
    if (sub.kind != bytes::kData || body.size() <= 24 || bytes::entity(body, 8) != kPublications ||
        (sub.flags & bytes::kWithQos) != 0)
      return true;
    std::uint32_t entity = 0;
    std::string topic;
    bytes::each_parameter(body, 24, sub.little, [&](std::uint16_t parameter, bytes::Message value) {
      if (parameter == bytes::kEndpointGuid) entity = bytes::entity(value, 12);
      if (parameter == bytes::kTopicName) topic = reinterpret_cast<const char*>(value.data()) + 4;
      return true;
    });
    const std::lock_guard lock(mutex_);
    writers_[{sender, topic}] = entity;
    return true;
  });
}

void Attacker::request(const wire::ParticipantId& from, std::uint64_t first, std::uint64_t last) {
  to_all(rtps_message(
      id_, {destination(from), acknack(reader_of(kPublications), kPublications, first, last, ++requests_)}));
}

void Attacker::announce() { to_all(rtps_message(id_, {announcement(id_, {own_locator()})})); }

void Attacker::to_all(const Bytes& message) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  const auto send = [&](const char* address, unsigned port) {
    to.sin_addr.s_addr = ::inet_addr(address);
    to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain_ + port));
    (void)::sendto(socket_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to);
  };
  send("239.255.0.1", 0);
  for (unsigned n = 0; n < kParticipants; ++n)
    for (const unsigned port : {10 + 2 * n, 11 + 2 * n}) send("127.0.0.1", port);
}

std::optional<std::uint32_t> Attacker::writer(const wire::ParticipantId& of, const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const auto known = writers_.find({of, topic});
  return known == writers_.end() ? std::nullopt : std::optional(known->second);
}

std::pair<std::uint64_t, std::uint64_t> Attacker::received() {
  return {received_.exchange(0), victim_received_.exchange(0)};
}

}  // namespace adit::bench
