#include "core/record/keep.hpp"

#include <unistd.h>

#include <cstdlib>

#include "core/record/recording_log.hpp"
#include "core/record/recording_wire.hpp"

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

Keeper::Keeper(KeepParams params) {
  if (params.folder == "none") return;
  RecorderParams recorder;
  recorder.ring.folder = params.folder.empty() ? default_folder() : params.folder;
  recorder.ring.name = params.name;
  recorder.about = std::move(params.about);
  recorder.about["name"] = params.name;
  recorder.complain = std::move(params.complain);
  recorder_ = std::make_unique<Recorder>(std::move(recorder));
}

wire::Wire& Keeper::tap(wire::Wire& wire, const std::string& net) {
  if (!recorder_) return wire;
  wires_.push_back(std::make_unique<RecordingWire>(wire, *recorder_, net));
  return *wires_.back();
}

std::shared_ptr<LogSink> Keeper::tap(std::shared_ptr<LogSink> log) {
  if (!recorder_ || !log) return log;
  return std::make_shared<RecordingLog>(std::move(log), *recorder_);
}

}  // namespace adit::record
