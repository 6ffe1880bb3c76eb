// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/wire/participant.hpp"

namespace adit::bench {

/// A participant with Fast DDS's default settings for discovery, liveliness and QoS, on loopback only. It is
/// the baseline for our wire; its datagrams are counted as ours are.
class DefaultDds {
 public:
  DefaultDds(unsigned domain, const std::string& name);
  ~DefaultDds();
  DefaultDds(const DefaultDds&) = delete;
  DefaultDds& operator=(const DefaultDds&) = delete;

  /// Opens a writer and writes one serialised sample; its key is the topic's first string.
  void write(const wire::TopicInfo& topic, const std::string& partition,
             std::span<const std::uint8_t> sample);
  void read(const wire::TopicInfo& topic, const std::string& partition);
  /// Returns totals only, without counts per topic.
  wire::WireCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::bench
