// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/component/component.hpp"
#include "core/config/sensors.hpp"
#include "core/wire/component_io.hpp"
#include "perception/objects/object_detector.hpp"
#include "robot_agent/camera/camera_reader.hpp"
#include "robot_agent/motion/pose_history.hpp"
#include "robot_agent/objects/objects_calls.hpp"

namespace adit::agent {

/// Parameters of ObjectsPart.
struct ObjectsPartParams {
  std::vector<CameraConfig> cameras{};
  perception::DetectorParams detector{};
  perception::DetectorFactory make{};  ///< Empty: this program has no detector.
  Duration period{1s};                 ///< Between two pictures of all cameras, >= 1 s.
  Duration window{2s};                 ///< Scans are stored for so long: large pictures come late.
  std::size_t max_scans{24};           ///< In the window.
  std::size_t used_scans{6};           ///< Those nearest to the exposure, with which objects are placed.
  Duration modelled{150ms};            ///< Duration of a search in rehearsal.
  std::uint32_t instance{1};           ///< Of the component since the start of the agent.
};

/// The component that seeks objects in pictures of the robot's cameras, one a second in turns, and places
/// them with the lidar, on a strand of its own. The detector runs as compute work, which may take seconds:
/// the strand must not be a dedicated one, on which that counts as a hang.
class ObjectsPart : public Component {
 public:
  /// A picture waits at most so long for a scan that is as new.
  static constexpr Duration kPatience{400ms};

  ObjectsPart(ObjectsPartParams params, Executor& strand, Log log, wire::ComponentIo io,
              ObjectsService& service, std::function<void(const InputFault&)> fault);
  ~ObjectsPart() override;

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  /// A picture that waits for a scan.
  struct Pending {
    std::shared_ptr<const DriverPicture> picture{};
    std::size_t camera{};
  };
  /// What a search gave: objects, or why the detector cannot be used. The error of a Result is the picture's.
  struct Found {
    std::vector<SeenObject> objects{};
    std::optional<Error> detector{};
  };
  void load();
  bool wants_picture(std::size_t camera) const;
  void found(std::size_t camera, Result<Found> result, std::uint32_t epoch, std::uint32_t jumps);
  void tick();
  void take(const std::shared_ptr<const ObjectsJob>& job, const Reply<ObjectsStep>& reply);
  void take(std::size_t camera, std::shared_ptr<const DriverPicture> picture);
  /// Searches the pending picture once the odometry reaches its exposure.
  void search_when_located();
  void search(const Pending& pending, const Pose3& T_odom_base);
  /// The pose of the body at the exposure. Error: sensor_times, when no scan is near that time.
  Result<Pose3> pose_at(const DriverPicture& picture) const;
  bool has_scan_after(const DriverPicture& picture) const;
  /// The scans nearest to the exposure.
  std::vector<std::shared_ptr<const ObjectsJob>> scans_near(const DriverPicture& picture) const;

  ObjectsPartParams params_;
  wire::ComponentIo io_;
  ObjectsService& service_;
  std::function<void(const InputFault&)> fault_;
  std::vector<std::unique_ptr<CameraReader>> readers_{};
  std::shared_ptr<perception::ObjectDetector> detector_{};
  std::optional<Error> no_detector_{};  ///< Why there is none.
  std::deque<std::shared_ptr<const ObjectsJob>> scans_{};
  std::optional<Pending> pending_{};
  bool searching_{};            ///< The detector is loaded, or used.
  std::optional<Time> last_{};  ///< When the last picture was taken.
  std::size_t turn_{};          ///< Camera that is next.
  std::uint64_t pictures_{};
  ObjectsStep ready_{};
  Timer tick_{}, retry_{};
};

/// The points of scans in the frame of a camera, m, without those of other robots.
std::vector<Eigen::Vector3f> points_in_camera(std::span<const std::shared_ptr<const ObjectsJob>> scans,
                                              const Pose3& T_odom_camera);
/// The part of a picture around a box, with a margin, as a JPEG; empty: the box has no pixels.
std::vector<std::uint8_t> cut_out(const perception::Picture& picture, const perception::ObjectBox& box);

}  // namespace adit::agent
