// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/log/log.hpp"
#include "core/record/recorder.hpp"
#include "core/wire/participant.hpp"

namespace adit::record {

/// Default folder of recordings: $XDG_STATE_HOME/adit/recordings, for root /var/lib/adit/recordings, else
/// ~/.local/state/adit/recordings.
std::string default_folder();

/// Parameters of FlightRecorder.
struct FlightRecorderParams {
  std::string folder{};  ///< "none": no recording; empty: default_folder().
  std::string name{};    ///< Name of the agent or station.
  Text about{};          ///< Metadata of every file.
  /// Called once per problem, on the writing thread.
  std::function<void(const std::string& text)> on_error{};
};

/// Records the last minutes of a live program in 8 files of 4 MB. Create it after the participants and the
/// log that it records, and destroy it before them.
class FlightRecorder {
 public:
  explicit FlightRecorder(FlightRecorderParams params);
  /// Returns the participant to use instead of `wire`; `wire` itself when recording is off.
  wire::Participant& tap(wire::Participant& wire, const std::string& net);
  std::shared_ptr<LogSink> tap(std::shared_ptr<LogSink> log);

 private:
  std::unique_ptr<Recorder> recorder_{};
  std::vector<std::unique_ptr<wire::Participant>> wires_{};
};

}  // namespace adit::record
