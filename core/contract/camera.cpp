// SPDX-License-Identifier: Apache-2.0
#include "core/contract/camera.hpp"

#include <algorithm>

#include "adit/camera.h"
#include "core/command/words.hpp"

namespace adit::contract {

radio::CameraPiece encode(const CameraPiece& piece) {
  radio::CameraPiece out;
  out.robot(piece.robot);
  out.camera(piece.camera);
  out.data(piece.data);
  return out;
}

std::optional<CameraPiece> decode(const radio::CameraPiece& sample) {
  if (!command::valid_name(sample.robot()) || !command::valid_name(sample.camera()) ||
      sample.data().size() > CameraPiece::kMaxBytes)
    return std::nullopt;
  return CameraPiece{sample.robot(), sample.camera(), sample.data()};
}

radio::CameraViews encode(const CameraViews& views) {
  radio::CameraViews out;
  out.station(views.station);
  out.station_id(views.station_id);
  for (const CameraView& view : views.views) {
    radio::CameraView& message = out.views().emplace_back();
    message.robot(view.robot);
    message.camera(view.camera);
    message.width(view.width);
    message.rate(view.rate);
    message.shot(view.shot);
    message.run(view.run);
    message.frame(view.frame);
    message.arrived(view.arrived);
    message.missing(view.missing);
  }
  return out;
}

std::optional<CameraViews> decode(const radio::CameraViews& sample) {
  if (!command::valid_name(sample.station())) return std::nullopt;
  CameraViews out{.station = sample.station(), .station_id = sample.station_id()};
  for (const radio::CameraView& message : sample.views()) {
    if (out.views.size() == CameraViews::kMaxViews) break;
    const bool valid = command::valid_name(message.robot()) && command::valid_name(message.camera()) &&
                       message.rate() >= 0.0F && message.rate() <= CameraView::kMaxRate &&
                       message.width() <= CameraView::kMaxWidth &&
                       message.missing().size() <= CameraView::kMaxMissing;
    if (valid)
      out.views.push_back({message.robot(), message.camera(), message.width(), message.rate(), message.shot(),
                           message.run(), message.frame(), message.arrived(), message.missing()});
  }
  return out;
}

}  // namespace adit::contract
