// SPDX-License-Identifier: Apache-2.0
// What the command component does for the components `cameras` and `objects`.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "robot_agent/command_component.hpp"

namespace adit::agent {

void Agent::CommandComponent::look(const transfer::PeerId& station, std::vector<contract::CameraView> views) {
  std::erase_if(views, [this](const contract::CameraView& view) { return view.robot != params_.name; });
  if (views.empty() || !context_.shots) return;
  for (const contract::CameraView& view : views) context_.shots->wanted(station, view.camera, view.shot);
  protect([&] { ask_cameras({.station = station, .views = std::move(views)}); });
}

void Agent::CommandComponent::ask_cameras(CameraOrder order) {
  order.got = camera_batch_;
  call(context_.cameras, std::move(order), {.deadline = 1s}, [this](const Result<CameraAnswer>& answer) {
    if (!answer) return;  // The next view comes within a second.
    cameras_active_ = answer->active;
    camera_batch_ = answer->batch;
    for (const TakenShot& shot : answer->shots) context_.shots->add(shot, now());
  });
}

void Agent::CommandComponent::seek_objects(const std::shared_ptr<const Scan>& scan, const LidarScan& lidar) {
  const Localisation health = localiser_.health(now());
  if (!context_.objects || health == Localisation::lost || health == Localisation::starting) return;
  auto job = std::make_shared<ObjectsJob>(
      ObjectsJob{scan, team(now()), frames_.odom_epoch(), lidar.stamp, lidar.received});
  call(context_.objects_search, std::shared_ptr<const ObjectsJob>(std::move(job)), {.deadline = 1s},
       [this](const Result<ObjectsStep>& step) {
         if (!step || step->picture == 0 || step->odom_epoch != frames_.odom_epoch()) return;
         for (const SeenObject& seen : step->objects) {
           if (params_.objects->report.importance_of(kind_of(seen.kind)) == 0) continue;
           const Eigen::Vector3d place = frames_.map_frame().T_map_odom * seen.position;
           const Detection detection{.source = "camera " + seen.camera,
                                     .kind = kind_of(seen.kind),
                                     .score = seen.score,
                                     .sigma = std::hypot(seen.sigma, localiser_.sigma()),
                                     .photo = seen.photo};
           if (const auto taken = context_.objects->take(detection, place, step->picture, now()); !taken)
             context_.notifier->to_all(Severity::warning, "finding_refused", taken.reason(),
                                       "an object: " + taken.error().text);
         }
       });
}

PlaceThen Agent::CommandComponent::place_then(const PlaceQuery& query) const {
  constexpr std::int64_t kApart = 1'000'000'000;  // ns; drivers of one computer are nearer to each other.
  const Time at = now();
  PlaceThen out{.age = at - query.received};
  if (!frames_.initialised()) return out;
  Pose3 T_odom_base = frames_.T_odom_base();
  const std::uint64_t newest = frames_.newest_stamp();
  if (query.stamp != 0 && newest != 0) {
    const auto ahead = static_cast<std::int64_t>(newest - query.stamp);
    out.foreign_clock = std::abs(ahead) > kApart;
    if (!out.foreign_clock) {
      out.age = std::max<Duration>(out.age, Duration(ahead) + frames_.silence(at, at));
      const auto then = frames_.T_odom_base_at(query.stamp);
      if (then) T_odom_base = *then;
      if (!then && ahead > 0) return out;  // Older than what is remembered.
    }
  }
  if (localiser_.recognised()) out.T_map_base = frames_.map_frame().T_map_odom * T_odom_base;
  return out;
}

}  // namespace adit::agent
