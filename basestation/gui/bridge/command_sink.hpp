// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "basestation/model/camera.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "core/findings/photo_file.hpp"

namespace adit::gui {

/// Receives what the operator orders in the window. The station of the operator, or a test.
class CommandSink {
 public:
  using Done = std::function<void(const station::CommandOutcome&)>;
  virtual ~CommandSink() = default;

  /// Runs a command line; `done` is called once, in the thread of the window.
  virtual void execute(const std::string& line, Done done) = 0;
  /// Asks the station by a command line that changes nothing.
  virtual void query(const std::string& line, Done done) = 0;
  /// Asks for the next picture of a camera; station::camera_picture_of() reads the outcome.
  virtual void camera(const station::CameraRequest& request, Done done) = 0;
  /// Asks the station for the bytes of a part of a photo; station::photo_of() reads the outcome. `id`:
  /// FoundPhoto::id.
  virtual void photo(const std::string& id, findings::PhotoPart part, Done done) = 0;
  /// Software stop of these robots, or of all if there is none.
  virtual void stop(const std::vector<std::string>& robots, Done done) = 0;
  /// The operator looks at this place of the map, or at none in particular.
  virtual void look_at(const std::optional<station::LookedAt>& place) = 0;
  /// Starts the station again after it ended.
  virtual void start_station() = 0;
};

}  // namespace adit::gui
