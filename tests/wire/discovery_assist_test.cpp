// SPDX-License-Identifier: Apache-2.0
// Two participants that meet over a bad link know each other soon.
#include "core/wire/fastdds/discovery_assist.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/wire/idle.hpp"

namespace adit::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kPortOfPeer = 7412;
const in_addr_t kLocalhost = htonl(INADDR_LOOPBACK);

Bytes message(std::uint8_t from, const std::vector<Bytes>& submessages) {
  Bytes m{'R', 'T', 'P', 'S', 2, 3, 1, 15};
  m.resize(20, from);
  for (const Bytes& sub : submessages) {
    m.insert(m.end(), {sub[0], sub[1], static_cast<std::uint8_t>(sub.size() - 2), 0});
    m.insert(m.end(), sub.begin() + 2, sub.end());
  }
  return m;
}
Bytes to(std::uint8_t whom) {
  Bytes sub{0x0e, 1};
  sub.resize(14, whom);
  return sub;
}
Bytes announcement(std::uint8_t from, std::uint16_t port, std::uint8_t network = 127) {
  return message(from, {{0x15,
                         5,
                         0,
                         0,
                         16,
                         0,
                         0,
                         1,
                         0,
                         0xc7,
                         0,
                         1,
                         0,
                         0xc2,
                         0,
                         0,
                         0,
                         0,
                         1,
                         0,
                         0,
                         0,
                         0,
                         3,
                         0,
                         0,  // PL_CDR_LE
                         0x15,
                         0,
                         4,
                         0,
                         2,
                         3,
                         0,
                         0,  // protocol version
                         0x32,
                         0,
                         24,
                         0,
                         1,
                         0,
                         0,
                         0,
                         static_cast<std::uint8_t>(port),
                         static_cast<std::uint8_t>(port >> 8),
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         network,
                         0,
                         0,
                         1,
                         1,
                         0,
                         0,
                         0}});
}
Bytes goodbye(std::uint8_t from) {
  return message(from, {{0x15, 1, 0, 0, 16, 0, 0, 1, 0, 0xc7, 0, 1, 0, 0xc2, 0, 0, 0, 0, 2, 0, 0, 0}});
}
Bytes heartbeat(std::uint8_t last, std::uint8_t count) {
  return message(1, {to(2), {0x07, 1, 0, 0, 3, 0xc7, 0, 0,    3, 0xc2, 0, 0,     0, 0, 1,
                             0,    0, 0, 0, 0, 0,    0, last, 0, 0,    0, count, 0, 0, 0}});
}
Bytes acknack(std::uint8_t base) {
  return message(
      2, {to(1), {0x06, 1, 0, 0, 3, 0xc7, 0, 0, 3, 0xc2, 0, 0, 0, 0, base, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}});
}

/// Participant 1, and what it repeats to participant 2.
struct Talk {
  DiscoveryAssist assist{};
  Duration now{1s};
  std::vector<Bytes> repeated{};

  bool sends(Bytes m, std::uint16_t port) { return assist.sent(m, kLocalhost, port, now); }
  void hears(const Bytes& m) { assist.received(m, now); }
  /// Repeats what is due for so long.
  std::size_t pass(Duration time, bool calm = true) {
    const std::size_t before = repeated.size();
    for (const Duration end = now + time; now < end; now += 10ms) {
      if (assist.next() > now) continue;
      assist.repeat(now, calm, [&](auto m, in_addr_t address, std::uint16_t port) {
        EXPECT_EQ(address, kLocalhost);
        EXPECT_EQ(port, kPortOfPeer);
        repeated.emplace_back(m.begin(), m.end());
      });
    }
    return repeated.size() - before;
  }
};

TEST(DiscoveryAssist, RepeatsAnnouncementUntilAcknowledged) {
  Talk talk;
  const Bytes own = announcement(1, 7410);
  EXPECT_TRUE(talk.sends(own, 7400));
  EXPECT_EQ(talk.pass(1s), 0U);
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.pass(1s), 4U);
  EXPECT_EQ(talk.repeated.back(), own);
  talk.hears(message(2, {to(3), to(1)}));  // to another one
  EXPECT_GT(talk.pass(1s), 0U);
  talk.hears(acknack(0));
  EXPECT_EQ(talk.pass(1s), 0U);
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.pass(1s), 0U);
}

TEST(DiscoveryAssist, GivesUpUntilItHearsThePeerAgain) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.pass(1min), static_cast<std::size_t>(Discovery::kAnnounceRetries));
  EXPECT_EQ(talk.assist.next(), Duration::max());
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.pass(1min), static_cast<std::size_t>(Discovery::kAnnounceRetries));
}

TEST(DiscoveryAssist, AnnouncesByMulticastAloneToAPeerThatKnowsUs) {
  Talk talk;
  const Bytes own = announcement(1, 7410);
  talk.sends(own, 7400);
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_TRUE(talk.sends(own, kPortOfPeer));
  talk.hears(acknack(0));
  EXPECT_FALSE(talk.sends(own, kPortOfPeer));
  EXPECT_TRUE(talk.sends(own, 7400));
  EXPECT_TRUE(talk.sends(own, 7414));  // another one
  talk.now += 21s;
  EXPECT_TRUE(talk.sends(own, kPortOfPeer));
  // Another participant came to that address: it does not know us.
  talk.hears(announcement(3, kPortOfPeer));
  EXPECT_TRUE(talk.sends(own, kPortOfPeer));
}

TEST(DiscoveryAssist, SaysAHeartbeatAgainWithAHigherCountUntilItIsAcknowledged) {
  Talk talk;
  talk.hears(announcement(2, kPortOfPeer));
  talk.hears(acknack(0));
  Bytes first = heartbeat(5, 1);
  EXPECT_TRUE(talk.assist.sent(first, kLocalhost, kPortOfPeer, talk.now));
  const auto count = [](const Bytes& m) { return m[m.size() - 4] + (m[m.size() - 3] << 8); };
  EXPECT_EQ(count(first), 16);
  EXPECT_EQ(talk.pass(3s), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(count(talk.repeated[i]), 17 + static_cast<int>(i));
  Bytes second = heartbeat(5, 2);
  talk.assist.sent(second, kLocalhost, kPortOfPeer, talk.now);
  EXPECT_EQ(count(second), 32);
  EXPECT_EQ(talk.pass(3s, false), 0U);  // other things wait to be sent
  talk.hears(acknack(5));
  EXPECT_EQ(talk.pass(300ms), 1U);
  talk.hears(acknack(6));
  EXPECT_EQ(talk.pass(3s), 0U);
}

TEST(DiscoveryAssist, APeerThatComesBackAfterItsLeaseIsMetAsANewOne) {
  Talk talk;
  const Bytes own = announcement(1, 7410);
  talk.sends(own, 7400);
  talk.hears(announcement(2, kPortOfPeer));
  talk.hears(acknack(0));
  EXPECT_EQ(talk.pass(1s), 0U);
  // Our last announcement to it alone is recent, and got lost in the gap.
  talk.now += Discovery::kLease - 5s;
  EXPECT_TRUE(talk.sends(own, kPortOfPeer));
  talk.now += 10s;
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_NE(talk.assist.next(), Duration::max());
  EXPECT_TRUE(talk.sends(own, kPortOfPeer));  // the library's only answer
  EXPECT_EQ(talk.pass(1s), 4U);
}

TEST(DiscoveryAssist, APeerThatFellSilentIsSearchedUntilItIsHeardAgain) {
  Talk talk;
  const Bytes own = announcement(1, 7410);
  const ParticipantId peer = peek(message(2, {})).source.value();
  talk.sends(own, 7400);
  talk.hears(announcement(2, kPortOfPeer));
  talk.hears(acknack(0));
  EXPECT_EQ(talk.pass(Discovery::kLease), 0U);
  talk.assist.dropped(peer, talk.now);
  EXPECT_EQ(talk.pass(1min), 30U);
  EXPECT_EQ(talk.repeated.back(), own);
  talk.hears(announcement(2, kPortOfPeer));
  talk.hears(acknack(0));
  EXPECT_EQ(talk.pass(1min), 0U);
  EXPECT_EQ(talk.assist.next(), Duration::max());
}

TEST(DiscoveryAssist, NoPeerIsSearchedThatSaidGoodbyeOrCameBackAsAnotherOrNeverKnewUs) {
  const ParticipantId peer = peek(message(2, {})).source.value();
  for (const char* how : {"goodbye", "another", "never knew us"}) {
    Talk talk;
    talk.sends(announcement(1, 7410), 7400);
    talk.hears(announcement(2, kPortOfPeer));
    if (how != std::string("never knew us")) talk.hears(acknack(0));
    talk.pass(10s);
    if (how == std::string("goodbye")) talk.hears(goodbye(2));
    talk.assist.dropped(peer, talk.now);
    if (how == std::string("another")) {
      talk.hears(announcement(3, kPortOfPeer));
      talk.hears(message(3, {to(1)}));
    }
    EXPECT_EQ(talk.pass(1min), 0U) << how;
  }
}

TEST(DiscoveryAssist, TheSearchOfManyIsBoundedAndEnds) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  for (std::uint8_t from = 2; from < 102; ++from) {
    talk.hears(announcement(from, static_cast<std::uint16_t>(8000 + 2 * from)));
    talk.hears(message(from, {to(1)}));
    talk.assist.dropped(peek(message(from, {})).source.value(), talk.now);
  }
  std::map<std::uint16_t, int> sent;
  const auto pass = [&](Duration time) {
    for (const Duration end = talk.now + time; talk.now < end; talk.now += 100ms)
      if (talk.assist.next() <= talk.now)
        talk.assist.repeat(talk.now, true, [&](auto, in_addr_t, std::uint16_t port) { ++sent[port]; });
  };
  pass(64s);
  EXPECT_EQ(sent.size(), 64U);
  for (const auto& [port, count] : sent) EXPECT_EQ(count, 2) << port;
  pass(Discovery::kSearch);
  EXPECT_EQ(talk.assist.next(), Duration::max());
}

TEST(DiscoveryAssist, AnythingHeardRenewsThePeersLease) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  talk.hears(announcement(2, kPortOfPeer));
  talk.hears(acknack(0));
  for (int i = 0; i < 4; ++i) {
    talk.now += Discovery::kLease / 2;
    talk.hears(message(2, {to(3)}));
  }
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.assist.next(), Duration::max());
}

TEST(DiscoveryAssist, SpoofedAnnouncementsCauseABoundedNumberOfOurs) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  const auto forge = [&](std::uint8_t from) { talk.hears(announcement(from, kPortOfPeer + from)); };
  for (std::uint8_t from = 2; from < 202; ++from) forge(from);
  std::size_t sent = 0;
  const auto count = [&](auto, in_addr_t, std::uint16_t) { ++sent; };
  for (const Duration end = talk.now + 1s; talk.now < end; talk.now += 10ms)
    talk.assist.repeat(talk.now, true, count);
  EXPECT_GT(sent, 100U);  // Ten robots and ten stations that start together are all helped at once.
  EXPECT_LE(sent, 300U);
}

TEST(DiscoveryAssist, AnnouncesItselfToItsOwnNetworksAlone) {
  Talk talk;
  talk.assist.set_reachable([](in_addr_t address) { return (ntohl(address) >> 24) == 127; });
  talk.sends(announcement(1, 7410), 7400);
  talk.hears(announcement(3, kPortOfPeer, 10));
  EXPECT_EQ(talk.assist.next(), Duration::max());
  talk.hears(announcement(2, kPortOfPeer));
  EXPECT_EQ(talk.pass(1s), 4U);
}

TEST(DiscoveryAssist, HelpsANewcomerAfterManyPeersFellSilent) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  for (int i = 0; i < 300; ++i) {
    Bytes one = announcement(2, static_cast<std::uint16_t>(8000 + 2 * i));
    one[8] = static_cast<std::uint8_t>(i), one[9] = static_cast<std::uint8_t>(i >> 8);
    talk.hears(one);
    talk.now += 1s;
  }
  for (int i = 0; i < 40; ++i, talk.now += 1s)
    talk.assist.repeat(talk.now, true, [](auto, in_addr_t, std::uint16_t) {});
  ASSERT_EQ(talk.assist.next(), Duration::max());
  talk.hears(announcement(3, kPortOfPeer));
  EXPECT_NE(talk.assist.next(), Duration::max());
}

TEST(DiscoveryAssist, CutShortOrStrangeMessagesAreOfNoConcern) {
  Talk talk;
  talk.sends(announcement(1, 7410), 7400);
  for (const Bytes& complete : {announcement(2, kPortOfPeer), heartbeat(5, 1), acknack(0)}) {
    for (std::size_t n = 0; n < complete.size(); ++n) {
      Bytes cut(complete.begin(), complete.begin() + static_cast<long>(n));
      talk.hears(cut);
      (void)talk.assist.sent(cut, kLocalhost, 7410, talk.now);
    }
  }
  Bytes big_endian = announcement(2, kPortOfPeer);
  big_endian[21] = 4;
  talk.hears(big_endian);
  talk.pass(1s);
}

/// A robot and a station whose frames are lost as often as not; when all that concerns both is matched.
struct Pair {
  template <class Net>
  explicit Pair(Net& net) : robot(bench::robot(net, "r0")), station(bench::station(net, "op0", 1)) {}
  bool complete() const {
    // Each matches its own capabilities, and no peer reads a station's link report.
    const auto all = [](const auto& writers) {
      return std::all_of(writers.begin(), writers.end(), [](const auto& w) { return w->matched() > 0; });
    };
    const std::vector robots(robot->writers.begin() + 1, robot->writers.end());
    return all(robots) && all(station->commands) && station->writers[1]->matched() > 0;
  }
  std::unique_ptr<bench::Idle> robot, station;
};
const LinkProfile kLossy{.name = "lossy", .bandwidth = 500e3, .latency = 0.02, .loss = 0.4};

/// MemoryNet of a seed; the second one joins when the first has fallen into its long period.
class SeededNet {
 public:
  explicit SeededNet(std::uint64_t seed) : network_(scheduler_, {.seed = seed, .link = kLossy}) {}
  std::unique_ptr<Participant> join(const std::string& name) {
    if (machines_++ > 0) pass(late);
    began = scheduler_.elapsed();
    return network_.join(77, name);
  }
  std::shared_ptr<Executor> strand(const std::string& name) {
    runtimes_.push_back(scheduler_.machine(name, 0ms));
    return runtimes_.back()->strand(name);
  }
  void pass(Duration time) { scheduler_.run_until(scheduler_.elapsed() + time); }
  Duration elapsed() const { return scheduler_.elapsed(); }
  Duration late{}, began{};

 private:
  VirtualScheduler scheduler_{1};
  SimulatedNetwork network_;
  int machines_{};
  std::vector<std::unique_ptr<Runtime>> runtimes_{};
};

void expect_soon_in_memory(Duration late) {
  std::vector<double> took;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SeededNet net(seed);
    net.late = late;
    Pair pair(net);
    while (!pair.complete() && net.elapsed() - net.began < 60s) net.pass(20ms);
    took.push_back(seconds(net.elapsed() - net.began));
    pair.robot->timers.clear(), pair.station->timers.clear();
  }
  std::sort(took.begin(), took.end());
  std::printf("median %.2f s, 99th %.2f s, worst %.2f s\n", took[100], took[197], took[199]);
  EXPECT_LT(took[197], 5.0);
}

TEST(ContactInMemory, TwoThatStartTogetherKnowEachOtherWithinFiveSeconds) { expect_soon_in_memory(0s); }
TEST(ContactInMemory, ANewcomerIsKnownWithinFiveSeconds) { expect_soon_in_memory(10s); }

/// Fast DDS on a domain of its own.
class PairNet {
 public:
  PairNet(unsigned index, std::uint64_t seed) : index_(index), seed_(seed) {}
  std::unique_ptr<Participant> join(const std::string& name) {
    return std::move(
               open_fastdds(
                   {.domain = live::domain(index_), .name = name, .link = kLossy, .link_seed = ++seed_}))
        .value();
  }
  std::shared_ptr<Executor> strand(const std::string& name) { return runtime_.strand(name); }

 private:
  unsigned index_;
  std::uint64_t seed_;
  LiveRuntime runtime_{};
};

TEST(ContactLive, TwoThatStartTogetherKnowEachOtherSoon) {
  std::vector<double> took;
  for (std::uint64_t turn = 0; turn < 3; ++turn) {
    std::vector<std::unique_ptr<PairNet>> nets;
    std::vector<std::unique_ptr<Pair>> pairs;
    const auto start = std::chrono::steady_clock::now();
    for (unsigned i = 0; i < 3; ++i) {
      nets.push_back(std::make_unique<PairNet>(i, 100 * turn + 10 * i));
      pairs.push_back(std::make_unique<Pair>(*nets.back()));
    }
    std::vector<bool> done(pairs.size());
    const bool all = live::eventually(
        [&] {
          for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (done[i] || !pairs[i]->complete()) continue;
            done[i] = true;
            took.push_back(seconds(std::chrono::steady_clock::now() - start));
          }
          return std::find(done.begin(), done.end(), false) == done.end();
        },
        live::Seconds(15));
    EXPECT_TRUE(all) << "turn " << turn;
    for (auto& pair : pairs) pair->robot->timers.clear(), pair->station->timers.clear();
  }
  for (const double s : took) std::printf("%.2f s\n", s);
}

}  // namespace
}  // namespace adit::wire
