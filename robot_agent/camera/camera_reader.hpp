// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/config/sensors.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/camera/driver_picture.hpp"
#include "robot_agent/motion/input_faults.hpp"

namespace adit::agent {

/// Reads the pictures of one camera's driver: the compressed topic where the driver writes it, else the raw
/// one. Which of them is written is looked up once a second until there is one, and again after silence.
class CameraReader {
 public:
  static constexpr Duration kSilent{3s};  ///< A driver that sent nothing for so long is reported.

  /// Callbacks, on the strand of the component.
  struct Outputs {
    /// Whether the next picture is used. A camera sends far more pictures than are needed: only those are
    /// decoded.
    std::function<bool()> wanted{};
    std::function<void(std::shared_ptr<const DriverPicture> picture)> take{};
    /// Calls its argument at once; an exception in it becomes a failure of the component.
    std::function<void(const std::function<void()>& call)> protect{};
    std::function<void(const InputFault& fault)> fault{};
  };

  CameraReader(CameraConfig config, Outputs outputs);

  /// Opens the topic when it is due, and reports a silent driver. Call it every 10 ms to 1 s while pictures
  /// are needed.
  void tick(const wire::ComponentIo& io, Time now);
  void close() { reader_.reset(); }
  bool is_open() const { return reader_ != nullptr; }
  const CameraConfig& config() const { return config_; }
  /// Reports a problem of this camera. `code`: of the notification.
  void report(const Error& cause, const char* code) const;

 private:
  void open(const wire::ComponentIo& io, Time now);

  CameraConfig config_;
  Outputs outputs_;
  std::string raw_, compressed_;  ///< Topics, with rt/.
  std::unique_ptr<wire::RawReader> reader_{};
  Time sought_{}, heard_{};  ///< When the topics were looked for, and when a picture came.
};

}  // namespace adit::agent
