// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "basestation/client/options.hpp"
#include "basestation/station/station.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/record/flight_recorder.hpp"

namespace adit::station::host {

/// A station in this process, on the real clock and the real network.
class LiveStation {
 public:
  struct Hooks {
    std::function<void(Station&)> ready{};  ///< Called on the strand before the station starts.
    Duration presence{std::chrono::seconds(1)};
    Duration discovery_grace{std::chrono::seconds(5)};
    bool content{
        true};  ///< Takes findings and maps; false: the station of that name does, in another process.
    bool record{false};  ///< Records the last minutes in the folder of the options.
  };
  /// Errors: as of station_id(), load_link(), open_fastdds() and Station::start().
  static Result<std::unique_ptr<LiveStation>> open(const client::StationOptions& options, const Hooks& hooks);
  ~LiveStation();

  Station& station() { return *station_; }
  Executor& strand() { return *strand_; }
  /// Runs a command and waits for its end, at most `limit`, after which the outcome is no_answer. Do not call
  /// it on the strand.
  Outcome execute(const command::Request& request, std::chrono::milliseconds limit);

 private:
  LiveStation() = default;
  void on_strand(const std::function<void()>& work);

  LiveRuntime runtime_{};
  std::shared_ptr<Executor> strand_{};
  std::unique_ptr<wire::Participant> wire_{};
  std::unique_ptr<record::FlightRecorder> flight_recorder_{};
  std::unique_ptr<Station> station_{};
};

}  // namespace adit::station::host
