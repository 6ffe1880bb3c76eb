// SPDX-License-Identifier: Apache-2.0
#include "bench/wire/echo.hpp"

namespace adit::bench {

Echo::Echo(unsigned domain) {
  wire_ = std::move(wire::open_fastdds({.domain = domain, .name = "echo"})).value();
  urgent_ = std::move(wire_->make_writer(kPongUrgent, "")).value();
  stream_ = std::move(wire_->make_writer(kPongStream, "")).value();
  urgent_in_ =
      std::move(wire_->make_reader(kPingUrgent, "", *strand_, [this](auto bytes, const wire::SampleInfo&) {
        return urgent_->write(bytes).ok();
      })).value();
  stream_in_ =
      std::move(wire_->make_reader(kPingStream, "", *strand_, [this](auto bytes, const wire::SampleInfo&) {
        return stream_->write(bytes).ok();
      })).value();
  bare_ = std::make_unique<BareDds>(domain, "bare/pong", "bare/ping",
                                    [this](auto bytes) { bare_->write(bytes); });
}

}  // namespace adit::bench
