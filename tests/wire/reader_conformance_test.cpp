// SPDX-License-Identifier: Apache-2.0
// What a reader gets whose strand is slow, over both wires: the newest samples, with the time at which each
// came.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/wire/topics.hpp"
#include "tests/wire/held_strand.hpp"
#include "tests/wire/nets.hpp"

namespace adit::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr TopicInfo kNewest{"adit/test_newest", "Newest", QosClass::state, 1, topics::kUnkeyed, 1 << 10};
constexpr TopicInfo kLastThree{"adit/test_three", "Three", QosClass::status, 3, topics::kUnkeyed, 1 << 10};
constexpr TopicInfo kByKey{"adit/test_keys", "Keys", QosClass::status, 2, topics::kKeyed, 1 << 10};
constexpr TopicInfo kRequests{"adit/test_requests", "Requests", QosClass::urgent, 1,
                              topics::kUnkeyed,     1 << 10};

/// A sample whose key is `key` and whose last four bytes are `number`.
Bytes sample(const std::string& key, std::uint8_t number) {
  Bytes bytes(8 + (key.size() / 4 + 1) * 4);
  bytes[1] = 1;
  bytes[4] = static_cast<std::uint8_t>(key.size() + 1);
  std::copy(key.begin(), key.end(), bytes.begin() + 8);
  bytes.resize(bytes.size() + 4, number);
  return bytes;
}

struct Got {
  std::string key{};
  int number{};
  ParticipantId sender{};
  Time received{};
  Time handled{};
};

template <class Net>
class ReaderConformance : public testing::Test {
 protected:
  std::unique_ptr<RawReader> hear(const TopicInfo& topic) {
    return std::move(
               robot->make_reader(topic, "", held,
                                  [this](auto bytes, const SampleInfo& info) {
                                    const std::string key(reinterpret_cast<const char*>(bytes.data()) + 8);
                                    got.add({key, bytes.back(), info.sender, info.received, held.now()});
                                    return true;
                                  }))
        .value();
  }
  std::uint64_t total(std::uint64_t TopicCount::*field) const {
    std::uint64_t sum = 0;
    for (const TopicCount& count : robot->counters().topics) sum += count.*field;
    return sum;
  }
  /// Writes one sample and waits until the robot received it.
  void write(RawWriter& writer, const Bytes& bytes) {
    const std::uint64_t before = total(&TopicCount::samples_in);
    ASSERT_TRUE(writer.write(bytes).ok());
    ASSERT_TRUE(net.until([&] { return total(&TopicCount::samples_in) == before + 1; }));
  }
  std::vector<int> numbers() const {
    std::vector<int> result;
    for (const Got& g : got.all()) result.push_back(g.number);
    return result;
  }

  Net net{};
  std::shared_ptr<Executor> strand{net.strand("test")};
  HeldStrand held{strand};
  std::unique_ptr<Participant> station{net.join("op1")}, other{net.join("op2")}, robot{net.join("r1")};
  Seen<Got> got{};
};

TYPED_TEST_SUITE(ReaderConformance, Nets, NetNames);

TYPED_TEST(ReaderConformance, ASampleIsStampedWhenItComes) {
  const auto reader = this->hear(kNewest);
  const auto writer = std::move(this->station->make_writer(kNewest, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  const Time before = this->strand->now();
  this->write(*writer, sample("", 1));
  const Time written = this->strand->now();
  this->net.pass(1s);
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() == 1; }));
  const Got seen = this->got.all()[0];
  EXPECT_GE(seen.received, before);
  EXPECT_LE(seen.received, written);
  EXPECT_GE(seen.handled - seen.received, 900ms);
}

TYPED_TEST(ReaderConformance, ASlowReaderGetsTheNewest) {
  const auto reader = this->hear(kNewest);
  const auto writer = std::move(this->station->make_writer(kNewest, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  for (std::uint8_t i = 1; i <= 20; ++i) this->write(*writer, sample("", i));
  EXPECT_EQ(this->held.waiting(), 1U);
  EXPECT_EQ(this->total(&TopicCount::overwritten), 19U);
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 1; }));
  this->net.pass(100ms);
  EXPECT_EQ(this->numbers(), std::vector<int>{20});
}

TYPED_TEST(ReaderConformance, ASlowReaderGetsTheLastThreeInOrder) {
  const auto reader = this->hear(kLastThree);
  const auto writer = std::move(this->station->make_writer(kLastThree, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  for (std::uint8_t i = 1; i <= 10; ++i) this->write(*writer, sample("", i));
  EXPECT_EQ(this->held.waiting(), 1U);
  EXPECT_EQ(this->total(&TopicCount::overwritten), 7U);
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 3; }));
  this->net.pass(100ms);
  EXPECT_EQ(this->numbers(), (std::vector<int>{8, 9, 10}));
}

TYPED_TEST(ReaderConformance, EachKeyOfASlowReaderKeepsItsOwnNewest) {
  const auto reader = this->hear(kByKey);
  const auto writer = std::move(this->station->make_writer(kByKey, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  for (std::uint8_t i = 1; i <= 5; ++i) {
    for (const char* key : {"a", "b", "c"}) this->write(*writer, sample(key, i));
  }
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 6; }));
  this->net.pass(100ms);
  std::map<std::string, std::vector<int>> keys;
  for (const Got& g : this->got.all()) keys[g.key].push_back(g.number);
  for (const char* key : {"a", "b", "c"}) EXPECT_EQ(keys[key], (std::vector<int>{4, 5})) << key;
}

// One station that floods a robot does not replace what another one asks.
TYPED_TEST(ReaderConformance, ASenderReplacesItsOwnSamplesOnly) {
  const auto reader = this->hear(kNewest);
  const auto quiet = std::move(this->station->make_writer(kNewest, "")).value();
  const auto loud = std::move(this->other->make_writer(kNewest, "")).value();
  ASSERT_TRUE(this->net.until([&] { return quiet->matched() == 1 && loud->matched() == 1; }));
  this->net.pass(300ms);
  this->write(*quiet, sample("", 7));
  for (std::uint8_t i = 100; i < 110; ++i) this->write(*loud, sample("", i));
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 2; }));
  this->net.pass(100ms);
  EXPECT_EQ(this->numbers(), (std::vector<int>{7, 109}));
}

// Requests are all different: the newest does not make the one before it void.
TYPED_TEST(ReaderConformance, RequestsWaitBesideEachOther) {
  const auto reader = this->hear(kRequests);
  const auto writer = std::move(this->station->make_writer(kRequests, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  for (std::uint8_t i = 1; i <= 12; ++i) this->write(*writer, sample("", i));
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 8; }));
  this->net.pass(100ms);
  EXPECT_EQ(this->numbers(), (std::vector<int>{5, 6, 7, 8, 9, 10, 11, 12}));
}

TYPED_TEST(ReaderConformance, AFailedHandlerCostsItsOwnSampleOnly) {
  const auto reader = std::move(this->robot->make_reader(kLastThree, "", this->held,
                                                         [this](auto bytes, const SampleInfo&) -> bool {
                                                           this->got.add({"", bytes.back(), {}, {}, {}});
                                                           if (bytes.back() == 2)
                                                             throw std::runtime_error("a test's");
                                                           return true;
                                                         }))
                          .value();
  const auto writer = std::move(this->station->make_writer(kLastThree, "")).value();
  ASSERT_TRUE(this->net.until([&] { return writer->matched() == 1; }));
  this->net.pass(300ms);
  for (std::uint8_t i = 1; i <= 3; ++i) this->write(*writer, sample("", i));
  this->held.release();
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 3; }));
  this->write(*writer, sample("", 4));
  ASSERT_TRUE(this->net.until([&] { return this->got.size() >= 4; }));
  EXPECT_EQ(this->numbers(), (std::vector<int>{1, 2, 3, 4}));
}

}  // namespace
}  // namespace adit::wire
