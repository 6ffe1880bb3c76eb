// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/camera_bytes.hpp"

#include <cmath>

#include "basestation/model/json_reader.hpp"
#include "basestation/model/photo_bytes.hpp"
#include "core/command/words.hpp"
#include "core/contract/camera.hpp"

namespace adit::station {
namespace {

constexpr std::size_t kMaxJpeg = 4 << 20;  // Bytes.

}  // namespace

nlohmann::json json_of(const CameraRequest& request) {
  return {{"robot", request.robot},
          {"camera", request.camera},
          {"width", request.width},
          {"rate", request.rate},
          {"after", request.after}};
}

Result<CameraRequest> camera_request_from(const nlohmann::json& object) {
  CameraRequest out;
  std::string wrong;
  std::uint32_t width = out.width;
  JsonReader in(object, wrong);
  in.read("robot", out.robot);
  in.read("camera", out.camera);
  in.read("width", width);
  in.read("rate", out.rate);
  in.read("after", out.after);
  const bool names =
      command::valid_name(out.robot) && (out.camera.empty() || command::valid_name(out.camera));
  if (!wrong.empty() || !names || width < 1 || width > contract::CameraView::kMaxWidth ||
      !(out.rate > 0.0F && out.rate <= contract::CameraView::kMaxRate))
    return {Reason::malformed, "a camera wants a robot, a width of 1 to 1920 and a rate of up to 30"};
  out.width = static_cast<std::uint16_t>(width);
  return out;
}

nlohmann::json camera_json(const CameraPicture& picture) {
  nlohmann::json out{{"robot", picture.robot}, {"camera", picture.camera}, {"number", picture.number}};
  if (picture.number == 0) return out;
  out["jpeg"] = base64_of(picture.jpeg);
  out["width"] = picture.width;
  out["height"] = picture.height;
  out["colour"] = picture.colour;
  out["span"] = picture.span;
  out["missing"] = base64_of(picture.missing);
  out["absent"] = base64_of(picture.absent);
  out["age"] = picture.age;
  out["pose"] = picture.pose;
  return out;
}

Result<CameraPicture> camera_picture_of(const CommandOutcome& outcome) {
  if (outcome.exit_code != kExitDone) return {Reason::no_answer, outcome.error};
  const auto object = nlohmann::json::parse(outcome.json, nullptr, false);
  CameraPicture out;
  std::string wrong, jpeg, missing, absent;
  JsonReader in(object, wrong);
  in.read("robot", out.robot);
  in.read("camera", out.camera);
  in.read("number", out.number);
  in.read("jpeg", jpeg);
  in.read("width", out.width);
  in.read("height", out.height);
  in.read("colour", out.colour);
  in.read("span", out.span);
  in.read("missing", missing);
  in.read("absent", absent);
  in.read("age", out.age);
  in.read("pose", out.pose);
  if (!wrong.empty()) return {Reason::malformed, "a picture's '" + wrong + "' does not fit"};
  if (out.number == 0) return out;
  if (jpeg.size() / 4 * 3 > kMaxJpeg) return {Reason::out_of_range, "a picture of more than 4 MB"};
  auto bytes = bytes_of_base64(jpeg);
  auto bits = bytes_of_base64(missing), gaps = bytes_of_base64(absent);
  const bool sound = out.width > 0 && out.width <= 1920 && out.height > 0 && out.height <= 1088 &&
                     out.span > 0 && out.span <= 255 && std::isfinite(out.age) &&
                     (out.pose.empty() || out.pose.size() == 7);
  if (!bytes || !bits || !gaps || bits->size() > 64 || gaps->size() > 64 || !sound)
    return {Reason::malformed, "a picture's bytes or sizes do not fit"};
  out.jpeg = std::move(*bytes);
  out.missing = std::move(*bits);
  out.absent = std::move(*gaps);
  return out;
}

}  // namespace adit::station
