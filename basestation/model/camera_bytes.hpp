// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "basestation/model/camera.hpp"
#include "basestation/model/outcome.hpp"
#include "core/result/result.hpp"

/// A live picture on its way from the station to a front end, in the object for scripts of an outcome.
namespace adit::station {

nlohmann::json json_of(const CameraRequest& request);
/// Error: malformed.
Result<CameraRequest> camera_request_from(const nlohmann::json& object);

nlohmann::json camera_json(const CameraPicture& picture);
/// Reads such an outcome, on any thread; a number of 0: there is no newer picture. Errors: no_answer (the
/// text says why the station has none), malformed, out_of_range.
Result<CameraPicture> camera_picture_of(const CommandOutcome& outcome);

}  // namespace adit::station
