// SPDX-License-Identifier: Apache-2.0
#include "core/contract/link.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "adit/link.h"
#include "core/command/words.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::TopicTraffic& out) {
  random.any(out.topic(), out.bytes_out(), out.samples_out(), out.bytes_in(), out.samples_in(),
             out.dropped());
}
static void randomize(RandomSamples& random, radio::PeerLink& out) {
  random.any(out.peer(), out.number(), out.held(), out.lost());
}
static void randomize(RandomSamples& random, radio::LinkReport& out) {
  random.any(out.agent(), out.discovery_out(), out.discovery_in(), out.total_out(), out.total_in(),
             out.topics(), out.malformed(), out.seq(), out.peers(), out.link(), out.bandwidth(), out.queue(),
             out.dropped(), out.state_rate());
}

namespace {

using testing::AllOf;
using testing::Ge;
using testing::Le;
using testing::Lt;
using testing::SizeIs;

float some(RandomSamples& random, double limit) { return static_cast<float>(std::abs(random.number(limit))); }

LinkReport a_report(RandomSamples& random, std::size_t topics, std::size_t peers) {
  LinkReport report{.agent = random.name(),
                    .discovery_out = some(random, 1e6),
                    .discovery_in = some(random, 1e6),
                    .total_out = some(random, 1e6),
                    .total_in = some(random, 1e6),
                    .link = random.name(),
                    .bandwidth = some(random, 1e9),
                    .queue = some(random, 10),
                    .state_rate = some(random, 10)};
  random.any(report.malformed, report.dropped);
  for (; topics > 0; --topics)
    report.topics.push_back({random.name(), some(random, 1e6), some(random, 1e3), some(random, 1e6),
                             some(random, 1e3), static_cast<std::uint32_t>(topics)});
  for (; peers > 0; --peers)
    report.peers.push_back(
        {random.name(), static_cast<std::uint32_t>(peers), some(random, 9e5), some(random, 1)});
  return report;
}

TEST(ContractLink, AReportReturnsAsItWas) {
  for_each_seed([](RandomSamples& random) {
    const LinkReport sent = a_report(random, random.random().below(LinkReport::kMaxTopics + 1),
                                     random.random().below(LinkReport::kMaxPeers + 1));
    EXPECT_EQ(decode(through_cdr(encode(sent))), sent);
  });
}

TEST(ContractLink, OfMoreTopicsAndPeersTheFirstAreSent) {
  RandomSamples random(1);
  LinkReport sent = a_report(random, LinkReport::kMaxTopics + 3, LinkReport::kMaxPeers + 3);
  const LinkReport back = decode(through_cdr(encode(sent))).value();
  EXPECT_LE(serialised(encode(sent)).size(), wire::topics::kLinkReport.max_bytes);
  sent.topics.resize(LinkReport::kMaxTopics);
  sent.peers.resize(LinkReport::kMaxPeers);
  EXPECT_EQ(back, sent);
}

TEST(ContractLink, AnyReportIsWithinItsBounds) {
  for_any<radio::LinkReport>([](const radio::LinkReport& sample) {
    const auto report = decode(sample);
    ASSERT_EQ(report.has_value(), command::valid_name(sample.agent()));
    if (!report) return;
    EXPECT_EQ(command::clean(report->link, kMaxName), report->link);
    for (const double number :
         {double{report->discovery_out}, double{report->discovery_in}, double{report->total_out},
          double{report->total_in}, report->bandwidth, report->queue, report->state_rate})
      EXPECT_THAT(number, AllOf(Ge(0.0), Lt(1e12)));
    EXPECT_THAT(report->topics, SizeIs(Le(LinkReport::kMaxTopics)));
    for (const TopicTraffic& topic : report->topics) {
      EXPECT_EQ(command::clean(topic.topic, TopicTraffic::kMaxTopic), topic.topic);
      for (const float rate : {topic.bytes_out, topic.samples_out, topic.bytes_in, topic.samples_in})
        EXPECT_THAT(rate, AllOf(Ge(0.0F), Lt(1e12F)));
    }
    EXPECT_THAT(report->peers, SizeIs(Le(LinkReport::kMaxPeers)));
    for (const PeerLink& peer : report->peers) {
      EXPECT_TRUE(command::valid_name(peer.peer));
      EXPECT_THAT(peer.held, AllOf(Ge(0.0), Lt(1e6)));
      EXPECT_THAT(peer.lost, AllOf(Ge(0.0F), Le(1.0F)));
    }
  });
}

}  // namespace
}  // namespace adit::contract
