// SPDX-License-Identifier: Apache-2.0
// What a participant accepts as its topics, and how parties of different releases meet, over both wires.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/wire/contract.hpp"
#include "core/wire/cost.hpp"
#include "core/wire/topics.hpp"
#include "tests/wire/keyed_sample.hpp"
#include "tests/wire/nets.hpp"

namespace adit::wire {
namespace {

using Payload = std::vector<std::uint8_t>;

template <class Net>
class TopicConformance : public testing::Test {
 protected:
  Result<std::unique_ptr<RawReader>> read(const TopicInfo& topic) { return read(*robot, topic, ""); }
  Result<std::unique_ptr<RawReader>> read(Participant& wire, const TopicInfo& topic,
                                          const std::string& partition) {
    return wire.make_reader(topic, partition, *strand, [this](auto bytes, const SampleInfo& info) {
      seen.add({bytes.begin(), bytes.end()});
      senders.add(info.sender);
      return true;
    });
  }
  std::uint64_t total(std::uint64_t TopicCount::*field) const {
    std::uint64_t sum = 0;
    for (const TopicCount& count : robot->counters().topics) sum += count.*field;
    return sum;
  }

  Net net{};
  std::shared_ptr<Executor> strand{net.strand("test")};
  std::unique_ptr<Participant> station{net.join("op1")}, robot{net.join("r1")};
  Seen<Payload> seen{};
  Seen<ParticipantId> senders{};
};

TYPED_TEST_SUITE(TopicConformance, Nets, NetNames);

TYPED_TEST(TopicConformance, ATopicHasOneTypeKeyAndBound) {
  const auto writer = this->robot->make_writer(topics::kCmdVelStamped, "");
  ASSERT_TRUE(writer.ok());
  EXPECT_EQ(this->read(topics::kCmdVelHeard).reason(), Reason::bad_argument);
  EXPECT_EQ(this->robot->make_writer(topics::kCmdVel, "").reason(), Reason::bad_argument);
  EXPECT_TRUE(this->read(topics::kCmdVelStampedHeard).ok());
  TopicInfo longer = topics::kCmdVelStamped;
  longer.max_bytes *= 2;
  EXPECT_EQ(this->read(longer).reason(), Reason::bad_argument);
  TopicInfo keyed = topics::kCmdVelStamped;
  keyed.keyed = true;
  EXPECT_EQ(this->read(keyed).reason(), Reason::bad_argument);
  // A type has a key everywhere or nowhere.
  TopicInfo elsewhere = keyed;
  elsewhere.name = "rt/elsewhere";
  EXPECT_EQ(this->read(elsewhere).reason(), Reason::bad_argument);
  EXPECT_TRUE(this->robot->make_writer(topics::kCmdVelStamped, "other").ok());
}

TYPED_TEST(TopicConformance, ATopicMayGetAnotherTypeWhenNothingUsesIt) {
  {
    const auto reader = this->read(topics::kCmdVelHeard);
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(this->read(topics::kCmdVelStampedHeard).reason(), Reason::bad_argument);
  }
  const auto reader = this->read(topics::kCmdVelStampedHeard);
  ASSERT_TRUE(reader.ok());
  const auto writer = std::move(this->station->make_writer(topics::kCmdVelStampedHeard, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  ASSERT_TRUE(this->net.until([&] { return writer->write(Payload(8, 1)).ok() && this->seen.size() > 0; }));
}

TYPED_TEST(TopicConformance, EndpointsOfOthersAreListedWhateverTheirType) {
  const auto of = [&](bool writes) {
    const auto all = this->robot->endpoints(topics::kCmdVel.name);
    return std::count_if(all.begin(), all.end(), [&](const RemoteEndpoint& endpoint) {
      return endpoint.participant == this->station->id() && endpoint.writes == writes &&
             endpoint.type == topics::kCmdVelStamped.type;
    });
  };
  const auto own = this->robot->make_writer(topics::kCmdVel, "");
  {
    const auto writer = this->station->make_writer(topics::kCmdVelStamped, "");
    const auto reader = this->read(*this->station, topics::kCmdVelStamped, "");
    ASSERT_TRUE(this->net.until([&] { return of(true) == 1 && of(false) == 1; }));
    EXPECT_TRUE(this->robot->endpoints("rt/cmd").empty());
  }
  ASSERT_TRUE(this->net.until([&] { return of(true) == 0 && of(false) == 0; }));
  EXPECT_TRUE(this->robot->endpoints(topics::kCmdVel.name).empty());
}

TYPED_TEST(TopicConformance, TopicsOfOneTypeHaveTheirOwnBounds) {
  constexpr TopicInfo small{"adit/test_small", "Sized", QosClass::urgent, 4, topics::kUnkeyed, 64};
  constexpr TopicInfo large{"adit/test_large", "Sized", QosClass::urgent, 4, topics::kUnkeyed, 16384};
  // The station believes that the small topic takes more than the robot does.
  TopicInfo small_there = small;
  small_there.max_bytes = 4096;
  const auto a = this->read(small), b = this->read(large);
  const auto to_small = std::move(this->station->make_writer(small_there, "")).value();
  const auto to_large = std::move(this->station->make_writer(large, "")).value();
  ASSERT_TRUE(this->net.until([&] { return to_small->matched() == 1 && to_large->matched() == 1; }));
  this->net.pass(300ms);
  const Payload sample(2000, 1);
  ASSERT_TRUE(to_large->write(sample).ok());
  ASSERT_TRUE(this->net.until([&] { return this->seen.size() == 1; }));
  EXPECT_EQ(this->seen.all()[0], sample);
  ASSERT_TRUE(to_small->write(sample).ok());
  ASSERT_TRUE(this->net.until([&] { return this->total(&TopicCount::malformed) == 1; }));
  ASSERT_TRUE(to_small->write(Payload(64, 1)).ok());
  ASSERT_TRUE(this->net.until([&] { return this->seen.size() == 2; }));
  EXPECT_EQ(this->seen.all()[1].size(), 64U);
}

TYPED_TEST(TopicConformance, TwoWritersOfOneTopicAreBothHeard) {
  constexpr TopicInfo topic{"adit/test_twice", "Twice", QosClass::urgent, 4, topics::kUnkeyed, 64};
  const auto reader = this->read(topic);
  const auto first = std::move(this->station->make_writer(topic, "")).value();
  const auto second = std::move(this->station->make_writer(topic, "")).value();
  ASSERT_TRUE(this->net.until([&] { return first->matched() == 1 && second->matched() == 1; }));
  this->net.pass(300ms);
  ASSERT_TRUE(first->write(Payload(8, 1)).ok());
  ASSERT_TRUE(second->write(Payload(8, 2)).ok());
  ASSERT_TRUE(this->net.until([&] { return this->seen.size() == 2; }));
  for (const ParticipantId& id : this->senders.all()) EXPECT_EQ(id, this->station->id());
}

// A reader of what others write on one's own topic costs its writer nothing.
TYPED_TEST(TopicConformance, AParticipantDoesNotHearItsOwnWriters) {
  for (const QosClass qos : {QosClass::state, QosClass::status}) {
    const TopicInfo topic{qos == QosClass::state ? "adit/test_own_state" : "adit/test_own_status",
                          "Own",
                          qos,
                          1,
                          topics::kUnkeyed,
                          256};
    Seen<ParticipantId> own;
    const auto reader = this->read(topic);
    const auto rival =
        this->station->make_reader(topic, "", *this->strand, [&](auto, const SampleInfo& info) {
          own.add(info.sender);
          return true;
        });
    const auto writer = std::move(this->station->make_writer(topic, "")).value();
    ASSERT_TRUE(this->net.until([&] { return writer->matched() >= 1; }));
    this->net.pass(300ms);
    EXPECT_EQ(writer->matched(), 1U);
    const std::size_t before = this->seen.size();
    const std::uint64_t bytes = this->station->counters().total_out;
    constexpr std::size_t kSamples = 100;
    for (std::size_t i = 0; i < kSamples; ++i) {
      ASSERT_TRUE(writer->write(Payload(200, 1)).ok());
      ASSERT_TRUE(this->net.until([&] { return this->seen.size() > before + i; }));
    }
    EXPECT_LT(this->station->counters().total_out - bytes, kSamples * WireCost::sample(200) * 3 / 2);
    EXPECT_EQ(own.size(), 0U);
    // It hears others all the same.
    const auto other = std::move(this->robot->make_writer(topic, "")).value();
    ASSERT_TRUE(this->net.until([&] { return other->matched() == 1; }));
    ASSERT_TRUE(this->net.until([&] { return other->write(Payload(200, 2)).ok() && own.size() > 0; }));
    EXPECT_EQ(own.all().back(), this->robot->id());
  }
}

// Authority moves: the robot is addressed by another partition from now on.
TYPED_TEST(TopicConformance, AReaderOfAnotherPartitionHearsThatOneAlone) {
  constexpr TopicInfo topic{"adit/test_moves", "Moves", QosClass::urgent, 4, topics::kUnkeyed, 64};
  const auto to_r1 = std::move(this->station->make_writer(topic, "r1")).value();
  const auto to_r2 = std::move(this->station->make_writer(topic, "r2")).value();
  auto reader = std::move(this->read(*this->robot, topic, "r1")).value();
  ASSERT_TRUE(this->net.until([&] { return to_r1->matched() == 1; }));
  EXPECT_EQ(to_r2->matched(), 0U);
  reader.reset();
  ASSERT_TRUE(this->net.until([&] { return to_r1->matched() == 0; }));
  reader = std::move(this->read(*this->robot, topic, "r2")).value();
  ASSERT_TRUE(this->net.until([&] { return to_r2->matched() == 1; }));
  this->net.pass(300ms);
  ASSERT_TRUE(to_r1->write(Payload(8, 1)).ok());
  ASSERT_TRUE(to_r2->write(Payload(8, 2)).ok());
  ASSERT_TRUE(this->net.until([&] { return this->seen.size() == 1; }));
  this->net.pass(200ms);
  EXPECT_EQ(this->seen.all(), std::vector<Payload>{Payload(8, 2)});
}

// Keys come from peers: a topic has 256 of them at a time.
TYPED_TEST(TopicConformance, AWriterHasABoundedNumberOfKeys) {
  const auto writer = std::move(this->station->make_writer(topics::kPresence, "")).value();
  const auto reader = this->read(topics::kPresence);
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  for (int i = 0; i < 256; ++i) ASSERT_TRUE(writer->write(keyed("k" + std::to_string(i))).ok()) << i;
  EXPECT_EQ(writer->write(keyed("one more")).reason(), Reason::queue_full);
  EXPECT_TRUE(writer->write(keyed("k0")).ok());
}

TYPED_TEST(TopicConformance, KeysOfWritersThatLeftGiveWay) {
  const auto reader = this->read(topics::kPresence);
  std::set<Payload> heard;
  const auto write = [&](RawWriter& writer, int first, int last) {
    for (int i = first; i < last; ++i) {
      const Payload sample = keyed("k" + std::to_string(i));
      (void)writer.write(sample);
      if (i == first || i % 20 == 0) this->net.pass(10ms);
    }
    this->net.pass(200ms);
    const auto all = this->seen.all();
    heard = {all.begin(), all.end()};
  };
  auto first = this->net.join("op2");
  auto second = this->net.join("op3");
  auto a = std::move(first->make_writer(topics::kPresence, "")).value();
  const auto b = std::move(second->make_writer(topics::kPresence, "")).value();
  ASSERT_TRUE(this->net.until([&] { return a->matched() == 1 && b->matched() == 1; }));
  this->net.pass(300ms);
  write(*a, 0, 200);
  EXPECT_EQ(heard.size(), 200U);
  write(*b, 200, 400);
  EXPECT_EQ(heard.size(), 256U);
  a.reset();
  first.reset();
  ASSERT_TRUE(this->net.until([&] {
    write(*b, 200, 400);
    return heard.size() == 400U;
  }));
}

TYPED_TEST(TopicConformance, APartyOfAnotherReleaseDoesNotMatchAndIsReported) {
  for (const TopicInfo& topic : {TopicInfo(topics::kCommand), TopicInfo(topics::kJoystick)})
    EXPECT_TRUE(other_release(topic.type).empty()) << topic.type;
  TopicInfo older = topics::kCommand;
  older.type = "adit::radio::Command";
  TopicInfo newer = topics::kJoystick;
  newer.type = "adit::radio::v2::Joystick";
  const auto shared = std::make_shared<Seen<ParticipantEvent>>();
  this->station->on_participant(*this->strand, [shared](const ParticipantEvent& e) { shared->add(e); });
  const auto reported = [shared](const Participant& wire, const char* what) {
    const auto all = shared->all();
    return std::count_if(all.begin(), all.end(), [&](const ParticipantEvent& e) {
      return e.id == wire.id() && e.present && e.incompatible.find(what) != std::string::npos;
    });
  };
  const auto writer = std::move(this->station->make_writer(topics::kCommand, "")).value();
  const auto other = this->net.join("r2");
  const auto old_reader = this->read(*this->robot, older, "");
  const auto old_again = this->read(*this->robot, older, "r1");
  const auto new_writer = other->make_writer(newer, "r1");
  ASSERT_TRUE(this->net.until([&] {
    return reported(*this->robot, "r1 speaks version 0") == 1 && reported(*other, "r2 speaks version 2") == 1;
  }));
  this->net.pass(300ms);
  EXPECT_EQ(reported(*this->robot, "version"), 1);
  EXPECT_EQ(writer->matched(), 0U);
  // A handler that is added later is notified, too.
  const auto late = std::make_shared<Seen<ParticipantEvent>>();
  this->station->on_participant(*this->strand, [late](const ParticipantEvent& e) { late->add(e); });
  EXPECT_TRUE(this->net.until([&] {
    const auto all = late->all();
    return std::count_if(all.begin(), all.end(), [](const auto& e) { return !e.incompatible.empty(); }) == 2;
  }));
  this->station->on_participant(*this->strand, {});
}

}  // namespace
}  // namespace adit::wire
