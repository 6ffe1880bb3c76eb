#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/log/log.hpp"
#include "core/record/recorder.hpp"
#include "core/wire/participant.hpp"

namespace adit::record {

/// Where a program keeps the last minutes when nothing is said: $XDG_STATE_HOME/adit/recordings, for root
/// /var/lib/adit/recordings, else ~/.local/state/adit/recordings.
std::string default_folder();

struct FlightRecorderParams {
  std::string folder{};  ///< "none": nothing is kept; empty: default_folder()
  std::string name{};    ///< of the agent or station
  Text about{};          ///< metadata of every file
  std::function<void(const std::string& text)> on_error{};  ///< once per trouble, on the writing thread
};

/// What a live program keeps of its last minutes: 8 files of 4 MB. Made after the wires and the log it taps,
/// and gone before them.
class FlightRecorder {
 public:
  explicit FlightRecorder(FlightRecorderParams params);
  /// The wire to be used instead of that one; the same when nothing is kept.
  wire::Participant& tap(wire::Participant& wire, const std::string& net);
  std::shared_ptr<LogSink> tap(std::shared_ptr<LogSink> log);

 private:
  std::unique_ptr<Recorder> recorder_{};
  std::vector<std::unique_ptr<wire::Participant>> wires_{};
};

}  // namespace adit::record
