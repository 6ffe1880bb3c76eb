// SPDX-License-Identifier: Apache-2.0
#include "bench/wire/load.hpp"

namespace adit::bench {

Load::Load(wire::Participant& wire, Executor& strand, const wire::LinkProfile& link, std::uint8_t who) {
  const bool thin = link.frame_bytes() <= 500;
  for (const wire::TopicInfo& topic : {kLoadBulk, kLoadVideo}) {
    readers_.push_back(
        std::move(wire.make_reader(topic, "", strand, [](auto, const auto&) { return true; })).value());
  }
  offer(kLoadBulk, thin ? 340 : 1200, 1.0, strand, wire, link, who);
  offer(kLoadVideo, thin ? 1500 : 8000, 0.5, strand, wire, link, who);
}

void Load::offer(const wire::TopicInfo& topic, std::size_t bytes, double share, Executor& strand,
                 wire::Participant& wire, const wire::LinkProfile& link, std::uint8_t who) {
  const auto writer = std::shared_ptr<wire::RawWriter>(std::move(wire.make_writer(topic, "")).value());
  const Duration period = from_seconds(static_cast<double>(bytes) * 8.0 / (share * link.bandwidth));
  timers_.push_back(strand.every(
      period, [writer, who, number = std::uint32_t{}, sample = std::vector<std::uint8_t>(bytes)]() mutable {
        sample[1] = 1, sample[8] = who;
        ++number;
        for (std::size_t i = 0; i < 4; ++i) sample[4 + i] = static_cast<std::uint8_t>(number >> (8 * i));
        (void)writer->write(sample);  // a full history keeps the newest
      }));
}

}  // namespace adit::bench
