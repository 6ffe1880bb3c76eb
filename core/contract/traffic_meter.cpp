// SPDX-License-Identifier: Apache-2.0
#include "core/contract/traffic_meter.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/contract/refusals.hpp"

namespace adit::contract {
namespace {

struct TopicSums {
  std::uint64_t samples_out{}, bytes_out{}, samples_in{}, bytes_in{}, dropped{};
};

std::map<std::string, TopicSums> by_topic(const wire::WireCounters& counters) {
  std::map<std::string, TopicSums> sums;
  for (const wire::TopicCount& row : counters.topics) {
    TopicSums& sum = sums[row.topic];
    sum.samples_out += row.samples_out;
    sum.bytes_out += row.bytes_out;
    sum.samples_in += row.samples_in;
    sum.bytes_in += row.bytes_in;
    sum.dropped += row.failed_writes + row.malformed;
  }
  return sums;
}

std::uint32_t bounded(std::uint64_t count) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(count, UINT32_MAX));
}

}  // namespace

LinkReport TrafficMeter::read(const std::string& agent, const wire::WireCounters& counters,
                              const wire::SenderState& sender, Time now) {
  const double span = seconds(last_at_ ? now - *last_at_ : first_);
  const auto rate = [span](std::uint64_t is, std::uint64_t was) {
    return span > 0.0 && is >= was ? static_cast<float>(static_cast<double>(is - was) / span) : 0.0F;
  };
  LinkReport report{.agent = agent,
                    .discovery_out = rate(counters.discovery_out, last_.discovery_out),
                    .discovery_in = rate(counters.discovery_in, last_.discovery_in),
                    .total_out = rate(counters.total_out, last_.total_out),
                    .total_in = rate(counters.total_in, last_.total_in),
                    .queue = seconds(sender.waiting(wire::kStatusPriority))};
  auto before = by_topic(last_);
  for (const auto& [topic, sum] : by_topic(counters)) {
    const TopicSums& was = before[topic];
    report.topics.push_back({topic, rate(sum.bytes_out, was.bytes_out),
                             rate(sum.samples_out, was.samples_out), rate(sum.bytes_in, was.bytes_in),
                             rate(sum.samples_in, was.samples_in), bounded(sum.dropped)});
  }
  // Below the topics, as far as there is room: a row that counts, by reason, what was refused before it could
  // be assigned to a topic.
  const std::uint64_t refused = std::accumulate(counters.refused.begin(), counters.refused.end(), 0ULL);
  if (refused > 0) {
    if (report.topics.size() >= LinkReport::kMaxTopics) report.topics.resize(LinkReport::kMaxTopics - 1);
    report.topics.push_back({.topic = "refused: " + describe(counters.refused), .dropped = bounded(refused)});
  }
  std::uint64_t malformed = 0;
  for (const wire::TopicCount& row : counters.topics) malformed += row.malformed;
  report.malformed = bounded(malformed);
  if (sender.link != nullptr) {
    report.link = sender.link->name;
    report.bandwidth = sender.link->bandwidth;
  }
  for (std::size_t i = 0; i < sender.dropped.size(); ++i) report.dropped[i] = bounded(sender.dropped[i]);
  last_ = counters;
  last_at_ = now;
  return report;
}

}  // namespace adit::contract
