// SPDX-License-Identifier: Apache-2.0
#include "basestation/camera/cameras.hpp"

#include <algorithm>
#include <iterator>

#include "adit/camera.h"
#include "core/contract/camera.hpp"
#include "core/time/random.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {
namespace {

constexpr Duration kThinViewsPeriod = 1s, kViewsPeriod = 400ms;  // Between two messages of what is looked at.
constexpr double kThinLink = 250e3;                              // bit/s
constexpr Duration kFarewell = 1500ms;  // A camera that is no longer looked at is named so for this time.
constexpr Duration kLately = 4s;
constexpr std::uint64_t kShotSalt = std::uint64_t{1} << 33;  // Beside those of content.cpp.
constexpr std::size_t kMaxPictureWaits = 64;
constexpr std::size_t kMaxLately = 4096;

}  // namespace

struct Cameras::Ends {
  wire::Writer<radio::CameraViews> views{};
  std::unique_ptr<wire::RawReader> pieces{};
};

Cameras::Cameras(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
                 const Presence& presence)
    : params_(params),
      strand_(strand),
      radio_(radio),
      fleet_(fleet),
      presence_(presence),
      shots_(static_cast<std::uint32_t>(Random(params.seed).fork(kShotSalt).next())) {}

Cameras::~Cameras() = default;

Result<std::string> Cameras::named(const Robot& robot, const std::string& camera) const {
  const RobotView* view = fleet_.robot(robot);
  if (view == nullptr) return Error{Reason::unknown_robot, robot + " has not been heard"};
  const std::vector<std::string> all = cameras_of(view->sensors);
  if (all.empty() && view->modes.empty())  // Both come with its capabilities.
    return Error{Reason::no_answer, robot + " has not described itself yet; try again in a second"};
  if (all.empty()) return Error{Reason::not_supported, robot + " has no camera"};
  if (camera.empty()) return all.front();
  if (std::ranges::find(all, camera) != all.end()) return camera;
  std::string names;
  for (const std::string& name : all) names += (names.empty() ? "" : ", ") + name;
  return Error{Reason::not_supported, robot + " has no camera " + camera + ": its cameras are " + names};
}

Cameras::Demand Cameras::demand_of(const View& view) const {
  Demand most;
  for (const Demand& demand : view.demands) {
    if (demand.until <= strand_.now()) continue;
    most.width = std::max(most.width, demand.width);
    most.rate = std::max(most.rate, demand.rate);
  }
  return most.width == 0 && view.on ? Demand{.width = kWidth, .rate = kRate} : most;
}

Result<void> Cameras::open() {
  if (ends_) return {};
  auto writer = wire::Writer<radio::CameraViews>::make(radio_, wire::topics::kCameraViews);
  if (!writer) return writer.error();
  auto reader = wire::make_reader(
      radio_, wire::topics::kCamera, strand_,
      [this](const radio::CameraPiece& sample, const wire::SampleInfo& info) { take(sample, info); });
  if (!reader) return reader.error();
  ends_ = std::make_unique<Ends>(Ends{std::move(*writer), std::move(*reader)});
  return {};
}

Result<Cameras::View*> Cameras::view_of(const Robot& robot, const std::string& camera) {
  const auto name = named(robot, camera);
  if (!name) return name.error();
  if (!presence_.up()) return Error{Reason::no_station, "the station is down"};
  const auto known = views_.find({robot, *name});
  if (known != views_.end()) return &known->second;
  if (views_.size() >= kMost)
    return Error{Reason::queue_full, "more than " + std::to_string(kMost) +
                                         " cameras at once: switch one off with `camera R off`"};
  if (const auto opened = open(); !opened) return opened.error();
  return &views_[{robot, *name}];
}

Result<void> Cameras::set_on(const Robot& robot, const std::string& camera, bool on) {
  if (!on) {
    const auto name = named(robot, camera);
    if (!name) return name.error();
    const auto known = views_.find({robot, *name});
    if (known == views_.end()) return {};
    known->second.on = false;
    known->second.demands.clear();
  } else {
    const auto view = view_of(robot, camera);
    if (!view) return view.error();
    (*view)->on = true;
  }
  changed_ = true;
  if (on_change) on_change();
  return {};
}

Result<void> Cameras::look(const Robot& robot, const std::string& camera, std::uint16_t width, float rate) {
  const auto view = view_of(robot, camera);
  if (!view) return view.error();
  const Time now = strand_.now();
  const Demand before = demand_of(**view);
  const Demand wanted{.width = std::clamp<std::uint16_t>(width, 1, contract::CameraView::kMaxWidth),
                      .rate = std::clamp(rate, 0.1F, contract::CameraView::kMaxRate),
                      .until = now + kFrontEnd};
  std::vector<Demand>& demands = (*view)->demands;
  // A front end repeats its demand; one that shows less from now on repeats the lower one, and the other
  // ends.
  std::erase_if(demands, [&](const Demand& each) {
    return each.until <= now || (each.width == wanted.width && each.rate == wanted.rate);
  });
  if (demands.size() >= kMaxDemands) demands.erase(demands.begin());
  demands.push_back(wanted);
  const Demand after = demand_of(**view);
  changed_ = changed_ || after.width != before.width || after.rate != before.rate;
  return {};
}

void Cameras::next(const Robot& robot, const std::string& camera, std::uint64_t after, Taken taken) {
  const auto name = named(robot, camera);
  const auto found = name ? views_.find({robot, *name}) : views_.end();
  if (found == views_.end() || found->second.waiting.size() >= kMaxPictureWaits)
    return taken({.robot = robot, .camera = camera});
  View& view = found->second;
  if (view.newest.number > after) {
    view.newest.age = seconds(strand_.now() - view.exposed);
    return taken(view.newest);
  }
  view.waiting.push_back({after, strand_.now() + kWaits, std::move(taken)});
}

Result<void> Cameras::shoot(const Robot& robot, const std::string& camera, ShotDesk::Done done) {
  const auto name = named(robot, camera);
  if (!name) return name.error();
  const auto awaited = shots_.awaited_cameras();
  const bool known =
      views_.contains({robot, *name}) || std::ranges::find(awaited, Key{robot, *name}) != awaited.end();
  if (!known && views_.size() + awaited.size() >= kMost)
    return Error{Reason::queue_full,
                 "more cameras than can be looked at: switch one off with `camera R off`"};
  if (const auto opened = open(); !opened) return opened.error();
  if (shots_.await(robot, *name, strand_.now(), std::move(done)) == 0)
    return Error{Reason::queue_full, "more pictures than can be awaited at once"};
  changed_ = true;
  return {};
}

Result<void> Cameras::take_shot(const Robot& robot, std::span<const std::uint8_t> bytes) {
  return shots_.take(robot, bytes, strand_.now());
}

void Cameras::take(const radio::CameraPiece& sample, const wire::SampleInfo& info) {
  const auto piece = contract::decode(sample);
  if (!piece || !presence_.up()) return;
  const RobotView* robot = fleet_.robot(piece->robot);
  if (robot == nullptr || robot->participant != info.sender) return;
  const auto found = views_.find({piece->robot, piece->camera});
  if (found == views_.end() || !is_looked_at(found->second)) return;
  const auto picture = perception::decode_picture_piece(piece->data);
  if (!picture) return;
  View& view = found->second;
  const auto& before = view.store.newest();
  const bool other = before && (before->run != picture->header.run || before->frame != picture->header.frame);
  // What lacks of the picture before does not come any more.
  if (other) show(found->first, view);
  if (!view.store.take(*picture)) return;
  view.lately.emplace_back(info.received, piece->data.size());
  while (view.lately.size() > kMaxLately) view.lately.pop_front();
  view.arriving = info.received - std::chrono::milliseconds(picture->header.age);
  const bool last = picture->header.number + 1 == picture->header.pieces;
  if (last || view.store.is_complete()) show(found->first, view);
}

void Cameras::show(const Key& key, View& view) {
  const perception::PictureHeader& header = *view.store.newest();
  if (view.shown == header.frame && view.shown_run == header.run) return;
  view.shown = header.frame;
  view.shown_run = header.run;
  view.exposed = view.arriving;
  view.newest = {.robot = key.first,
                 .camera = key.second,
                 .number = ++pictures_,
                 .jpeg = view.store.as_jpeg(),
                 .width = header.format.width,
                 .height = header.format.height,
                 .colour = header.format.colour,
                 .span = header.format.span,
                 .missing = view.store.missing(),
                 .absent = view.store.absent()};
  if (header.pose) {
    view.newest.pose.assign(header.pose->position.begin(), header.pose->position.end());
    view.newest.pose.insert(view.newest.pose.end(), header.pose->orientation.begin(),
                            header.pose->orientation.end());
  }
  view.pictures.push_back(strand_.now());
  view.newest.age = seconds(strand_.now() - view.exposed);
  for (const Waiting& waiting : std::exchange(view.waiting, {})) waiting.taken(view.newest);
  if (on_change) on_change();
}

std::vector<CameraStatus> Cameras::status(const RobotView& robot) const {
  std::vector<CameraStatus> out;
  for (const std::string& name : cameras_of(robot.sensors)) {
    CameraStatus& status = out.emplace_back(CameraStatus{.name = name});
    const auto found = views_.find({robot.name, name});
    if (found == views_.end()) continue;
    const View& view = found->second;
    status.on = is_looked_at(view);
    status.kept_on = view.on;
    if (!status.on || view.newest.number == 0) continue;
    status.width = view.newest.width;
    status.height = view.newest.height;
    status.age = seconds(strand_.now() - view.exposed);
    std::size_t bytes = 0;
    for (const auto& [at, size] : view.lately) bytes += size;
    status.rate = static_cast<float>(static_cast<double>(view.pictures.size()) / seconds(kLately));
    status.bytes = static_cast<float>(static_cast<double>(bytes) / seconds(kLately));
  }
  return out;
}

void Cameras::tick() {
  if (!ends_) return;
  const Time now = strand_.now();
  shots_.tick(now);
  if (!presence_.up()) {
    shots_.cancel_all();
    for (auto& [key, view] : views_) view.on = false, view.demands.clear();
  }
  bool dropped = false;
  for (auto& [key, view] : views_) {
    while (!view.lately.empty() && now - view.lately.front().first > kLately) view.lately.pop_front();
    while (!view.pictures.empty() && now - view.pictures.front() > kLately) view.pictures.pop_front();
    const auto late = std::stable_partition(view.waiting.begin(), view.waiting.end(),
                                            [&](const Waiting& each) { return each.until > now; });
    // A front end that is answered may ask again.
    std::vector<Waiting> ended(std::make_move_iterator(late), std::make_move_iterator(view.waiting.end()));
    view.waiting.erase(late, view.waiting.end());
    for (const Waiting& each : ended) each.taken({.robot = key.first, .camera = key.second});
    if (is_looked_at(view))
      view.ends = now + kFarewell;
    else
      dropped = dropped || view.ends <= now;
  }
  if (dropped) {
    std::erase_if(views_, [&](const auto& each) {
      return !is_looked_at(each.second) && each.second.ends <= now && each.second.waiting.empty();
    });
    if (on_change) on_change();
  }
  send();
  // A reader that is left costs robots a copy of each picture that others look at.
  if (views_.empty() && shots_.awaited_cameras().empty()) ends_.reset();
}

void Cameras::send() {
  const Time now = strand_.now();
  const wire::LinkProfile* link = radio_.sender().link;
  const Duration period = link != nullptr && link->bandwidth < kThinLink ? kThinViewsPeriod : kViewsPeriod;
  if (!presence_.up() || (!changed_ && now - sent_ < period)) return;
  contract::CameraViews message{.station = params_.name, .station_id = params_.id};
  for (const auto& [key, view] : views_) {
    contract::CameraView& out = message.views.emplace_back(contract::CameraView{
        .robot = key.first, .camera = key.second, .shot = shots_.awaited(key.first, key.second)});
    const Demand demand = demand_of(view);
    out.width = demand.width;
    out.rate = demand.rate;
    shots_.asked(out.shot, now);
    if (const auto& newest = view.store.newest()) {
      out.run = newest->run;
      out.frame = newest->frame;
      out.arrived = view.store.arrived();
      out.missing = view.store.missing(false);
    }
  }
  for (const auto& [robot, camera] : shots_.awaited_cameras())
    if (!views_.contains({robot, camera}) && message.views.size() < contract::CameraViews::kMaxViews) {
      const std::uint32_t number = shots_.awaited(robot, camera);
      shots_.asked(number, now);
      message.views.push_back({.robot = robot, .camera = camera, .shot = number});
    }
  if (message.views.empty()) return;
  sent_ = now;
  changed_ = false;
  (void)ends_->views.write(encode(message));  // Best effort: the next one comes soon.
}

}  // namespace adit::station
