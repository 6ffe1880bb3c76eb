// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/traffic.hpp"

#include <algorithm>
#include <map>

namespace adit::station {
namespace {

struct Sums {
  std::uint64_t samples_out{}, bytes_out{}, samples_in{}, bytes_in{}, dropped{};
};

std::map<std::string, Sums> by_topic(const wire::WireCounters& counters) {
  std::map<std::string, Sums> sums;
  for (const wire::TopicCount& row : counters.topics) {
    Sums& sum = sums[row.topic];
    sum.samples_out += row.samples_out;
    sum.bytes_out += row.bytes_out;
    sum.samples_in += row.samples_in;
    sum.bytes_in += row.bytes_in;
    sum.dropped += row.failed_writes + row.malformed;
  }
  return sums;
}

}  // namespace

TrafficView TrafficMeter::read(const std::string& agent, const wire::WireCounters& counters,
                               const wire::SenderState& sender, Time now) {
  const double span = started_ ? seconds(now - last_at_) : 0.0;
  const auto rate = [span](std::uint64_t after, std::uint64_t before) {
    return span > 0.0 && after >= before ? static_cast<float>(static_cast<double>(after - before) / span)
                                         : 0.0F;
  };
  TrafficView view{.agent = agent,
                   .last_heard = now,
                   .discovery_out = rate(counters.discovery_out, last_.discovery_out),
                   .discovery_in = rate(counters.discovery_in, last_.discovery_in),
                   .total_out = rate(counters.total_out, last_.total_out),
                   .total_in = rate(counters.total_in, last_.total_in)};
  auto before = by_topic(last_);
  for (const auto& [topic, sum] : by_topic(counters)) {
    const Sums& old = before[topic];
    view.topics.push_back({topic, rate(sum.bytes_out, old.bytes_out), rate(sum.samples_out, old.samples_out),
                           rate(sum.bytes_in, old.bytes_in), rate(sum.samples_in, old.samples_in),
                           static_cast<std::uint32_t>(std::min<std::uint64_t>(sum.dropped, UINT32_MAX))});
  }
  std::uint64_t malformed = 0;
  for (const wire::TopicCount& row : counters.topics) malformed += row.malformed;
  view.malformed = static_cast<std::uint32_t>(std::min<std::uint64_t>(malformed, UINT32_MAX));
  if (sender.link != nullptr) {
    view.sender.link = sender.link->name;
    view.sender.bandwidth = sender.link->bandwidth;
  }
  view.sender.queue = seconds(sender.waiting(wire::kStatusPriority));
  for (std::size_t i = 0; i < sender.dropped.size(); ++i)
    view.sender.dropped[i] = static_cast<std::uint32_t>(sender.dropped[i]);
  last_ = counters;
  last_at_ = now;
  started_ = true;
  return view;
}

}  // namespace adit::station
