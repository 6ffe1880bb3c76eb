// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/link_shaper.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/wire/fastdds/filtering_transport.hpp"
#include "core/wire/fastdds/rtps_peek.hpp"
#include "core/wire/fastdds/udp_sender.hpp"
#include "tests/live/process.hpp"

namespace adit::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// An RTPS message with one DATA (0x15) or DATA_FRAG (0x16) of that writer, of sequence number `tag`, which
/// is at its end as well.
Bytes rtps(std::uint8_t kind, std::uint32_t writer, std::uint8_t tag = 0) {
  Bytes m(20);
  m[0] = 'R', m[1] = 'T', m[2] = 'P', m[3] = 'S';
  const Bytes stamp{0x09, 1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  m.insert(m.end(), stamp.begin(), stamp.end());
  const auto id = [writer](int shift) { return static_cast<std::uint8_t>(writer >> shift); };
  const Bytes data{kind, 1, 28, 0, 0,   0, 16, 0, 0, 0, 0, 0, id(24), id(16), id(8), id(0),
                   0,    0, 0,  0, tag, 0, 0,  0, 1, 0, 0, 0, 0,      0,      0,     tag};
  m.insert(m.end(), data.begin(), data.end());
  return m;
}

TEST(RtpsPeek, FindsTheWriterBehindOtherSubmessages) {
  const RtpsPeek seen = peek(rtps(0x15, 0x00000103));
  EXPECT_EQ(seen.writer, 0x103U);
  EXPECT_TRUE(seen.complete);
  EXPECT_FALSE(peek(rtps(0x16, 0x00000103)).complete);
  Bytes two = rtps(0x15, 0x103);
  const Bytes second = rtps(0x15, 0x203);
  two.insert(two.end(), second.begin() + 20, second.end());
  EXPECT_EQ(peek(two).writer, 0x103U);
  EXPECT_FALSE(peek(two).complete);
}

TEST(RtpsPeek, AnythingElseHasNoWriter) {
  EXPECT_FALSE(peek({}).writer);
  EXPECT_FALSE(peek(Bytes(60, 0xff)).writer);
  Bytes complete = rtps(0x15, 0x103);
  for (std::size_t n = 0; n < complete.size(); ++n) {
    const auto seen = peek(std::span(complete).first(n));
    EXPECT_EQ(seen.writer.has_value(), n >= 48) << n;
  }
  EXPECT_FALSE(peek(rtps(0x07, 0x103)).writer);  // a heartbeat
}

/// Submessages behind the header of a Fast DDS participant: kind, then its body.
Bytes message(const std::vector<Bytes>& submessages) {
  Bytes m{'R', 'T', 'P', 'S', 2, 3, 1, 15, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9};
  for (const Bytes& sub : submessages) {
    m.insert(m.end(), {sub[0], 1, static_cast<std::uint8_t>(sub.size() - 1), 0});
    m.insert(m.end(), sub.begin() + 1, sub.end());
  }
  return m;
}
Bytes heartbeat(std::uint8_t writer, std::uint8_t last, std::uint8_t count) {
  return {0x07, 0, 0, 0, 7, 0, 0,    writer, 2, 0, 0,     0, 0, 1, 0,
          0,    0, 0, 0, 0, 0, last, 0,      0, 0, count, 0, 0, 0};
}
Bytes statistics() {
  Bytes body(57);
  body[0] = 0x80;
  return body;
}

TEST(RtpsPeek, RepeatedSamplesAndHeartbeatsHaveTheSameKey) {
  const auto dedup_key = [](const Bytes& m) { return peek(m).dedup_key; };
  EXPECT_NE(dedup_key(rtps(0x15, 0x103, 1)), 0U);
  EXPECT_EQ(dedup_key(rtps(0x15, 0x103, 1)), dedup_key(rtps(0x15, 0x103, 1)));
  EXPECT_NE(dedup_key(rtps(0x15, 0x103, 1)), dedup_key(rtps(0x15, 0x103, 2)));
  EXPECT_NE(dedup_key(rtps(0x15, 0x103, 1)), dedup_key(rtps(0x15, 0x203, 1)));
  EXPECT_NE(dedup_key(rtps(0x15, 0x103, 1)), dedup_key(rtps(0x16, 0x103, 1)));
  EXPECT_EQ(dedup_key(message({heartbeat(1, 5, 1)})), dedup_key(message({heartbeat(1, 6, 2)})));
  EXPECT_NE(dedup_key(message({heartbeat(1, 5, 1)})), dedup_key(message({heartbeat(2, 5, 1)})));
  EXPECT_EQ(dedup_key(message({})), 0U);
  EXPECT_EQ(dedup_key(message({Bytes{0x07, 0, 0}})), 0U);
}

TEST(RtpsPeek, MessagesThatItCannotReadNeverReplaceEachOther) {
  // Those of DDS security (0x30 to 0x34), HEARTBEAT_FRAG (0x13), and kinds of other vendors.
  for (const std::uint8_t kind : {0x30, 0x31, 0x33, 0x13, 0x81}) {
    const int k = kind;
    EXPECT_EQ(peek(message({Bytes{kind, 1, 2, 3, 4}})).dedup_key, 0U) << k;
    EXPECT_EQ(peek(message({Bytes{kind, 5, 6, 7, 8}})).dedup_key, 0U) << k;
    EXPECT_EQ(peek(message({heartbeat(1, 5, 1), Bytes{kind, 5, 6, 7, 8}})).dedup_key, 0U) << k;
  }
  const Bytes destination{0x0e, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5};
  EXPECT_NE(peek(message({destination, heartbeat(1, 5, 1)})).dedup_key, 0U);
}

TEST(RtpsPeek, HeartbeatsInProtectedMessagesStayAsTheyAre) {
  // With sign-only protection they are readable, but a code behind them covers their bytes.
  for (const std::uint8_t kind : {0x31, 0x33}) {
    const Bytes before = message({Bytes{kind, 1, 2, 3, 4}, heartbeat(1, 5, 1), Bytes{0x34, 1, 2, 3, 4}});
    Bytes after = before;
    change_heartbeat_counts(
        after, [](std::uint32_t) { return true; }, 16, 0);
    EXPECT_EQ(after, before);
  }
}

TEST(RtpsPeek, ReadsSourceAndDestination) {
  const RtpsPeek seen = peek(message({Bytes{0x0e, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5}, heartbeat(1, 5, 1)}));
  ParticipantId nine{}, five{};
  nine.fill(9), five.fill(5);
  EXPECT_EQ(seen.source, nine);
  EXPECT_EQ(seen.destination, five);
  EXPECT_FALSE(peek(message({heartbeat(1, 5, 1)})).destination);
}

TEST(RtpsPeek, StatisticsAreCutFromFastDdsMessagesAlone) {
  Bytes m = message({heartbeat(1, 5, 1), statistics()});
  EXPECT_EQ(without_statistics(m), m.size() - 60);
  const Bytes cut = message({heartbeat(1, 5, 1)});
  EXPECT_EQ(without_statistics(cut), cut.size());
  m[7] = 16;  // another vendor's
  EXPECT_EQ(without_statistics(m), m.size());
  for (std::size_t n = 0; n < 80; ++n) EXPECT_EQ(without_statistics(std::span(m).first(n)), n);
}

TEST(HeartbeatFilter, LimitsTheRateOfUnchangedHeartbeats) {
  HeartbeatFilter filter(200ms);
  const auto passes = [&](const Bytes& m, std::uint16_t port, Duration at) {
    return filter.passes(m, 1, port, at);
  };
  EXPECT_TRUE(passes(message({heartbeat(1, 5, 1)}), 1, 0ms));
  EXPECT_FALSE(passes(message({heartbeat(1, 5, 2)}), 1, 100ms));
  EXPECT_TRUE(passes(message({heartbeat(1, 5, 2)}), 2, 100ms));  // another peer
  EXPECT_TRUE(passes(message({heartbeat(2, 5, 3)}), 1, 100ms));  // another writer
  EXPECT_TRUE(passes(message({heartbeat(1, 6, 4)}), 1, 110ms));  // there is more to ask for
  EXPECT_FALSE(passes(message({heartbeat(1, 6, 5)}), 1, 300ms));
  EXPECT_TRUE(passes(message({heartbeat(1, 6, 6)}), 1, 311ms));
  for (int i = 0; i < 3; ++i) {
    Bytes with_sample = rtps(0x15, 0x103, 1);
    const Bytes beat = message({heartbeat(1, 6, 7)});
    with_sample.insert(with_sample.end(), beat.begin() + 20, beat.end());
    EXPECT_TRUE(passes(with_sample, 1, 312ms));
  }
}

TEST(RtpsPeek, PayloadThatLooksLikeStatisticsIsNotCut) {
  // A sample whose last 60 bytes are what a statistics submessage is.
  Bytes sample{0x15, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  const Bytes lookalike = message({statistics()});
  sample.insert(sample.end(), lookalike.begin() + 20, lookalike.end());
  Bytes m = message({sample});
  EXPECT_EQ(without_statistics(m), m.size());
  m[22] = 0;  // The last submessage may give no length.
  EXPECT_EQ(without_statistics(m), m.size());
  const Bytes real = message({sample, statistics()});
  EXPECT_EQ(without_statistics(real), real.size() - 60);
}

TEST(HeartbeatFilter, RemembersABoundedNumberOfHeartbeats) {
  HeartbeatFilter filter(200ms);
  const Bytes beat = message({heartbeat(1, 5, 1)});
  for (std::uint16_t port = 1; port <= 10000; ++port) EXPECT_TRUE(filter.passes(beat, 1, port, 1ms));
  // A heartbeat that does not fit into the filter is sent each time.
  EXPECT_TRUE(filter.passes(beat, 1, 10000, 2ms));
  EXPECT_FALSE(filter.passes(beat, 1, 1, 2ms));
  EXPECT_TRUE(filter.passes(beat, 1, 10000, 300ms));
  EXPECT_FALSE(filter.passes(beat, 1, 10000, 301ms));
}

/// A socket that waits for what a link lets through.
class Receiver {
 public:
  Receiver() : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
    socklen_t length = sizeof at;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &length);
    port = ntohs(at.sin_port);
  }
  ~Receiver() { ::close(fd_); }
  /// The last byte of each datagram that arrives: of so many at least, then until none does for `quiet_ms`.
  Bytes tags(std::size_t least, int quiet_ms) {
    Bytes result;
    std::uint8_t buffer[2000];
    pollfd wait{fd_, POLLIN, 0};
    while (::poll(&wait, 1, result.size() < least ? 30'000 : quiet_ms) == 1) {
      const auto n = ::recv(fd_, buffer, sizeof buffer, 0);
      if (n > 0) result.push_back(buffer[n - 1]);
    }
    return result;
  }
  std::uint16_t port{};

 private:
  int fd_;
};

const in_addr_t kLoopback = htonl(INADDR_LOOPBACK);
LinkShaper::Socket udp() {
  return [sender = std::make_shared<const UdpSender>(std::vector<std::string>{"127.0.0.1"})](
             auto message, in_addr_t address, std::uint16_t port) {
    return sender->send(message, address, port);
  };
}

TEST(LinkShaper, SendsByPriorityAndTheNewestOfAStream) {
  Receiver receiver;
  std::atomic<int> sent{0};
  // 69 B and 28 of headers: 160 ms each.
  LinkShaper link(LinkProfile{.bandwidth = 3500, .latency = 0, .queue = 8}, 1, udp(),
                  {[&](auto, in_addr_t, std::uint16_t) { ++sent; }, {}});
  link.add_writer(0x103, 0, false);
  link.add_writer(0x203, 3, true);
  for (const std::uint8_t tag : {1, 2, 3}) link.send(rtps(0x15, 0x303, tag), kLoopback, receiver.port);
  for (const std::uint8_t tag : {11, 12, 13}) link.send(rtps(0x15, 0x203, tag), kLoopback, receiver.port);
  link.send(rtps(0x15, 0x103, 21), kLoopback, receiver.port);
  const Bytes tags = receiver.tags(5, 300);
  ASSERT_EQ(tags.size(), 5U);
  EXPECT_EQ(sent, 5);
  EXPECT_EQ(link.dropped(), 2U);
  // The first may have been on the air already.
  const auto urgent = std::find(tags.begin(), tags.end(), 21) - tags.begin();
  EXPECT_LE(urgent, 1);
  EXPECT_EQ(std::count(tags.begin(), tags.end(), 13), 1);
  EXPECT_EQ(std::count(tags.begin(), tags.end(), 12), 0);
}

TEST(LinkShaper, CountsQueuedAndDroppedMessagesByClass) {
  Receiver receiver;
  LinkShaper link(LinkProfile{.bandwidth = 1e3, .latency = 0, .queue = 10}, 1, udp(), {});
  link.add_writer(0x203, 3, true);
  for (int i = 0; i < 4; ++i) link.send(rtps(0x15, 0x203), kLoopback, receiver.port);
  link.send(rtps(0x15, 0x303), kLoopback, receiver.port);  // of no writer that it knows: as discovery
  const SenderState state = link.sender();
  EXPECT_EQ(state.link->bandwidth, 1e3);
  // 92 bytes each; the first may be on the air already.
  EXPECT_EQ(state.queue[3], 736ms);
  EXPECT_GE(state.dropped[3], 2U);
  EXPECT_EQ(state.waiting(3), state.queue[1] + state.queue[3]);
  EXPECT_EQ(state.lost(2), 0U);
}

TEST(LinkShaper, BeyondTheRangeNothingArrives) {
  Receiver receiver;
  std::optional<double> metres{};
  LinkShaper link(LinkProfile{.bandwidth = 1e6, .latency = 0, .range = 50}, 1, udp(),
                  {{}, [&](in_addr_t, std::uint16_t) {
                     return Path{metres, 0.0};
                   }});
  metres = 60.0;
  link.send(rtps(0x15, 1, 7), kLoopback, receiver.port);
  EXPECT_TRUE(receiver.tags(0, 100).empty());
  metres = 40.0;
  link.send(rtps(0x15, 1, 8), kLoopback, receiver.port);
  EXPECT_EQ(receiver.tags(1, 100), Bytes{8});
}

TEST(LinkShaper, SendsAQueuedRepairOnce) {
  Receiver receiver;
  LinkShaper link(LinkProfile{.bandwidth = 3500, .latency = 0, .queue = 8}, 1, udp(), {});
  for (int i = 0; i < 10; ++i) {
    for (const std::uint8_t tag : {1, 2, 3}) link.send(rtps(0x15, 0x3c2, tag), kLoopback, receiver.port);
  }
  const Bytes tags = receiver.tags(3, 300);
  EXPECT_LE(tags.size(), 4U);  // the first may have been on the air already
  for (const std::uint8_t tag : {1, 2, 3}) EXPECT_GE(std::count(tags.begin(), tags.end(), tag), 1);
}

/// A radio that takes no datagrams until it is opened.
struct FullRadio {
  LinkShaper::Socket socket() {
    return [this](std::span<const std::uint8_t> message, in_addr_t, std::uint16_t) {
      const std::lock_guard lock(mutex);
      if (open) taken.push_back(message.back());
      return open;
    };
  }
  void set_open(bool is_open) {
    const std::lock_guard lock(mutex);
    open = is_open;
  }
  Bytes tags() {
    const std::lock_guard lock(mutex);
    return taken;
  }
  std::mutex mutex{};
  bool open{};
  Bytes taken{};
};

TEST(LinkShaper, QueuesDatagramsRefusedByTheSocketByPriority) {
  FullRadio radio;
  LinkShaper link(std::nullopt, 1, radio.socket(), {});
  link.add_writer(0x103, 0, false);
  link.add_writer(0x203, 3, true);
  link.send(rtps(0x15, 0x303, 1), kLoopback, 7411);
  ASSERT_TRUE(live::eventually([&] { return link.sender().queue[1] > 0ms; }));
  for (const std::uint8_t tag : {11, 12, 13}) link.send(rtps(0x15, 0x203, tag), kLoopback, 7411);
  link.send(rtps(0x15, 0x103, 21), kLoopback, 7411);
  EXPECT_EQ(link.sender().dropped[3], 2U);
  radio.set_open(true);
  ASSERT_TRUE(live::eventually([&] { return radio.tags().size() == 3; }));
  // The thread may have tried the first one already when the urgent one came.
  const Bytes tags = radio.tags();
  EXPECT_TRUE(tags == (Bytes{1, 21, 13}) || tags == (Bytes{21, 1, 13}));
  link.send(rtps(0x15, 0x303, 2), kLoopback, 7411);
  EXPECT_EQ(radio.tags().size(), 4U);  // on the caller's thread
}

TEST(LinkShaper, DropsAndCountsDatagramsRefusedForTooLong) {
  FullRadio radio;
  LinkShaper link(std::nullopt, 1, radio.socket(), {});
  link.add_writer(0x203, 3, false);
  for (const std::uint8_t tag : {1, 2, 3}) link.send(rtps(0x15, 0x203, tag), kLoopback, 7411);
  EXPECT_TRUE(live::eventually([&] { return link.sender().dropped[3] == 3; }));
  EXPECT_TRUE(live::eventually([&] { return link.sender().queue[3] == 0ms; }));
  EXPECT_TRUE(radio.tags().empty());
}

TEST(LinkShaper, LosesDropsAndCounts) {
  Receiver receiver;
  {
    LinkShaper all(LinkProfile{.bandwidth = 1e6, .loss = 1.0}, 1, udp(), {});
    all.send(rtps(0x15, 1), kLoopback, receiver.port);
    EXPECT_TRUE(receiver.tags(0, 50).empty());
  }
  LinkShaper slow(LinkProfile{.bandwidth = 1e3, .queue = 0.01}, 1, udp(), {});
  for (std::uint8_t i = 0; i < 5; ++i) slow.send(rtps(0x15, 1, i), kLoopback, receiver.port);
  slow.close();
  slow.send(rtps(0x15, 1), kLoopback, receiver.port);
  EXPECT_GE(slow.dropped(), 1U);  // after the end
  EXPECT_LE(receiver.tags(0, 50).size(), 2U);
}

TEST(LinkShaper, SendsItsQueueBeforeItEnds) {
  Receiver receiver;
  {
    LinkShaper link(LinkProfile{.bandwidth = 1e6, .latency = 0.1}, 1, udp(), {});
    for (std::uint8_t i = 0; i < 10; ++i) link.send(rtps(0x15, 1, i), kLoopback, receiver.port);
  }
  EXPECT_EQ(receiver.tags(10, 10).size(), 10U);
}

}  // namespace
}  // namespace adit::wire
