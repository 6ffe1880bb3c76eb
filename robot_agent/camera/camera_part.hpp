// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/component/component.hpp"
#include "core/config/sensors.hpp"
#include "core/transfer/pacer.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/camera/camera_calls.hpp"
#include "robot_agent/camera/camera_stream.hpp"
#include "robot_agent/camera/driver_picture.hpp"
#include "robot_agent/motion/input_faults.hpp"

namespace adit::agent {

/// Parameters of CameraPart.
struct CameraParams {
  std::string robot{};
  std::vector<CameraConfig> cameras{};
  std::uint32_t run{1};     ///< Of the pictures' numbers, drawn at each start, not 0.
  Duration modelled{15ms};  ///< Duration of coding a picture in rehearsal.
  /// Share of the link's bandwidth for pictures; the class may use 0.3 of it.
  transfer::PacerParams pacing{
      .share = 0.29, .max_rate = 2e6, .unknown_link = 4e6, .max_queue = 30ms, .priority = 6};
};

/// The ends of a CameraPart on both domains.
struct CameraEnds {
  wire::ComponentIo radio, robot;
};

/// The component that sends pictures of the robot's cameras while a station looks, on a strand of its own.
/// Drivers' topics are read only then, and pictures are decoded and coded as compute work.
class CameraPart : public Component {
 public:
  CameraPart(CameraParams params, Executor& strand, Log log, const CameraEnds& ends, CameraService& service,
             const PlaceService& place, std::function<void(const InputFault&)> fault);
  ~CameraPart() override;

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  struct Camera;
  /// A picture of the driver, with the pose of the body at its exposure.
  struct Taken {
    std::shared_ptr<const DriverPicture> picture{};
    std::optional<Pose3> T_map_base{};
    Time exposed{};
  };

  CameraAnswer take(const CameraOrder& order);
  /// Opens and closes the drivers' topics as they are needed, and begins or ends the ticks.
  void update();
  void tick();
  void send(Time at);
  bool needs_live(const Camera& camera) const;
  bool needs_shot(const Camera& camera) const;
  void take(Camera& camera, std::shared_ptr<const DriverPicture> picture);
  void code(Camera& camera, const Taken& taken);
  void shoot(Camera& camera, const Taken& taken);
  /// Reports a picture that could not be used.
  void refuse(const Camera& camera, const Error& error);
  /// Asks where the robot was when the picture was taken; `done` gets the pose of the body and the exposure's
  /// time by this strand's clock.
  void locate(const Camera& camera, const DriverPicture& picture,
              std::function<void(const std::optional<Pose3>& T_map_base, Time exposed)> done);

  CameraParams params_;
  CameraEnds ends_;
  CameraService& service_;
  const PlaceService& place_;
  std::function<void(const InputFault&)> fault_;
  transfer::Pacer pacer_;
  wire::Writer<radio::CameraPiece> pieces_{};  ///< Open since the first look.
  std::vector<std::unique_ptr<Camera>> cameras_{};
  std::vector<TakenShot> fresh_{}, shots_{};  ///< `shots_`: in the last answer.
  std::uint64_t batch_{};                     ///< Of that answer.
  std::size_t turn_{};                        ///< Of the cameras, which send in turns.
  Timer tick_{};
};

}  // namespace adit::agent
