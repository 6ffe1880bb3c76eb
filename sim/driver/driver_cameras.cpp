// SPDX-License-Identifier: Apache-2.0
// The cameras of a simulated driver.
#include <algorithm>

#include "core/wire/topics.hpp"
#include "sim/driver/image_messages.hpp"
#include "sim/driver/messages.hpp"
#include "sim/driver/robot_driver.hpp"

namespace adit::sim {
namespace {

constexpr Duration kReadout{
    30ms};  // From the exposure until a picture is sent; of 640 x 480 pixels 10 ms more.
constexpr Duration kPerPixel{33ns};

/// Delay of a picture's sample in rehearsal. A fast camera has a short one: the picture is sent before the
/// next is taken.
Duration picture_delay(const CameraConfig& camera) {
  const Duration delay = kReadout + kPerPixel * (camera.width * camera.height);
  return std::min(delay, from_seconds(0.9 / camera.rate));
}

}  // namespace

struct RobotDriver::Cameras {
  struct One {
    std::unique_ptr<wire::RawWriter> writer{};
    bool under_way{};  ///< A picture of it is being rendered.
  };
  std::vector<One> all{};
};

Result<void> RobotDriver::start_cameras() {
  const std::vector<CameraConfig>& cameras = simulation_.platform(robot_).cameras;
  if (cameras.empty()) return {};
  cameras_ = std::make_shared<Cameras>();
  for (const CameraConfig& camera : cameras) {
    wire::TopicInfo topic = wire::topics::kImage;
    if (camera.compressed) topic = wire::topics::kCompressedImage;
    const std::string name =
        "rt/" + camera.topic + (camera.compressed ? "/image_raw/compressed" : "/image_raw");
    topic.name = name.c_str();
    auto writer = wire_.make_writer(topic, {});
    if (!writer) return writer.error();
    cameras_->all.push_back({std::move(*writer)});
    const std::size_t number = pictures_.size();
    pictures_.push_back(
        strand_.every(from_seconds(1.0 / camera.rate), [this, number] { send_picture(number); }));
  }
  return {};
}

void RobotDriver::send_picture(std::size_t number) {
  Cameras::One& one = cameras_->all[number];
  if (one.under_way || one.writer->matched() == 0 || silent(Sensor::camera)) return;
  if (params_.catch_up) params_.catch_up();
  const CameraConfig& camera = simulation_.platform(robot_).cameras[number];
  const Time exposure = simulation_.params().realistic ? simulated(simulation_.now()) : strand_.now();
  one.under_way = true;
  const auto encode = [job = simulation_.picture(robot_, number), compressed = camera.compressed,
                       broken = broken_jpegs_ > 0,
                       header = header(Sensor::camera, exposure, camera.name + "_optical")] {
    const CameraImage image = job.render();
    return compressed ? jpeg_message(image, broken, header) : image_message(image, header);
  };
  strand_.compute({.name = "picture", .modelled = picture_delay(camera)}, encode,
                  [alive = std::weak_ptr(cameras_), number](const Result<std::vector<std::uint8_t>>& bytes) {
                    const auto cameras = alive.lock();
                    if (!cameras) return;
                    cameras->all[number].under_way = false;
                    // A failed write is counted by the wire; the next picture replaces it.
                    if (bytes) (void)cameras->all[number].writer->write(*bytes);
                  });
}

}  // namespace adit::sim
