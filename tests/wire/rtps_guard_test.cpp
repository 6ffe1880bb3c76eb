// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/rtps_guard.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "tests/folders/folders.hpp"
#include "tests/wire/kept_datagrams.hpp"
#include "tests/wire/rtps_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace adit::wire {
namespace {

using namespace test;

const ParticipantId kUs = participant(1), kRobot = participant(2), kStranger = participant(3);
constexpr std::uint32_t kWriter = 0x00000103;
const RtpsGuard::Source kRobotSocket{::inet_addr("10.0.0.2"), 40000},
    kStrangerSocket{::inet_addr("10.0.0.3"), 40000};

/// A participant of the radio domain with the address 10.0.0.1 in 10.0.0.0/24, and 10.1.0.1 in 10.1.0.0/24.
class Guarded {
 public:
  explicit Guarded(bool radio = true) {
    const auto network = [](in_addr_t a) { return ntohl(a) >> 8; };
    const auto ours = [network](in_addr_t a) { return network(a) == 0x0a0000 || network(a) == 0x0a0100; };
    guard.set({radio, ours, [=](in_addr_t a, in_addr_t b) { return ours(a) && network(a) == network(b); },
               [](RtpsGuard::Source s) {
                 return s == RtpsGuard::Source{::inet_addr("10.0.0.1"), 50000};
               }});
    guard.admit_samples(100'000);
  }
  /// What passes of the message; nothing: it was refused, or the library needs nothing of it.
  std::optional<Bytes> pass(const Bytes& message, RtpsGuard::Source from, Duration now = 1s) {
    Bytes copy;
    const auto passed = guard.pass(message, from, kUs, now, copy);
    if (passed.empty()) return std::nullopt;
    return Bytes(passed.begin(), passed.end());
  }
  /// Whether all of it passes.
  bool passes(const std::vector<Bytes>& parts, Duration now = 1s) {
    const Bytes message = rtps_message(kRobot, parts);
    const auto passed = pass(message, kRobotSocket, now);
    return passed && passed->size() == message.size();
  }
  bool meet(const ParticipantId& who, RtpsGuard::Source from, Duration now = 1s) {
    in_addr ip{from.address};
    return pass(rtps_message(who, {announcement(who, {locator(::inet_ntoa(ip), 7410)})}), from, now)
        .has_value();
  }
  bool meet_robot() {
    return meet(kRobot, kRobotSocket) && passes({endpoint(kPublications, kRobot, kWriter, "adit/health", 1)});
  }
  std::uint64_t refused(Refusal why) const { return guard.refused()[static_cast<std::size_t>(why)]; }

  RtpsGuard guard{};
};

Bytes statistics() { return submessage(0x80, Bytes(56)); }

TEST(RtpsGuard, RemovesSubmessagesOfVendorsWhereverTheyAre) {
  Guarded g(false);
  const auto passed = [&](const std::vector<Bytes>& parts) {
    return *g.pass(rtps_message(kRobot, parts), kRobotSocket);
  };
  const Bytes first = heartbeat(1, 5, 6), second = heartbeat(2, 6, 7, 2), time = submessage(0x09, {}, 2);
  const Bytes vendor = submessage(0xff, {1, 2, 3, 4});
  const Bytes both = rtps_message(kRobot, {first, second});
  EXPECT_EQ(passed({first, second}), both);
  EXPECT_EQ(passed({first, second, statistics()}), both);
  EXPECT_EQ(passed({statistics(), first, second}), both);
  EXPECT_EQ(passed({vendor, first, statistics(), second, vendor}), both);
  // An empty timestamp is not the last submessage, as an empty one of other kinds is.
  EXPECT_EQ(passed({time, statistics(), first}), rtps_message(kRobot, {time, first}));
  EXPECT_EQ(passed({statistics()}), rtps_message(kRobot, {}));
}

TEST(RtpsGuard, RefusesWhatDoesNotFit) {
  Guarded g(false);
  const Bytes header = rtps_message(kRobot, {});
  for (std::size_t n = 0; n < header.size(); ++n)
    EXPECT_FALSE(g.pass({header.begin(), header.begin() + static_cast<std::ptrdiff_t>(n)}, kRobotSocket));
  const std::vector<Bytes> faults{
      submessage(0x07, Bytes(5)),
      submessage(0x07, Bytes(24)),
      submessage(0x15, Bytes(20)),
      submessage(0x55, Bytes(8)),
      submessage(0x0c, Bytes(20)),
      submessage(0x06, Bytes(16)),
      heartbeat(kWriter, 0, 5),
      heartbeat(kWriter, 9, 5),
      gap(kWriter, 0, 5),
      gap(kWriter, 9, 5),
      data(0, kWriter, 0, Bytes(8)),
      fragment(kWriter, 1, 1, 1, 0, 100, 100),
      fragment(kWriter, 1, 0, 1, 50, 100, 50),   // The first fragment has number 1.
      fragment(kWriter, 1, 3, 1, 50, 100, 50),   // There are two fragments.
      fragment(kWriter, 1, 1, 2, 50, 100, 50),   // Less than it says.
      data(0, kWriter, 1, Bytes(8), Bytes(8))};  // Parameters without an end.
  std::uint64_t count = header.size();
  for (const Bytes& fault : faults) {
    EXPECT_FALSE(g.passes({heartbeat(kWriter, 1, 5), fault})) << count;
    EXPECT_EQ(g.refused(Refusal::malformed) + g.refused(Refusal::forged), ++count);
  }
  // Nothing is read beyond the end, and a truncated submessage is removed.
  const Bytes cut = rtps_message(kRobot, {heartbeat(1, 5, 6), heartbeat(1, 6, 7)});
  for (std::size_t n = 52; n < cut.size(); ++n)
    EXPECT_EQ(g.pass({cut.begin(), cut.begin() + static_cast<std::ptrdiff_t>(n)}, kRobotSocket)->size(), 52U);
}

TEST(RtpsGuard, BoundsJumpsOfNumbers) {
  constexpr std::uint64_t far = 1ULL << 40, huge = 1ULL << 61, begin = 60'000'000;
  for (const bool radio : {false, true}) {
    Guarded g(radio);
    ASSERT_TRUE(g.meet_robot());
    EXPECT_FALSE(g.passes({heartbeat(kWriter, huge, huge)}));
    EXPECT_FALSE(g.passes({gap(kWriter, 1, far)}));
    EXPECT_FALSE(g.passes({heartbeat(kWriter, 1, far)}));
    // A writer that was not announced, or that the library knows although it said goodbye.
    EXPECT_FALSE(g.passes({heartbeat(0x999, huge, huge)}));
    EXPECT_EQ(g.refused(Refusal::number_jump), 4U);
    // A long mission, joined late, and a gap in it.
    EXPECT_TRUE(g.passes({gap(kWriter, begin, begin + 10), heartbeat(kWriter, begin, begin + 20)}));
    EXPECT_TRUE(g.passes({data(0, kWriter, begin + 21, Bytes(8))}));
    EXPECT_TRUE(g.passes({gap(kWriter, begin + 21, begin + 300)}));
    EXPECT_FALSE(g.passes({data(0, kWriter, far, Bytes(8))}));
    EXPECT_TRUE(g.passes({data(0, kWriter, begin + 22, Bytes(8))}));
    // What comes with a jump passes: it can be what is waited for.
    EXPECT_EQ(*g.pass(rtps_message(kRobot,
                                   {heartbeat(kWriter, huge, huge), data(0, kWriter, begin + 23, Bytes(8))}),
                      kRobotSocket),
              rtps_message(kRobot, {data(0, kWriter, begin + 23, Bytes(8))}));
    // After an hour out of range.
    EXPECT_EQ(g.passes({heartbeat(kWriter, begin + 300'000, begin + 300'001)}, 3600s), !radio)
        << "on the radio its lease is over";
  }
}

TEST(RtpsGuard, ManySmallStepsOfNumbersGoNotFar) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  ASSERT_TRUE(g.passes({heartbeat(kWriter, 1, 1)}));
  std::uint64_t gaps = 1, beat = 1, sample = 1;
  for (Duration now = 1s; now < 61s; now += 10ms) {
    // Heartbeats of the same count, which the library ignores, in large steps and small ones.
    for (const std::uint64_t step : {60'000ULL, 5'000ULL, 500ULL}) {
      if (g.passes({heartbeat(kWriter, beat + step, beat + step)}, now)) beat += step;
      if (g.passes({data(0, kWriter, sample + step, Bytes(8))}, now)) sample += step;
    }
    if (g.passes({gap(kWriter, gaps, gaps + 1000)}, now)) gaps += 1000;
  }
  EXPECT_LT(gaps, RtpsGuard::kMaxGap + 61 * RtpsGuard::kGapPerSecond);
  const std::uint64_t most = 60 * RtpsGuard::kNumbersPerSecond + RtpsGuard::kMaxJump + 60'000;
  EXPECT_LT(beat, most);
  EXPECT_LT(sample, most);
}

TEST(RtpsGuard, WhatAddressesAnotherParticipantIsRemoved) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  const Bytes to_other = destination(participant(7)), to_us = destination(kUs),
              beat = heartbeat(kWriter, 1, 5);
  EXPECT_EQ(*g.pass(rtps_message(kRobot, {to_other, goodbye(kRobot), to_us, beat}), kRobotSocket),
            rtps_message(kRobot, {to_other, to_us, beat}));
  EXPECT_TRUE(g.passes({beat}));
}

TEST(RtpsGuard, BoundsSamplesByTheLargestTopic) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  EXPECT_TRUE(g.passes({fragment(kWriter, 1, 1, 1, 1000, 100'000, 1000)}));
  EXPECT_FALSE(g.passes({fragment(kWriter, 2, 1, 1, 1000, 101'000, 1000)}));
  EXPECT_FALSE(g.passes({fragment(kWriter, 2, 1, 1, 1000, 2'000'000'000, 1000)}));
  EXPECT_FALSE(g.passes({fragment(0x999, 2, 1, 1, 1000, 0, 1000)}));
  EXPECT_EQ(g.refused(Refusal::sample_size), 3U);
  // The library copies later fragments by the sizes of the first one.
  EXPECT_TRUE(g.passes({fragment(kWriter, 3, 1, 1, 1400, 60'000, 1400)}));
  EXPECT_FALSE(g.passes({fragment(kWriter, 3, 2, 42, 1, 43, 42)}));
  for (std::uint64_t number = 4; number < 200; ++number)
    EXPECT_TRUE(g.passes({fragment(kWriter, number, 1, 1, 1400, 60'000, 1400)}));
  EXPECT_FALSE(g.passes({fragment(kWriter, 3, 2, 42, 1, 43, 42)}))
      << "it was forgotten, but not by the library";
}

TEST(RtpsGuard, BelievesAParticipantFromItsSocketAlone) {
  Guarded g;
  EXPECT_FALSE(g.passes({heartbeat(kWriter, 1, 5)}));  // Not announced, which is no fault.
  EXPECT_EQ(g.guard.refused(), RefusalCounts{});
  ASSERT_TRUE(g.meet_robot());
  const Bytes beat = rtps_message(kRobot, {heartbeat(kWriter, 1, 6)});
  const Bytes hello = rtps_message(kRobot, {announcement(kRobot, {locator("10.0.0.3", 7410)})});
  for (const RtpsGuard::Source other : {kStrangerSocket, RtpsGuard::Source{kRobotSocket.address, 40001}}) {
    EXPECT_FALSE(g.pass(beat, other));
    EXPECT_FALSE(g.pass(hello, other));
    EXPECT_FALSE(g.pass(rtps_message(kRobot, {goodbye(kRobot)}), other));
  }
  EXPECT_EQ(g.refused(Refusal::forged), 6U);
  EXPECT_TRUE(g.pass(beat, kRobotSocket));
  // In our own name.
  EXPECT_FALSE(g.pass(rtps_message(kUs, {heartbeat(kWriter, 1, 6)}), kStrangerSocket));
  EXPECT_TRUE(g.pass(rtps_message(kUs, {heartbeat(kWriter, 1, 6)}), {::inet_addr("10.0.0.1"), 50000}));
  // In the name of another, behind an own header.
  ASSERT_TRUE(g.meet(kStranger, kStrangerSocket));
  Bytes source(8);
  source.insert(source.end(), kRobot.begin(), kRobot.end());
  EXPECT_FALSE(
      g.pass(rtps_message(kStranger, {submessage(0x0c, source), heartbeat(kWriter, 1, 6)}), kStrangerSocket));
}

TEST(RtpsGuard, AParticipantMovesToAnotherSocketAfterSilenceOrGoodbye) {
  const RtpsGuard::Source later{kRobotSocket.address, 40009};
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  EXPECT_FALSE(g.meet(kRobot, later, 3900ms));
  EXPECT_FALSE(g.pass(rtps_message(kRobot, {heartbeat(kWriter, 1, 6)}), later, 4s));
  EXPECT_TRUE(g.meet(kRobot, later, 4s));
  // The first socket takes the name back, and the other one must wait.
  EXPECT_TRUE(g.passes({heartbeat(kWriter, 1, 6)}, 4s));
  EXPECT_FALSE(g.meet(kRobot, later, 4s));
  EXPECT_TRUE(g.passes({goodbye(kRobot)}, 5s));
  EXPECT_TRUE(g.meet(kRobot, later, 5s));
  EXPECT_TRUE(g.pass(rtps_message(kRobot, {goodbye(kRobot)}), later, 5s));
  EXPECT_TRUE(g.meet(kRobot, kRobotSocket, 5s));
  // After its lease the library has forgotten it, too: only an announcement shows that it is back.
  EXPECT_FALSE(g.passes({heartbeat(kWriter, 1, 6)}, 66s));
  EXPECT_TRUE(g.meet(kRobot, kRobotSocket, 66s));
}

TEST(RtpsGuard, BelievesDiscoveryDataFromTheOneThatItIsAbout) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  ASSERT_TRUE(g.meet(kStranger, kStrangerSocket));
  const auto refused = [&](const Bytes& part) {
    const std::uint64_t before = g.refused(Refusal::foreign);
    return !g.pass(rtps_message(kStranger, {part}), kStrangerSocket) &&
           g.refused(Refusal::foreign) == before + 1;
  };
  EXPECT_TRUE(refused(goodbye(kRobot)));
  EXPECT_TRUE(refused(announcement(kRobot, {locator("10.0.0.3", 7410)})));
  EXPECT_TRUE(refused(endpoint(kPublications, kRobot, kWriter, "adit/health", 1)));
  const Bytes qos = list({parameter(0x70, guid(kRobot, kWriter)), parameter(0x71, {0, 0, 0, 3})});
  EXPECT_TRUE(refused(data(0, kPublications, 3, {}, qos)));
  EXPECT_TRUE(refused(data(0, kSubscriptions, 3, {}, qos)));
  // By another writer to the readers of discovery data.
  for (const std::uint32_t reader : {0x000100c7U, 0x000003c7U, 0x000004c7U})
    EXPECT_TRUE(refused(data(reader, kWriter, 3, {}, qos)));
  // By the key of an announcement in its own name.
  const auto with_key = [&](std::uint32_t writer, std::uint16_t name, std::uint32_t entity) {
    return data(0, writer, 4,
                payload({parameter(name, guid(kStranger, entity)), parameter(0x70, guid(kRobot, entity)),
                         parameter(0x32, locator("10.0.0.3", 7410))}));
  };
  EXPECT_TRUE(refused(with_key(kAnnouncer, 0x50, 0x1c1)));
  EXPECT_TRUE(refused(with_key(kPublications, 0x5a, kWriter)));
  // Data without a name.
  EXPECT_TRUE(refused(data(0, kPublications, 3, payload({}))));
  Bytes key(guid(kRobot, 0x1c1));
  Bytes body;
  add(body, 16U << 16, 4);
  add_entity(body, 0);
  add_entity(body, kAnnouncer);
  add_number(body, 4);
  body.insert(body.end(), key.begin(), key.end());
  EXPECT_FALSE(g.pass(rtps_message(kStranger, {submessage(0x15, body, 8)}), kStrangerSocket));
  EXPECT_TRUE(g.passes({heartbeat(kWriter, 1, 6)}));
}

/// The parameters of an announcement that passed, by id.
std::multimap<std::uint16_t, Bytes> parameters(const Bytes& message) {
  std::multimap<std::uint16_t, Bytes> out;
  for (std::size_t at = 20 + 4 + 20 + 4; at + 4 <= message.size();) {
    const auto id = static_cast<std::uint16_t>(message[at] | message[at + 1] << 8);
    const std::size_t length = message[at + 2] | message[at + 3] << 8;
    if (id == 1) break;
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(at + 4);
    out.emplace(id, Bytes(begin, begin + static_cast<std::ptrdiff_t>(length)));
    at += 4 + length;
  }
  return out;
}

TEST(RtpsGuard, AnnouncementsNameTheirOwnAddressesAndOneLease) {
  Guarded g;
  const Bytes own = locator("10.0.0.2", 7410), other_network = locator("10.1.0.2", 7410);
  const std::vector<Bytes> victims{locator("10.0.0.9", 7410), locator("192.0.2.1", 7410),
                                   locator("10.0.0.2", 0), locator("10.0.0.2", 7410, 2)};
  std::vector<Bytes> all{own, other_network};
  all.insert(all.end(), victims.begin(), victims.end());
  const auto passed =
      g.pass(rtps_message(kRobot, {statistics(), announcement(kRobot, all, 1'000'000)}), kRobotSocket);
  ASSERT_TRUE(passed);
  const auto list = parameters(*passed);
  EXPECT_EQ(list.count(0x32), 2U);
  EXPECT_EQ(list.find(0x02)->second, (Bytes{60, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(list.find(0x50)->second, guid(kRobot, 0x1c1));
  // It may send from each of its addresses.
  EXPECT_TRUE(g.pass(rtps_message(kRobot, {heartbeat(kWriter, 1, 6)}), {::inet_addr("10.1.0.2"), 40000}));
  EXPECT_FALSE(g.pass(rtps_message(kRobot, {heartbeat(kWriter, 1, 6)}), {::inet_addr("10.0.0.9"), 40000}));
  // One that names others alone is not answered.
  EXPECT_FALSE(g.pass(rtps_message(kStranger, {announcement(kStranger, victims)}), kStrangerSocket));
  EXPECT_EQ(g.refused(Refusal::foreign), 1U);
  // An endpoint receives where its participant does.
  const auto reader = g.pass(rtps_message(kRobot, {endpoint(kSubscriptions, kRobot, 0x307, "adit/health", 1,
                                                            {victims[0], own, victims[1]})}),
                             kRobotSocket);
  ASSERT_TRUE(reader);
  EXPECT_EQ(parameters(*reader).count(0x2f), 1U);
}

// Found by tools/fuzz.sh: what was to be changed in a submessage that is removed was written behind the rest.
TEST(RtpsGuard, ARemovedAnnouncementIsNotRewritten) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  const Bytes foreign = locator("10.0.0.9", 7410), own = locator("10.0.0.2", 7410);
  ASSERT_TRUE(g.passes({announcement(kRobot, {own}, 60, 2)}));
  EXPECT_EQ(
      *g.pass(rtps_message(kRobot, {announcement(kRobot, {foreign, own}, 5, 1ULL << 40)}), kRobotSocket),
      rtps_message(kRobot, {}));
  EXPECT_EQ(g.refused(Refusal::number_jump), 1U);
}

TEST(RtpsGuard, BoundsParticipantsAndTheirEndpoints) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  const auto invented = [](std::size_t i) {
    ParticipantId id{};
    id[0] = 9, id[1] = static_cast<std::uint8_t>(i), id[2] = static_cast<std::uint8_t>(i >> 8);
    return id;
  };
  std::size_t met = 0;
  for (std::size_t i = 0; i < 500; ++i) met += g.meet(invented(i), kStrangerSocket) ? 1 : 0;
  EXPECT_EQ(met, RtpsGuard::kMaxUnanswered);
  EXPECT_EQ(g.refused(Refusal::too_many), 500 - met);
  // From many addresses: there is room again when their leases are over.
  const auto from = [](std::size_t i) {
    return RtpsGuard::Source{htonl(0x0a000400 + static_cast<std::uint32_t>(i)), 40000};
  };
  for (std::size_t i = 0; i < 500; ++i) met += g.meet(invented(500 + i), from(i)) ? 1 : 0;
  EXPECT_EQ(met + 1, RtpsGuard::kMaxParticipants);
  EXPECT_TRUE(g.passes({heartbeat(kWriter, 1, 6)}, 30s));
  EXPECT_TRUE(g.meet(kStranger, kStrangerSocket, 62s));
  EXPECT_TRUE(g.passes({heartbeat(kWriter, 1, 6)}, 62s));
  // Endpoints come and go without an end, but are not more than the bound at a time.
  std::uint32_t entity = 0x1000;
  std::uint64_t number = 2;
  while (g.passes({endpoint(kSubscriptions, kRobot, entity, "adit/health", number)}, 62s)) ++entity, ++number;
  EXPECT_EQ(entity - 0x1000, RtpsGuard::kMaxEndpoints - 1);
  const Bytes qos = list({parameter(0x70, guid(kRobot, 0x1000)), parameter(0x71, {0, 0, 0, 3})});
  EXPECT_TRUE(g.passes({data(0, kSubscriptions, number, {}, qos)}, 62s));
  EXPECT_TRUE(g.passes({endpoint(kSubscriptions, kRobot, entity, "adit/health", number)}, 62s));
}

TEST(RtpsGuard, AGoodbyeIsWhatTheLibraryTakesForOne) {
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  const auto with_status = [](std::uint8_t high, std::uint8_t low) {
    return data(0, kPublications, 2, {},
                list({parameter(0x70, guid(kRobot, kWriter)), parameter(0x71, {high, 0, 0, low})}));
  };
  EXPECT_FALSE(g.passes({with_status(0, 5)}));
  EXPECT_FALSE(g.passes({with_status(1, 1)}));
  EXPECT_FALSE(g.passes({with_status(0, 0)}));
  EXPECT_FALSE(g.passes({data(0, kPublications, 2, {}, list({parameter(0x70, guid(kRobot, kWriter))}))}));
  EXPECT_EQ(g.refused(Refusal::malformed), 4U);
  EXPECT_TRUE(g.passes({with_status(0, 3)}));
}

TEST(RtpsGuard, RationsWhatIsSentToOneThatNeverAnswers) {
  Guarded g;
  ASSERT_TRUE(g.meet(kStranger, kStrangerSocket));
  std::uint64_t sent = 0;
  for (Duration now = 1s; now < 61s; now += 10ms)
    sent += g.guard.may_send(kStrangerSocket.address, 7410, 1000, now) ? 1000 : 0;
  EXPECT_LE(sent, RtpsGuard::kFirstBytes + 60 * RtpsGuard::kBytesPerSecond);
  EXPECT_GT(g.refused(Refusal::rationed), 0U);
  // Others are not held up by it, nor is it once it has addressed us.
  EXPECT_TRUE(g.guard.may_send(kRobotSocket.address, 7410, 1000, 60s));
  const Bytes answer = rtps_message(kStranger, {destination(kUs), heartbeat(kWriter, 1, 5)});
  EXPECT_TRUE(g.pass(answer, kStrangerSocket, 60s));
  EXPECT_TRUE(g.guard.may_send(kStrangerSocket.address, 7410, 1'000'000, 60s));
  // A newcomer that names the port of a known one does not ration it.
  ASSERT_TRUE(g.meet(participant(4), kStrangerSocket, 60s));
  EXPECT_TRUE(g.guard.may_send(kStrangerSocket.address, 7410, 1'000'000, 60s));
}

TEST(RtpsGuard, SurvivesDamagedMessages) {
  std::mt19937 random(1);
  Guarded g;
  ASSERT_TRUE(g.meet_robot());
  const std::vector<Bytes> whole{
      rtps_message(kRobot, {statistics(), announcement(kRobot, {locator("10.0.0.2", 7410)})}),
      rtps_message(kRobot, {destination(kUs), endpoint(kPublications, kRobot, 0x203, "adit/presence", 2)}),
      rtps_message(kRobot, {fragment(kWriter, 1, 1, 1, 1000, 4000, 1000), heartbeat(kWriter, 1, 9)}),
      rtps_message(kRobot, {gap(kWriter, 1, 9), goodbye(kRobot)})};
  for (int i = 0; i < 20'000; ++i) {
    Bytes damaged = whole[random() % whole.size()];
    for (auto n = random() % 4; n-- > 0;)
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    damaged.resize(random() % 4 == 0 ? random() % damaged.size() : damaged.size());
    Bytes copy;
    const auto passed = g.guard.pass(damaged, kRobotSocket, kUs, 1s, copy);
    EXPECT_LE(passed.size(), damaged.size());
  }
}

TEST(RtpsGuard, WhatTheFuzzerFoundWorthKeepingIsSafe) {
  const auto kept = kept_datagrams(source_folder() + "/tests/wire/datagrams.corpus");
  ASSERT_GT(kept.size(), 500U);
  for (const auto& input : kept) EXPECT_EQ(LLVMFuzzerTestOneInput(input.data(), input.size()), 0);
}

}  // namespace
}  // namespace adit::wire
