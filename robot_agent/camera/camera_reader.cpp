// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/camera_reader.hpp"

#include <algorithm>
#include <utility>

#include "core/wire/topics.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"

namespace adit::agent {
namespace {

constexpr Duration kSeek = 1s;  // Between two looks at what the driver writes.

}  // namespace

CameraReader::CameraReader(CameraConfig config, Outputs outputs)
    : config_(std::move(config)),
      outputs_(std::move(outputs)),
      raw_("rt/" + config_.topic + "/image_raw"),
      compressed_(raw_ + "/compressed") {}

void CameraReader::tick(const wire::ComponentIo& io, Time now) {
  if (reader_ && now - heard_ > kSilent) {
    report({Reason::driver_silent, "its driver sends no pictures"}, "sensor_silent");
    reader_.reset();  // Looks again for what is written.
  }
  if (!reader_ && (sought_ == Time{} || now - sought_ >= kSeek)) open(io, now);
}

void CameraReader::open(const wire::ComponentIo& io, Time now) {
  sought_ = now;
  const auto written = [&](const std::string& name) {
    const auto ends = io.wire.endpoints(name);
    return std::ranges::any_of(ends, [](const wire::RemoteEndpoint& end) { return end.writes; });
  };
  // Of a driver that writes both, the smaller messages.
  const bool compressed = written(compressed_);
  if (!compressed && !written(raw_))
    return report({Reason::driver_silent, "no driver writes /" + config_.topic + "/image_raw or /" +
                                              config_.topic + "/image_raw/compressed"},
                  "sensor_silent");
  const auto handler = [this]<class Message>(const Message&) {
    return [this](std::span<const std::uint8_t> bytes, const wire::SampleInfo& info) {
      bool good = true;
      outputs_.protect([&] {
        heard_ = info.received;
        if (!outputs_.wanted()) return;
        Message message;
        good = wire::decode(bytes, message);
        if (good) outputs_.take(std::make_shared<DriverPicture>(picture_of(message, info.received)));
      });
      return good;
    };
  };
  wire::TopicInfo topic = wire::topics::kImage;
  if (compressed) topic = wire::topics::kCompressedImage;
  topic.name = compressed ? compressed_.c_str() : raw_.c_str();
  auto reader =
      io.wire.make_reader(topic, {}, io.strand,
                          compressed ? wire::RawHandler(handler(sensor_msgs::msg::CompressedImage{}))
                                     : wire::RawHandler(handler(sensor_msgs::msg::Image{})));
  if (!reader) return report(reader.error(), "sensor_silent");
  reader_ = std::move(*reader);
  heard_ = now;
}

void CameraReader::report(const Error& cause, const char* code) const {
  outputs_.fault({config_.topic + "/image_raw", code, Severity::warning,
                  Error{cause.reason, "camera " + config_.name + ": " + cause.text}});
}

}  // namespace adit::agent
