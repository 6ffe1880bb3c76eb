// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "basestation/fleet/fleet.hpp"
#include "basestation/fleet/station_params.hpp"
#include "core/contract/refusals.hpp"
#include "core/contract/traffic_meter.hpp"
#include "core/time/random.hpp"

namespace adit::station {

/// Announces the station to its peers and reports its traffic, while the station is up.
class Presence {
 public:
  /// `random`: draws the phases of the periodic messages.
  Presence(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
           Random& random);
  ~Presence();

  /// Opens the topics. Error: wire_failed.
  Result<void> open();
  /// Announces the station, and from then on periodically. Error: wire_failed.
  Result<void> start();
  /// Announces the station four times within 0.7 s, as a peer's endpoints may not be matched yet.
  void announce_often();
  void go_up();
  void go_down() { up_ = false; }
  bool up() const { return up_; }

 private:
  struct Topics;
  void announce();
  void report_traffic();
  /// Reports what the radio refused, and a receiving thread that hangs.
  void look_at_radio(const wire::WireCounters& counters);

  const StationParams& params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  Random& random_;
  bool up_{true};
  contract::TrafficMeter meter_{};
  contract::RefusalNews refusals_{};
  int receiver_hangs_{};
  std::uint32_t presence_seq_{};
  std::uint64_t report_seq_{};
  std::unique_ptr<Topics> topics_;
  std::vector<Timer> timers_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
