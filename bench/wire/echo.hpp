// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/exec/live_runtime.hpp"
#include "core/wire/bench/bare_dds.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"

namespace adit::bench {

constexpr wire::TopicInfo kPingUrgent{"adit/ping", "Bytes", wire::QosClass::urgent, 16, false, 1 << 16};
constexpr wire::TopicInfo kPongUrgent{"adit/pong", "Bytes", wire::QosClass::urgent, 16, false, 1 << 16};
constexpr wire::TopicInfo kPingStream{"adit/ping_stream", "Bytes", wire::QosClass::stream, 1, false, 1 << 16};
constexpr wire::TopicInfo kPongStream{"adit/pong_stream", "Bytes", wire::QosClass::stream, 1, false, 1 << 16};

/// Sends back what it gets: over our wire from a strand, over bare Fast DDS from its thread.
class Echo {
 public:
  explicit Echo(unsigned domain);

 private:
  LiveRuntime runtime_{};
  std::shared_ptr<Executor> strand_{runtime_.strand("echo")};
  std::unique_ptr<wire::Participant> wire_;
  std::unique_ptr<wire::RawWriter> urgent_, stream_;
  std::unique_ptr<wire::RawReader> urgent_in_, stream_in_;
  std::unique_ptr<BareDds> bare_;
};

}  // namespace adit::bench
