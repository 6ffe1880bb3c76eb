// SPDX-License-Identifier: Apache-2.0
#include "core/record/frame_recorder.hpp"

namespace adit::record {
namespace {

const char* word(wire::SampleEvent::Kind kind) {
  switch (kind) {
    case wire::SampleEvent::Kind::sent:
      return "sent";
    case wire::SampleEvent::Kind::delivered:
      return "delivered";
    case wire::SampleEvent::Kind::lost:
      break;
  }
  return "lost";
}

}  // namespace

FrameRecorder::FrameRecorder(std::unique_ptr<Output> output, FrameRecorderParams params)
    : params_(std::move(params)),
      output_(std::move(output)),
      writer_(*output_, {1 << 20, true, "adit rehearse"}) {
  state_ = writer_.add_metadata("adit", params_.about);
}

Result<std::unique_ptr<FrameRecorder>> FrameRecorder::open(FrameRecorderParams params) {
  auto output = open_file(params.file, true);
  if (!output) return output.error();
  return std::unique_ptr<FrameRecorder>(new FrameRecorder(std::move(*output), std::move(params)));
}

FrameRecorder::Known& FrameRecorder::channel(const wire::SampleEvent& frame) {
  key_.assign(frame.from_name);
  key_.append("/").append(frame.topic);
  if (frame.kind != wire::SampleEvent::Kind::sent) key_.append(">").append(frame.to_name);
  if (frame.kind == wire::SampleEvent::Kind::lost) key_.append("/lost");
  const std::size_t topic = key_.size();
  key_.append("#").append(frame.partition).append("#").append(std::to_string(frame.domain));
  if (const auto it = known_.find(key_); it != known_.end()) return it->second;
  Known known;
  known.id = static_cast<ChannelId>(known_.size());
  known.info = {key_.substr(0, topic),
                std::string(frame.type),
                {{"from", std::string(frame.from_name)},
                 {"to", std::string(frame.to_name)},
                 {"kind", word(frame.kind)},
                 {"domain", std::to_string(frame.domain)},
                 {"partition", std::string(frame.partition)}}};
  return known_.emplace(key_, std::move(known)).first->second;
}

void FrameRecorder::see(const wire::SampleEvent& frame) {
  if (!state_) return;
  if (frame.domain != params_.radio_domain && frame.kind != wire::SampleEvent::Kind::sent) return;
  Known& known = channel(frame);
  if (frame.bytes.size() > params_.large && params_.large_period > 0ns) {
    if (known.last_large != Duration::min() && frame.at - known.last_large < params_.large_period) return;
    known.last_large = frame.at;
  }
  state_ = writer_.write(channels_.get(known.id, known.info), static_cast<std::uint64_t>(frame.at.count()),
                         frame.bytes);
}

Result<void> FrameRecorder::close() {
  if (const auto closed = writer_.close(); state_) state_ = closed;
  return state_;
}

}  // namespace adit::record
