// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/objects/objects_part.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "perception/objects/object_place.hpp"

namespace adit::agent {
namespace {

constexpr Duration kTick = 100ms;
constexpr Duration kFresh = 1s;               // Age of the newest scan.
constexpr Duration kRetry = 10s;              // After the detector could not be loaded for lack of time.
constexpr std::size_t kPhotos = 4;            // Of one picture, those of the best scores.
constexpr std::uint32_t kPhotoSource = 1600;  // Side of the picture that photos are cut from, pixels.
// Stamps of a picture and a scan that are farther apart are of two clocks, ns. Pictures that are late by
// less have no scan and are refused.
constexpr std::int64_t kOneClock = 5'000'000'000;
constexpr std::uint64_t kNearScan = 250'000'000;  // From the exposure to a scan whose pose is used, ns.
constexpr double kMargin = 0.4;                   // Around an object, of the sides of its box.
constexpr int kPhotoQuality = 85;

/// The time of a scan and of a picture, ns, by the clock that both have.
struct Instants {
  std::uint64_t scan{}, picture{};
};
Instants instants(const ObjectsJob& job, const DriverPicture& picture) {
  const auto apart = static_cast<std::int64_t>(job.stamp - picture.stamp);
  if (job.stamp != 0 && picture.stamp != 0 && std::abs(apart) <= kOneClock) return {job.stamp, picture.stamp};
  return {to_stamp(job.received), to_stamp(picture.received)};
}

/// Of this computer, and over soon.
bool is_passing(Reason reason) { return reason == Reason::queue_full || reason == Reason::cancelled; }

}  // namespace

std::vector<Eigen::Vector3f> points_in_camera(std::span<const std::shared_ptr<const ObjectsJob>> scans,
                                              const Pose3& T_odom_camera) {
  std::vector<Eigen::Vector3f> out;
  const Pose3 T_camera_odom = T_odom_camera.inverse();
  for (const auto& job : scans) {
    const auto scan = without_team(job->scan, job->team);
    const Pose3 T_camera_base = T_camera_odom * scan->located;
    const Eigen::Affine3f T =
        (Eigen::Translation3d(T_camera_base.position) * T_camera_base.orientation).cast<float>();
    out.reserve(out.size() + scan->points.size());
    for (const Eigen::Vector3f& point : scan->points) {
      const Eigen::Vector3f at = T * point;
      if (at.x() > 0.0f) out.push_back(at);
    }
  }
  return out;
}

std::vector<std::uint8_t> cut_out(const perception::Picture& picture, const perception::ObjectBox& box) {
  const auto pixel = [](double share, std::uint32_t side) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * side));
  };
  const std::uint32_t left = pixel(box.left - kMargin * box.width, picture.width);
  const std::uint32_t right = pixel(box.left + (1.0 + kMargin) * box.width, picture.width);
  const std::uint32_t top = pixel(box.top - kMargin * box.height, picture.height);
  const std::uint32_t bottom = pixel(box.top + (1.0 + kMargin) * box.height, picture.height);
  if (right <= left || bottom <= top) return {};
  perception::Picture out{.width = right - left, .height = bottom - top, .channels = picture.channels};
  const std::size_t row = std::size_t{out.width} * out.channels;
  out.bytes.reserve(row * out.height);
  for (std::uint32_t y = top; y < bottom; ++y) {
    const auto begin =
        picture.bytes.begin() +
        static_cast<std::ptrdiff_t>((std::size_t{y} * picture.width + left) * picture.channels);
    out.bytes.insert(out.bytes.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
  }
  return perception::encode_jpeg(out, kPhotoQuality);
}

ObjectsPart::ObjectsPart(ObjectsPartParams params, Executor& strand, Log log, wire::ComponentIo io,
                         ObjectsService& service, std::function<void(const InputFault&)> fault)
    : Component("objects", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      io_(std::move(io)),
      service_(service),
      fault_(std::move(fault)) {
  for (std::size_t i = 0; i < params_.cameras.size(); ++i)
    readers_.push_back(std::make_unique<CameraReader>(
        params_.cameras[i],
        CameraReader::Outputs{
            [this, i] { return wants_picture(i); },
            [this, i](std::shared_ptr<const DriverPicture> picture) { take(i, std::move(picture)); },
            [this](const std::function<void()>& work) { protect([&work] { work(); }); },
            [this](const InputFault& problem) { fault_(problem); }}));
}

ObjectsPart::~ObjectsPart() = default;

bool ObjectsPart::wants_picture(std::size_t camera) const {
  // Without scans, as before the robot knows where it is, nothing can be placed.
  const bool scans = !scans_.empty() && now() - scans_.back()->received < kFresh;
  return detector_ && !searching_ && !pending_ && scans && camera == turn_ &&
         (!last_ || now() - *last_ >= params_.period);
}

Result<void> ObjectsPart::on_start() {
  offer(service_, [this](const auto& job, const auto& reply) { take(job, reply); });
  tick_ = every(kTick, [this] { tick(); });
  load();
  return {};
}

void ObjectsPart::on_stop() {
  tick_.cancel();
  retry_.cancel();
  for (const auto& reader : readers_) reader->close();
}

void ObjectsPart::load() {
  if (!params_.make) {
    no_detector_ = Error{Reason::not_supported, "this program was built without object detection"};
    return;
  }
  searching_ = true;
  compute(
      {.name = "load detector",
       .modelled = 1s,
       .watchdog = 60s,
       .priority = JobPriority::low,
       .lane = "objects"},
      [make = params_.make, detector = params_.detector] { return make(detector); },
      [this](Result<std::shared_ptr<perception::ObjectDetector>> made) {
        searching_ = false;
        if (made) {
          detector_ = std::move(*made);
        } else if (is_passing(made.reason())) {
          retry_ = after(kRetry, [this] { load(); });
        } else {
          no_detector_ = made.error();
        }
      });
}

void ObjectsPart::tick() {
  // As long as it lasts, the health report has it.
  if (no_detector_) return fault_({"objects", "detector_refused", Severity::warning, *no_detector_});
  if (!detector_) return;
  // No scan released it: the lidar is silent, or the robot lost its place.
  if (pending_ && !searching_ && now() - pending_->picture->received > 2 * kPatience) pending_.reset();
  for (const auto& reader : readers_) reader->tick(io_, now());
  // A camera without pictures does not hold up the others.
  if (!pending_ && !searching_ && (!last_ || now() - *last_ >= 2 * params_.period)) {
    turn_ = (turn_ + 1) % readers_.size();
    last_ = now() - params_.period;
  }
}

void ObjectsPart::take(std::size_t camera, std::shared_ptr<const DriverPicture> picture) {
  last_ = now();
  turn_ = (camera + 1) % readers_.size();
  pending_ = Pending{std::move(picture), camera};
  search_when_located();
}

void ObjectsPart::take(const std::shared_ptr<const ObjectsJob>& job, const Reply<ObjectsStep>& reply) {
  // Poses before a jump, or of another frame, do not fit.
  if (!scans_.empty() &&
      (scans_.back()->odom_epoch != job->odom_epoch || scans_.back()->scan->jumps != job->scan->jumps)) {
    scans_.clear();
    ready_ = {};
  }
  scans_.push_back(job);
  while (scans_.size() > params_.max_scans || job->received - scans_.front()->received > params_.window)
    scans_.pop_front();
  reply(std::exchange(ready_, {}));
  search_when_located();
}

bool ObjectsPart::has_scan_after(const DriverPicture& picture) const {
  if (scans_.empty()) return false;
  const Instants at = instants(*scans_.back(), picture);
  return at.scan >= at.picture;
}

Result<Pose3> ObjectsPart::pose_at(const DriverPicture& picture) const {
  PoseHistory poses;
  const ObjectsJob* nearest = nullptr;
  std::uint64_t apart = 0, wanted = 0;
  for (const auto& job : scans_) {
    const Instants at = instants(*job, picture);
    wanted = at.picture;
    poses.add(at.scan, job->scan->located);
    const std::uint64_t distance = at.scan > at.picture ? at.scan - at.picture : at.picture - at.scan;
    if (nearest != nullptr && distance >= apart) continue;
    nearest = job.get();
    apart = distance;
  }
  if (auto pose = poses.at(wanted)) return pose;
  if (nearest == nullptr || apart > kNearScan)
    return Error{
        Reason::sensor_times,
        "no scan is of the time of a picture: objects in it have no place; are the clocks of camera and "
        "lidar synchronised, and does the picture come within 2 s?"};
  return nearest->scan->located;
}

std::vector<std::shared_ptr<const ObjectsJob>> ObjectsPart::scans_near(const DriverPicture& picture) const {
  std::vector<std::shared_ptr<const ObjectsJob>> out(scans_.begin(), scans_.end());
  std::ranges::stable_sort(out, {}, [&picture](const auto& job) {
    const Instants at = instants(*job, picture);
    return at.scan > at.picture ? at.scan - at.picture : at.picture - at.scan;
  });
  if (out.size() > params_.used_scans) out.resize(params_.used_scans);
  return out;
}

void ObjectsPart::search_when_located() {
  if (!pending_ || searching_) return;
  if (!has_scan_after(*pending_->picture) && now() - pending_->picture->received < kPatience) return;
  const Pending pending = *std::exchange(pending_, std::nullopt);
  const auto T_odom_base = pose_at(*pending.picture);
  if (!T_odom_base) return readers_[pending.camera]->report(T_odom_base.error(), "sensor_refused");
  search(pending, *T_odom_base);
}

void ObjectsPart::search(const Pending& pending, const Pose3& T_odom_base) {
  searching_ = true;
  const CameraConfig& config = params_.cameras[pending.camera];
  const Pose3 T_odom_camera = T_odom_base * config.mounting.pose();
  const ObjectsJob& newest = *scans_.back();
  compute(
      {.name = "objects",
       .modelled = params_.modelled,
       .watchdog = 30s,
       .priority = JobPriority::low,
       .lane = "objects"},
      [picture = pending.picture, detector = detector_, T_odom_camera, field_of_view = config.field_of_view,
       name = config.name,
       scans = scans_near(*pending.picture)](const std::stop_token& stop) -> Result<Found> {
        const std::uint32_t side = detector->picture_side();
        const auto pixels = pixels_of(*picture, side, side);
        if (!pixels) return pixels.error();
        auto boxes = detector->detect(*pixels);
        Found out;
        if (!boxes) {
          out.detector = boxes.error();
          return out;
        }
        if (boxes->empty()) return out;
        std::ranges::stable_sort(*boxes, std::greater<>{}, &perception::ObjectBox::score);
        const perception::PinholeView view{field_of_view,
                                           static_cast<double>(pixels->width) / pixels->height};
        const auto points = points_in_camera(scans, T_odom_camera);
        std::optional<perception::Picture> sharp;
        for (const perception::ObjectBox& box : *boxes) {
          const auto place = perception::place_object(box, view, points);
          if (!place) continue;
          SeenObject seen{.camera = name, .kind = box.kind, .score = box.score, .sigma = place->sigma};
          seen.position = T_odom_camera * place->position;
          if (!sharp) {
            auto large = pixels_of(*picture, kPhotoSource, kPhotoSource);
            sharp = large ? std::move(*large) : *pixels;
          }
          if (out.objects.size() < kPhotos)
            if (auto photo = findings::make_photo(cut_out(*sharp, box), stop))
              seen.photo = std::make_shared<findings::Photo>(std::move(*photo));
          out.objects.push_back(std::move(seen));
        }
        return out;
      },
      [this, camera = pending.camera, epoch = newest.odom_epoch,
       jumps = newest.scan->jumps](Result<Found> result) { found(camera, std::move(result), epoch, jumps); });
}

void ObjectsPart::found(std::size_t camera, Result<Found> result, std::uint32_t epoch, std::uint32_t jumps) {
  searching_ = false;
  if (!result) {
    if (is_passing(result.reason())) return log().warn("objects: " + result.error().text);
    if (result.reason() != Reason::no_answer)
      return readers_[camera]->report(result.error(), "sensor_refused");
    // Work that hung may still use the detector.
    detector_.reset();
    no_detector_ = Error{Reason::no_answer, "the detector did not come to an end; restart objects"};
    return;
  }
  if (result->detector)
    return fault_({"objects", "detector_refused", Severity::warning, *std::move(result->detector)});
  // The frame may have begun again, or jumped, meanwhile.
  if (scans_.empty() || scans_.back()->odom_epoch != epoch || scans_.back()->scan->jumps != jumps) return;
  ++pictures_;
  ready_ = {std::move(result->objects), epoch, (std::uint64_t{params_.instance} << 32) | pictures_};
}

}  // namespace adit::agent
