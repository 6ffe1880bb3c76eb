// SPDX-License-Identifier: Apache-2.0
// The same small body over the in-memory wire and over Fast DDS: what a rehearsal shows is what happens live.
#include <gtest/gtest.h>

#include <set>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/robot.h"
#include "core/wire/component_io.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "tests/wire/nets.hpp"
#include "tests/wire/numbered_command.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::wire {
namespace {

using Seqs = std::vector<std::uint64_t>;

std::uint64_t total(const Participant& wire, std::uint64_t TopicCount::*field) {
  std::uint64_t sum = 0;
  for (const TopicCount& count : wire.counters().topics) sum += count.*field;
  return sum;
}

template <class Net>
class Conformance : public testing::Test {
 protected:
  std::unique_ptr<RawReader> hear(Participant& wire, const std::string& partition,
                                  Seen<std::uint64_t>& seen) {
    return std::move(make_reader(
                         wire, topics::kCommand, *strand,
                         [&seen](const radio::Command& c, const SampleInfo&) { seen.add(c.seq()); },
                         partition))
        .value();
  }
  Writer<radio::Command> commands(Participant& wire, const std::string& partition) {
    return std::move(Writer<radio::Command>::make(wire, topics::kCommand, partition)).value();
  }

  Net net{};
  std::shared_ptr<Executor> strand{net.strand("test")};
  std::unique_ptr<Participant> station{net.join("op1")}, robot{net.join("r1")};
};

TYPED_TEST_SUITE(Conformance, Nets, NetNames);

TYPED_TEST(Conformance, CommandsArriveInOrderInTheirPartitionOnly) {
  Seen<std::uint64_t> own, other;
  const auto reader = this->hear(*this->robot, "r1", own);
  const auto elsewhere = this->hear(*this->robot, "r2", other);
  auto writer = this->commands(*this->station, "r1");
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1; }));
  Seqs expected;
  for (std::uint64_t i = 1; i <= 50; ++i) {
    ASSERT_TRUE(writer.write(numbered_command(i)).ok());
    expected.push_back(i);
    ASSERT_TRUE(this->net.until([&] { return own.size() == i; }));
  }
  EXPECT_EQ(own.all(), expected);
  EXPECT_EQ(other.size(), 0U);
}

TYPED_TEST(Conformance, ARevokedWriterWritesNothing) {
  Seen<std::uint64_t> seen;
  const auto reader = this->hear(*this->robot, "r1", seen);
  auto writer = this->commands(*this->station, "r1");
  const auto generation = std::make_shared<Generation>();
  writer.bind(generation);
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1; }));
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  ASSERT_TRUE(this->net.until([&] { return seen.size() == 1; }));
  generation->revoke();
  EXPECT_EQ(writer.write(numbered_command(2)).reason(), Reason::cancelled);
  auto next = this->commands(*this->station, "r1");
  ASSERT_TRUE(this->net.until([&] { return next.matched() == 1; }));
  ASSERT_TRUE(next.write(numbered_command(3)).ok());
  ASSERT_TRUE(this->net.until([&] { return seen.size() == 2; }));
  EXPECT_EQ(seen.all(), (Seqs{1, 3}));
}

TYPED_TEST(Conformance, ARevokedReaderHandlesNothing) {
  Seen<std::uint64_t> revoked, other;
  const auto generation = std::make_shared<Generation>();
  const auto reader = std::move(make_reader(
                                    *this->robot, topics::kCommand, *this->strand,
                                    [&](const radio::Command& c, const SampleInfo&) { revoked.add(c.seq()); },
                                    "r1", generation))
                          .value();
  const auto beside = this->hear(*this->robot, "r1", other);
  auto writer = this->commands(*this->station, "r1");
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 2; }));
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  ASSERT_TRUE(this->net.until([&] { return revoked.size() == 1 && other.size() == 1; }));
  generation->revoke();
  ASSERT_TRUE(writer.write(numbered_command(2)).ok());
  ASSERT_TRUE(this->net.until([&] { return total(*this->robot, &TopicCount::samples_in) == 4; }));
  ASSERT_TRUE(this->net.until([&] { return other.size() == 2; }));
  EXPECT_EQ(revoked.all(), Seqs{1});
  EXPECT_EQ(total(*this->robot, &TopicCount::malformed), 0U);
}

TYPED_TEST(Conformance, EndpointsEndWithTheGenerationOfTheirComponent) {
  const auto generation = std::make_shared<Generation>();
  const ComponentIo io{*this->robot, *this->strand, generation};
  Seen<std::uint64_t> own, others;
  Writer<radio::Command> writer, beside = this->commands(*this->station, "r1");
  std::unique_ptr<RawReader> reader;
  ASSERT_TRUE(io.open(writer, topics::kCommand, "op1").ok());
  ASSERT_TRUE(io.open(
                    reader, topics::kCommand,
                    [&](const radio::Command& c, const SampleInfo&) { own.add(c.seq()); }, "r1")
                  .ok());
  const auto other = this->hear(*this->station, "op1", others);
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1 && beside.matched() == 1; }));
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  ASSERT_TRUE(beside.write(numbered_command(1)).ok());
  ASSERT_TRUE(this->net.until([&] { return own.size() == 1 && others.size() == 1; }));
  generation->revoke();
  EXPECT_EQ(writer.write(numbered_command(2)).reason(), Reason::cancelled);
  ASSERT_TRUE(beside.write(numbered_command(2)).ok());
  ASSERT_TRUE(this->net.until([&] { return total(*this->robot, &TopicCount::samples_in) == 2; }));
  auto next = this->commands(*this->robot, "op1");
  ASSERT_TRUE(this->net.until([&] { return next.matched() == 1; }));
  ASSERT_TRUE(next.write(numbered_command(3)).ok());
  ASSERT_TRUE(this->net.until([&] { return others.size() == 2; }));
  EXPECT_EQ(own.all(), Seqs{1});
  EXPECT_EQ(others.all(), (Seqs{1, 3}));
}

TYPED_TEST(Conformance, SenderIsKnownIndependentOfTheSample) {
  Seen<ParticipantId> senders;
  const auto reader =
      make_reader(*this->robot, topics::kCommand, *this->strand,
                  [&](const radio::Command&, const SampleInfo& info) { senders.add(info.sender); });
  const auto intruder = this->net.join("intruder");
  auto honest = this->commands(*this->station, ""), forged = this->commands(*intruder, "");
  ASSERT_TRUE(this->net.until([&] { return honest.matched() == 1 && forged.matched() == 1; }));
  ASSERT_TRUE(honest.write(numbered_command(1)).ok());
  ASSERT_TRUE(this->net.until([&] { return senders.size() == 1; }));
  ASSERT_TRUE(forged.write(numbered_command(1)).ok());
  ASSERT_TRUE(this->net.until([&] { return senders.size() == 2; }));
  EXPECT_EQ(senders.all()[0], this->station->id());
  EXPECT_EQ(senders.all()[1], intruder->id());
}

TYPED_TEST(Conformance, StatusOf20KeysReachesALateJoinerOnceEach) {
  auto writer = std::move(Writer<radio::AuthorityStatus>::make(*this->robot, topics::kAuthority)).value();
  for (std::uint64_t round = 0; round < 3; ++round) {
    for (int key = 0; key < 20; ++key) {
      radio::AuthorityStatus status;
      status.robot("robot" + std::to_string(key));
      status.seq(round);
      ASSERT_TRUE(writer.write(status).ok());
    }
  }
  this->net.pass(100ms);
  const auto late = this->net.join("late");
  Seen<std::pair<std::string, std::uint64_t>> seen;
  const auto reader = make_reader(*late, topics::kAuthority, *this->strand,
                                  [&](const radio::AuthorityStatus& s, const SampleInfo&) {
                                    seen.add({s.robot(), s.seq()});
                                  });
  ASSERT_TRUE(this->net.until([&] { return seen.size() >= 20; }));
  this->net.pass(300ms);
  std::set<std::string> robots;
  for (const auto& [name, seq] : seen.all()) {
    EXPECT_EQ(seq, 2U);
    robots.insert(name);
  }
  EXPECT_EQ(robots.size(), 20U);
  EXPECT_EQ(seen.size(), 20U);
}

TYPED_TEST(Conformance, NotificationsKeepTheLastEightForALateJoiner) {
  auto writer = std::move(Writer<radio::Notification>::make(*this->robot, topics::kNotification)).value();
  for (std::uint64_t i = 1; i <= 12; ++i) {
    radio::Notification notification;
    notification.robot("r1");
    notification.seq(i);
    ASSERT_TRUE(writer.write(notification).ok());
  }
  Seen<std::uint64_t> seen;
  const auto reader =
      make_reader(*this->station, topics::kNotification, *this->strand,
                  [&](const radio::Notification& n, const SampleInfo&) { seen.add(n.seq()); });
  ASSERT_TRUE(this->net.until([&] { return seen.size() >= 8; }));
  this->net.pass(300ms);
  EXPECT_EQ(seen.all(), (Seqs{5, 6, 7, 8, 9, 10, 11, 12}));
}

/// A reader of the latched topic that asks for no repairs.
constexpr Topic<tf2_msgs::msg::TFMessage> kFramesBestEffort{
    {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", QosClass::state, 16, topics::kUnkeyed, 1 << 16}};

TYPED_TEST(Conformance, ALateReaderOfALatchedTopicGetsItsHistoryUnlessItIsBestEffort) {
  auto writer = std::move(Writer<tf2_msgs::msg::TFMessage>::make(*this->robot, topics::kTfStatic)).value();
  tf2_msgs::msg::TFMessage frames;
  frames.transforms().resize(1);
  ASSERT_TRUE(writer.write(frames).ok());
  this->net.pass(300ms);
  Seen<std::size_t> latched, best_effort;
  const auto count = [](Seen<std::size_t>& seen) {
    return [&seen](const tf2_msgs::msg::TFMessage& f, const SampleInfo&) { seen.add(f.transforms().size()); };
  };
  const auto reader = make_reader(*this->station, topics::kTfStatic, *this->strand, count(latched));
  const auto other = make_reader(*this->station, kFramesBestEffort, *this->strand, count(best_effort));
  ASSERT_TRUE(this->net.until([&] { return latched.size() == 1 && writer.matched() == 2; }));
  this->net.pass(500ms);
  EXPECT_EQ(best_effort.size(), 0U);
  frames.transforms().resize(2);
  ASSERT_TRUE(writer.write(frames).ok());
  ASSERT_TRUE(this->net.until([&] { return latched.size() == 2 && best_effort.size() == 1; }));
  EXPECT_EQ(latched.all(), (std::vector<std::size_t>{1, 2}));
}

TYPED_TEST(Conformance, CommandsAreNotReplayed) {
  auto writer = this->commands(*this->station, "r1");
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  Seen<std::uint64_t> seen;
  const auto reader = this->hear(*this->robot, "r1", seen);
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1; }));
  this->net.pass(500ms);
  ASSERT_TRUE(writer.write(numbered_command(2)).ok());
  ASSERT_TRUE(this->net.until([&] { return seen.size() > 0; }));
  EXPECT_EQ(seen.all(), Seqs{2});
}

TYPED_TEST(Conformance, ParticipantsComeAndGo) {
  // Shared: the station outlives this body when an assertion ends it.
  const auto shared = std::make_shared<Seen<std::pair<ParticipantId, bool>>>();
  const auto& events = *shared;
  this->station->on_participant(*this->strand, [shared](const ParticipantEvent& e) {
    shared->add({e.id, e.present});
  });
  // A participant that leaves may be seen once more and leave again: its last announcement and its goodbye
  // come by two sockets.
  const auto last_is = [&](ParticipantId id, bool present) {
    const auto all = events.all();
    return !all.empty() && all.back() == std::pair(id, present);
  };
  const ParticipantId first = this->robot->id();
  ASSERT_TRUE(this->net.until([&] { return last_is(first, true); }));
  this->robot.reset();
  ASSERT_TRUE(this->net.until([&] { return last_is(first, false); }, 2s));
  this->robot = this->net.join("r1");
  const ParticipantId second = this->robot->id();
  EXPECT_NE(second, first);
  EXPECT_TRUE(this->net.until([&] { return last_is(second, true); }, 3s));
}

TYPED_TEST(Conformance, MalformedSamplesAreCountedBySenderAndSurvived) {
  Seen<std::uint64_t> seen;
  const auto reader = this->hear(*this->robot, "r1", seen);
  const auto raw = std::move(this->station->make_writer(topics::kCommand, "r1")).value();
  ASSERT_TRUE(this->net.until([&] { return raw->matched() == 1; }));
  std::vector<std::uint8_t> good;
  encode(numbered_command(8), good);
  // The reader may know of the writer a little later than the writer of it.
  ASSERT_TRUE(this->net.until([&] { return raw->write(good).ok() && seen.size() > 0; }));
  encode(numbered_command(9), good);
  std::vector<std::uint8_t> truncated(good.begin(), good.begin() + 40), encapsulation = good;
  encapsulation[1] = 0x77;
  for (const auto& bad : {std::vector<std::uint8_t>{0, 1, 0, 0}, truncated, encapsulation,
                          std::vector<std::uint8_t>{0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff}}) {
    ASSERT_TRUE(raw->write(bad).ok());
  }
  ASSERT_TRUE(raw->write(good).ok());
  ASSERT_TRUE(this->net.until([&] { return seen.all().back() == 9; }));
  EXPECT_EQ(total(*this->robot, &TopicCount::malformed), 4U);
  EXPECT_EQ(this->robot->counters().topics.at(0).peer, this->station->id());
}

TYPED_TEST(Conformance, LargeSamplesPassInFragments) {
  constexpr TopicInfo large{"adit/test_large", "Bytes", QosClass::urgent, 4, topics::kUnkeyed, 1 << 16};
  Seen<std::vector<std::uint8_t>> seen;
  const auto reader =
      std::move(this->station->make_reader(large, "", *this->strand, [&](auto bytes, const SampleInfo&) {
        seen.add({bytes.begin(), bytes.end()});
        return true;
      }));
  const auto writer = std::move(this->robot->make_writer(large, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  std::vector<std::uint8_t> sample(32 * 1024);
  for (std::size_t i = 4; i < sample.size(); ++i) sample[i] = static_cast<std::uint8_t>(i * 31);
  ASSERT_TRUE(writer->write(sample).ok());
  ASSERT_TRUE(this->net.until([&] { return seen.size() == 1; }));
  EXPECT_EQ(seen.all()[0], sample);
  EXPECT_EQ(writer->write(std::vector<std::uint8_t>((1 << 16) + 1)).reason(), Reason::out_of_range);
  EXPECT_EQ(total(*this->robot, &TopicCount::failed_writes), 1U);
}

TYPED_TEST(Conformance, ADroppedReaderIsNotCalledAgain) {
  Seen<std::uint64_t> seen;
  auto reader = this->hear(*this->robot, "r1", seen);
  auto writer = this->commands(*this->station, "r1");
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1; }));
  for (std::uint64_t i = 1; i <= 5; ++i) ASSERT_TRUE(writer.write(numbered_command(i)).ok());
  reader.reset();
  const std::size_t before = seen.size();
  for (std::uint64_t i = 6; i <= 10; ++i) ASSERT_TRUE(writer.write(numbered_command(i)).ok());
  this->net.pass(200ms);
  EXPECT_EQ(seen.size(), before);
  EXPECT_TRUE(this->net.until([&] { return writer.matched() == 0; }));
}

TYPED_TEST(Conformance, BytesAndSamplesAreCounted) {
  Seen<std::uint64_t> seen;
  const auto reader = this->hear(*this->robot, "r1", seen);
  auto writer = this->commands(*this->station, "r1");
  ASSERT_TRUE(this->net.until([&] { return writer.matched() == 1; }));
  const WireCounters before = this->station->counters();
  for (std::uint64_t i = 1; i <= 10; ++i) {
    ASSERT_TRUE(writer.write(numbered_command(i)).ok());
    ASSERT_TRUE(this->net.until([&] { return seen.size() == i; }));
  }
  std::vector<std::uint8_t> bytes;
  encode(numbered_command(1), bytes);
  EXPECT_EQ(total(*this->station, &TopicCount::samples_out), 10U);
  EXPECT_EQ(total(*this->robot, &TopicCount::samples_in), 10U);
  const WireCounters after = this->station->counters();
  const std::uint64_t user =
      (after.total_out - after.discovery_out) - (before.total_out - before.discovery_out);
  const std::uint64_t topic = total(*this->station, &TopicCount::bytes_out);
  EXPECT_GT(topic, 10 * bytes.size());
  EXPECT_GE(user, topic);  // acknowledgements and heartbeats besides
  EXPECT_LE(user, topic * 2);
  EXPECT_GT(after.discovery_out, 500U);
  EXPECT_GT(after.discovery_in, 500U);
}

}  // namespace
}  // namespace adit::wire
