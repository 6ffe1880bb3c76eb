// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/camera/camera_part.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "adit/camera.h"
#include "core/wire/topics.hpp"
#include "robot_agent/camera/camera_reader.hpp"

namespace adit::agent {
namespace {

constexpr Duration kTick = 10ms;
constexpr std::size_t kMaxShots = 4;  // That did not arrive at the command component.
constexpr std::size_t kMaxArrivals = 256;

}  // namespace

struct CameraPart::Camera {
  CameraStream stream;
  std::optional<CameraReader> reader{};  ///< Never empty after the construction.
  std::vector<std::pair<transfer::PeerId, std::uint32_t>> shooting{};  ///< Whose picture is being coded.
};

CameraPart::CameraPart(CameraParams params, Executor& strand, Log log, const CameraEnds& ends,
                       CameraService& service, const PlaceService& place,
                       std::function<void(const InputFault&)> fault)
    : Component("cameras", strand, std::move(log), {.beat = 100ms}),
      params_(std::move(params)),
      ends_(ends),
      service_(service),
      place_(place),
      fault_(std::move(fault)),
      pacer_(params_.pacing) {
  for (const CameraConfig& config : params_.cameras) {
    Camera& camera =
        *cameras_.emplace_back(std::make_unique<Camera>(Camera{.stream = CameraStream(params_.run)}));
    camera.reader.emplace(
        config,
        CameraReader::Outputs{[this, &camera] { return needs_live(camera) || needs_shot(camera); },
                              [this, &camera](std::shared_ptr<const DriverPicture> picture) {
                                take(camera, std::move(picture));
                              },
                              [this](const std::function<void()>& work) { protect([&work] { work(); }); },
                              [this](const InputFault& problem) { fault_(problem); }});
  }
}

CameraPart::~CameraPart() = default;

Result<void> CameraPart::on_start() {
  offer(service_, [this](const CameraOrder& order, const Reply<CameraAnswer>& reply) { reply(take(order)); });
  return {};
}

void CameraPart::on_stop() {
  tick_.cancel();
  for (const auto& camera : cameras_) camera->reader->close();
}

CameraAnswer CameraPart::take(const CameraOrder& order) {
  if (order.station)
    for (const contract::CameraView& view : order.views)
      for (const auto& camera : cameras_)
        if (camera->reader->config().name == view.camera) camera->stream.look(*order.station, view, now());
  update();
  if (order.got == batch_) shots_.clear();  // They arrived.
  if (!fresh_.empty()) {
    std::move(fresh_.begin(), fresh_.end(), std::back_inserter(shots_));
    fresh_.clear();
    ++batch_;
  }
  CameraAnswer answer{.shots = shots_, .batch = batch_};
  for (const auto& camera : cameras_)
    answer.active = answer.active || camera->stream.is_active(now()) || !camera->shooting.empty();
  return answer;
}

void CameraPart::update() {
  bool any = false;
  for (const auto& camera : cameras_) {
    const bool active = camera->stream.is_active(now());
    any = any || active;
    if (!camera->stream.is_watched(now())) camera->stream.drop();
    if (!active) {
      camera->reader->close();
      continue;
    }
    camera->reader->tick(ends_.robot, now());
  }
  if (any && !tick_.active()) tick_ = every(kTick, [this] { tick(); });
  if (!any) tick_.cancel();
}

void CameraPart::tick() {
  update();
  send(now());
}

void CameraPart::send(Time at) {
  const auto watched =
      std::ranges::count_if(cameras_, [&](const auto& camera) { return camera->stream.is_watched(at); });
  if (watched == 0) return;
  // At the first look, so that a robot at which no station ever looks has no endpoint for it.
  if (!pieces_) {
    if (const auto opened = ends_.radio.open(pieces_, wire::topics::kCamera); !opened)
      return fail(opened.error().text);
  }
  const std::size_t readers = std::max<std::size_t>(1, pieces_.matched());
  pacer_.observe(at, ends_.radio.wire.sender(), readers);
  for (const auto& camera : cameras_) {
    const CameraStream::Arrivals report = camera->stream.take_arrivals();
    for (std::uint32_t i = 0; i < std::min<std::size_t>(report.sent, kMaxArrivals); ++i)
      pacer_.settled(i < report.arrived);
    camera->stream.adapt(pacer_.rate() / static_cast<double>(watched) / static_cast<double>(readers), at);
  }
  std::size_t idle = 0;
  while (pacer_.allows() && idle < cameras_.size()) {
    Camera& camera = *cameras_[turn_ % cameras_.size()];
    if (!camera.stream.has_pieces()) {
      ++turn_;
      ++idle;
      continue;
    }
    idle = 0;
    contract::CameraPiece piece{params_.robot, camera.reader->config().name, camera.stream.next_piece(at)};
    pacer_.sent(piece.data.size());
    (void)pieces_.write(encode(piece));        // Best effort: a lost piece leaves a gap.
    if (!camera.stream.has_pieces()) ++turn_;  // One picture each.
  }
}

bool CameraPart::needs_live(const Camera& camera) const {
  // The first picture waits until a station's reader is there.
  return pieces_.matched() > 0 && camera.stream.is_ready(now());
}

bool CameraPart::needs_shot(const Camera& camera) const {
  return camera.shooting.empty() && fresh_.size() + shots_.size() < kMaxShots &&
         camera.stream.shot_wanted(now());
}

void CameraPart::take(Camera& camera, std::shared_ptr<const DriverPicture> picture) {
  const bool shot = needs_shot(camera), live = needs_live(camera);
  if (shot) camera.shooting = camera.stream.wanted_shots(now());
  if (live) camera.stream.begin(now());
  // The pose first: the odometry of that time is soon forgotten.
  locate(camera, *picture,
         [this, &camera, picture, shot, live](const std::optional<Pose3>& T_map_base, Time exposed) {
           const Taken taken{picture, T_map_base, exposed};
           if (shot) shoot(camera, taken);
           if (live) code(camera, taken);
         });
}

void CameraPart::code(Camera& camera, const Taken& taken) {
  camera.stream.prepare_encoder();
  const std::size_t stripe =
      pacer_.piece_bytes() - perception::kPictureHeaderBytes - perception::kStripeBytes;
  compute(
      {.name = "camera picture",
       .modelled = params_.modelled,
       .priority = JobPriority::low,
       .lane = camera.reader->config().name},
      [picture = taken.picture, encoder = camera.stream.encoder(), rung = camera.stream.rung(), stripe,
       at = now()]() -> Result<perception::StripeEncoder::Coded> {
        const auto pixels = pixels_of(*picture, rung.width, rung.height);
        if (!pixels) return pixels.error();
        const perception::PictureFormat format{.width = static_cast<std::uint16_t>(pixels->width),
                                               .height = static_cast<std::uint16_t>(pixels->height),
                                               .colour = rung.colour && pixels->channels == 3,
                                               .quality = rung.quality};
        auto out = encoder->encode(*pixels, format, stripe, at);
        if (out.format.span == 0) return Error{Reason::internal, "a picture could not be coded"};
        return out;
      },
      [this, &camera, taken](Result<perception::StripeEncoder::Coded> result) {
        if (!result) {
          camera.stream.failed();
          return refuse(camera, result.error());
        }
        std::optional<Pose3> T_map_camera;
        if (taken.T_map_base) T_map_camera = *taken.T_map_base * camera.reader->config().mounting.pose();
        camera.stream.coded(std::move(*result), taken.picture->stamp, T_map_camera, taken.exposed,
                            pacer_.piece_bytes(), now());
        send(now());
      });
}

void CameraPart::shoot(Camera& camera, const Taken& taken) {
  compute(
      {.name = "camera shot",
       .modelled = 2 * params_.modelled,
       .priority = JobPriority::low,
       .lane = camera.reader->config().name + " shot"},
      [picture = taken.picture]() -> Result<std::vector<std::uint8_t>> { return jpeg_of(*picture); },
      [this, &camera, taken](Result<std::vector<std::uint8_t>> jpeg) {
        const auto wanted = std::exchange(camera.shooting, {});
        // It stays wanted: the next picture is tried.
        if (!jpeg) return refuse(camera, jpeg.error());
        const auto age = static_cast<std::uint32_t>((now() - taken.exposed) / 1ms);
        for (const auto& [station, number] : wanted) {
          if (fresh_.size() + shots_.size() >= kMaxShots) break;
          camera.stream.took_shot(station, number);
          fresh_.push_back({station, number, camera.reader->config().name, taken.picture->stamp, age,
                            taken.T_map_base, *jpeg});
        }
      });
}

void CameraPart::refuse(const Camera& camera, const Error& error) {
  const bool own = error.reason == Reason::queue_full || error.reason == Reason::no_answer ||
                   error.reason == Reason::cancelled;
  if (own)  // Of this computer, not of the driver.
    log().warn("camera " + camera.reader->config().name + ": " + error.text);
  else
    camera.reader->report(error, "sensor_refused");
}

void CameraPart::locate(const Camera& camera, const DriverPicture& picture,
                        std::function<void(const std::optional<Pose3>&, Time)> done) {
  const Time received = picture.received;
  call(place_, PlaceQuery{picture.stamp, received}, {.deadline = 200ms},
       [this, &camera, received, done = std::move(done)](const Result<PlaceThen>& place) {
         if (!place) return done(std::nullopt, received);
         if (place->foreign_clock)
           camera.reader->report(
               {Reason::out_of_range,
                "its stamps are far from those of the odometry: pictures get the pose and the age of their "
                "arrival; are both clocks synchronised?"},
               "camera_clock");
         done(place->T_map_base, now() - place->age);
       });
}

}  // namespace adit::agent
