// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/link_meter.hpp"

namespace adit::agent {

radio::LinkReport LinkMeter::report(const wire::WireCounters& counters, const wire::SenderState& sender,
                                    const std::string& agent, Time now) {
  constexpr std::size_t kTopics = 16;  // The contract's maximum.
  const double period = at_ ? std::max(1e-3, seconds(now - *at_)) : 1.0;
  const auto rate = [&](std::uint64_t is, std::uint64_t was) {
    return static_cast<float>(static_cast<double>(is - was) / period);
  };
  radio::LinkReport out;
  out.agent(agent);
  out.discovery_out(rate(counters.discovery_out, totals_.discovery_out));
  out.discovery_in(rate(counters.discovery_in, totals_.discovery_in));
  out.total_out(rate(counters.total_out, totals_.total_out));
  out.total_in(rate(counters.total_in, totals_.total_in));

  std::map<std::string, Sums> sums;
  std::map<std::string, std::uint64_t> dropped;
  std::uint64_t malformed = 0;
  for (const wire::TopicCount& c : counters.topics) {
    Sums& s = sums[c.topic];
    s.samples_out += c.samples_out;
    s.bytes_out += c.bytes_out;
    s.samples_in += c.samples_in;
    s.bytes_in += c.bytes_in;
    dropped[c.topic] += c.failed_writes + c.malformed;
    malformed += c.malformed;
  }
  for (const auto& [topic, s] : sums) {
    if (out.topics().size() >= kTopics) break;
    const Sums& was = last_[topic];
    radio::TopicTraffic t;
    t.topic(topic);
    t.bytes_out(rate(s.bytes_out, was.bytes_out));
    t.samples_out(rate(s.samples_out, was.samples_out));
    t.bytes_in(rate(s.bytes_in, was.bytes_in));
    t.samples_in(rate(s.samples_in, was.samples_in));
    t.dropped(static_cast<std::uint32_t>(dropped[topic]));
    out.topics().push_back(t);
  }
  out.malformed(static_cast<std::uint32_t>(malformed));
  if (sender.link != nullptr) {
    out.link(sender.link->name);
    out.bandwidth(static_cast<float>(sender.link->bandwidth));
  }
  out.queue(static_cast<float>(seconds(sender.waiting(wire::kStatusPriority))));
  static_assert(std::tuple_size_v<std::remove_reference_t<decltype(out.dropped())>> == wire::kPriorities,
                "another number of priorities is another version of the contract");
  for (std::size_t i = 0; i < sender.dropped.size(); ++i)
    out.dropped()[i] = static_cast<std::uint32_t>(sender.dropped[i]);
  last_ = std::move(sums);
  totals_ = counters;
  totals_.topics.clear();
  at_ = now;
  return out;
}

}  // namespace adit::agent
