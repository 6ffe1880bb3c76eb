// SPDX-License-Identifier: Apache-2.0
#include "core/contract/link.hpp"

#include "adit/link.h"
#include "core/command/words.hpp"

namespace adit::contract {
namespace {

radio::TopicTraffic to_radio(const TopicTraffic& traffic) {
  radio::TopicTraffic out;
  out.topic(traffic.topic);
  out.bytes_out(traffic.bytes_out);
  out.samples_out(traffic.samples_out);
  out.bytes_in(traffic.bytes_in);
  out.samples_in(traffic.samples_in);
  out.dropped(traffic.dropped);
  return out;
}

TopicTraffic from_radio(const radio::TopicTraffic& sample) {
  return {.topic = command::clean(sample.topic(), TopicTraffic::kMaxTopic),
          .bytes_out = amount(sample.bytes_out()),
          .samples_out = amount(sample.samples_out()),
          .bytes_in = amount(sample.bytes_in()),
          .samples_in = amount(sample.samples_in()),
          .dropped = sample.dropped()};
}

radio::PeerLink to_radio(const PeerLink& link) {
  radio::PeerLink out;
  out.peer(link.peer);
  out.number(link.number);
  out.held(static_cast<float>(link.held));
  out.lost(link.lost);
  return out;
}

bool is_possible(const radio::PeerLink& sample) {
  return command::valid_name(sample.peer()) && sample.held() >= 0.0F && sample.held() < 1e6F &&
         sample.lost() >= 0.0F && sample.lost() <= 1.0F;
}

}  // namespace

radio::LinkReport encode(const LinkReport& report) {
  radio::LinkReport out;
  out.agent(report.agent);
  out.discovery_out(report.discovery_out);
  out.discovery_in(report.discovery_in);
  out.total_out(report.total_out);
  out.total_in(report.total_in);
  for (const TopicTraffic& topic : report.topics)
    if (out.topics().size() < LinkReport::kMaxTopics) out.topics().push_back(to_radio(topic));
  out.malformed(report.malformed);
  for (const PeerLink& peer : report.peers)
    if (out.peers().size() < LinkReport::kMaxPeers) out.peers().push_back(to_radio(peer));
  out.link(report.link);
  out.bandwidth(static_cast<float>(report.bandwidth));
  out.queue(static_cast<float>(report.queue));
  out.dropped(report.dropped);
  out.state_rate(static_cast<float>(report.state_rate));
  return out;
}

std::optional<LinkReport> decode(const radio::LinkReport& sample) {
  if (!command::valid_name(sample.agent())) return std::nullopt;
  LinkReport report{.agent = sample.agent(),
                    .discovery_out = amount(sample.discovery_out()),
                    .discovery_in = amount(sample.discovery_in()),
                    .total_out = amount(sample.total_out()),
                    .total_in = amount(sample.total_in()),
                    .malformed = sample.malformed(),
                    .link = cleaned_name(sample.link()),
                    .bandwidth = amount(sample.bandwidth()),
                    .queue = amount(sample.queue()),
                    .dropped = sample.dropped(),
                    .state_rate = amount(sample.state_rate())};
  for (const radio::TopicTraffic& topic : sample.topics())
    if (report.topics.size() < LinkReport::kMaxTopics) report.topics.push_back(from_radio(topic));
  for (const radio::PeerLink& peer : sample.peers())
    if (report.peers.size() < LinkReport::kMaxPeers && is_possible(peer))
      report.peers.push_back({peer.peer(), peer.number(), peer.held(), peer.lost()});
  return report;
}

}  // namespace adit::contract
