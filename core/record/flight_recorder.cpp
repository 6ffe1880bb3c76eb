// SPDX-License-Identifier: Apache-2.0
#include "core/record/flight_recorder.hpp"

#include <unistd.h>

#include <cstdlib>

#include "core/record/recording_log.hpp"
#include "core/record/recording_participant.hpp"

namespace adit::record {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

std::string default_folder() {
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/adit/recordings";
  const std::string home = variable("HOME");
  if (::geteuid() == 0 || home.empty()) return "/var/lib/adit/recordings";
  return home + "/.local/state/adit/recordings";
}

FlightRecorder::FlightRecorder(FlightRecorderParams params) {
  if (params.folder == "none") return;
  RecorderParams recorder;
  recorder.ring.folder = params.folder.empty() ? default_folder() : params.folder;
  recorder.ring.name = params.name;
  recorder.about = std::move(params.about);
  recorder.about["name"] = params.name;
  recorder.on_error = std::move(params.on_error);
  recorder_ = std::make_unique<Recorder>(std::move(recorder));
}

wire::Participant& FlightRecorder::tap(wire::Participant& wire, const std::string& net) {
  if (!recorder_) return wire;
  wires_.push_back(std::make_unique<RecordingParticipant>(wire, *recorder_, net));
  return *wires_.back();
}

std::shared_ptr<LogSink> FlightRecorder::tap(std::shared_ptr<LogSink> log) {
  if (!recorder_ || !log) return log;
  return std::make_shared<RecordingLog>(std::move(log), *recorder_);
}

}  // namespace adit::record
