// SPDX-License-Identifier: Apache-2.0
// Where the robot is: odometry, scans, the map, and the pose after a restart.
#include <algorithm>
#include <limits>

#include "perception/place/recognise.hpp"
#include "perception/place/relocalise.hpp"
#include "robot_agent/command_component.hpp"

namespace adit::agent {
namespace {

constexpr Duration kRecognition = 150ms;  // Duration in rehearsal.
constexpr Duration kSearch = 400ms;       // The same.
constexpr Duration kKeyframe = 5ms;       // The same.
constexpr const char* kUnreadable = "what it saw before cannot be read from its disk";
constexpr std::uint64_t kLongestInDriver = 500'000'000;  // ns; no driver keeps a scan for longer.
constexpr Duration kLookAhead = 1s;  // Between two updates of what stations should get first.

/// Of a state of an earlier version: 1 % of the distance from the start, the usual drift of wheels, at least.
double sigma_of(const StoredFrames& stored) {
  constexpr double kUsualDrift = 0.01;
  const double distance = stored.newest ? stored.newest->T_odom_base.position.norm() : 0.0;
  return stored.pose_sigma.value_or(kUsualDrift * distance);
}

}  // namespace

void Agent::CommandComponent::odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp,
                                       Time received) {
  protect([&] {
    const Pose3 T_odom_base = localises() ? correction_.apply(odom, stamp) : odom;
    if (!frames_.update(T_odom_base, twist, stamp, received)) {
      correction_.begin_frame(stamp);
      odometry_jumped();
    }
    if (waiting_scan_ && !is_ahead(waiting_scan_->stamp)) add_waiting_scan();
  });
}

Result<MapFrame> Agent::CommandComponent::correct_map(const MapFrame& corrected) {
  if (const auto taken = frames_.correct(corrected); !taken) return taken.error();
  keep();  // Stores at once: the next instance must not use the same epoch for another place.
  return frames_.map_frame();
}

void Agent::CommandComponent::odometry_jumped() {
  constexpr Duration kReportAgain = 5s;  // Two drivers that write alternately cause a jump with every sample.
  // Nothing says what the robot did while the agent was away.
  if (context_.place.pending()) return place_unknown("its odometry began again, too");
  navigation_.clear();
  waiting_scan_.reset();  // It was taken in the previous odometry frame.
  behaviour_.hold(Reason::odometry_jumped, now());
  keep();  // As in correct_map().
  if (jump_reported_ && now() - *jump_reported_ < kReportAgain) return;
  jump_reported_ = now();
  notices_.odometry_jumped(frames_.T_map_base());
}

Result<void> Agent::CommandComponent::set_pose(const Pose2& pose) {
  if (!frames_.initialised())
    return {Reason::no_localisation, "pose: the driver has not sent any odometry yet"};
  if (localisation(now()) == Localisation::lost && context_.place.known()) {
    // What it saw before stays where it is; where it lies from here is unknown.
    frames_.begin_frame();
    navigation_.clear();
    waiting_scan_.reset();
    place_set();
  }
  frames_.set_pose(pose);
  correction_.reset_sigma();
  context_.odometry = correction_.account();
  context_.place.confirm();
  keep();  // As in correct_map().
  return {};
}

void Agent::CommandComponent::restore_place(const StoredFrames& stored) {
  frames_.restore(stored);
  if (!localises()) return;
  correction_.restore(stored.T_odom_driver, sigma_of(stored), context_.odometry);
  if (!stored.recognised)
    context_.place.refuse();
  else if (context_.place.pending() || (context_.instances == 1 && stored.newest))
    context_.place.begin();
}

void Agent::CommandComponent::compare_place(const std::shared_ptr<const Scan>& scan) {
  auto keyframes = context_.keyframes->of(frames_.odom_epoch());
  if (keyframes.empty() && context_.keyframes->lost() > 0) return place_unknown(kUnreadable);
  context_.place.compare();
  perception::RecogniseParams recognise{};
  recognise.planar = scan->planar;
  recognise.noise = std::max(recognise.noise, params_.platform.lidar().noise);
  compute(
      {.name = "place", .modelled = kRecognition, .deadline = 5s},
      [scan, keyframes = std::move(keyframes), recognise] {
        return perception::recognise(keyframes, scan->lasting(), scan->located, recognise);
      },
      [this, epoch = frames_.odom_epoch()](const Result<perception::RecognisedPlace>& found) {
        if (context_.place.pending() && epoch == frames_.odom_epoch()) place_compared(found);
      });
}

void Agent::CommandComponent::place_compared(const Result<perception::RecognisedPlace>& found) {
  constexpr int kComparisons = 3;
  if (!found && (found.reason() != Reason::not_localised_here || ++comparisons_ < kComparisons))
    return context_.place.again();  // The next scan may show more.
  if (!found) return place_unknown(found.error().text);
  switch (found->match) {
    case perception::PlaceMatch::cannot_tell:
      if (!context_.place.wait_for_better(now()))
        place_unknown(
            "its lidar shows too little to tell: look whether it is covered, dirty, or not turning");
      return;
    case perception::PlaceMatch::nothing_stored:
      if (context_.keyframes->lost() > 0) return place_unknown(kUnreadable);
      return context_.place.confirm();
    case perception::PlaceMatch::found:
      context_.place.confirm();
      correction_.shift(found->correction);
      if (log().on(LogLevel::info)) log().info("the surroundings are as before the restart");
      return;
  }
}

void Agent::CommandComponent::search_place(const std::shared_ptr<const Scan>& scan) {
  constexpr Duration kAgain = 1s;
  if (!correction_.lost()) {
    not_searched_ = false;
    return found_.reset();
  }
  if (!context_.place.known() || (searched_ && now() - *searched_ < kAgain)) return;
  perception::RelocaliseParams search{.moved = correction_.moved(), .planar = scan->planar};
  search.noise = std::max(search.noise, params_.platform.lidar().noise);
  const double sigma = correction_.sigma_seen();
  if (search.moved + 3.0 * sigma > perception::kMaxRelocaliseRadius) {
    if (!std::exchange(not_searched_, true)) notices_.place_not_searched(perception::kMaxRelocaliseRadius);
    return;
  }
  searched_ = now();
  compute(
      {.name = "search place", .modelled = kSearch, .deadline = 5s},
      [scan, keyframes = context_.keyframes->of(frames_.odom_epoch()), sigma, search] {
        return perception::relocalise(keyframes, scan->lasting(), scan->located, sigma, search);
      },
      [this, epoch = frames_.odom_epoch(), jumps = scan->jumps, guess = scan->located,
       sigma](const Result<perception::RecognisedPlace>& found) {
        if (epoch == frames_.odom_epoch() && jumps == correction_.jumps()) place_found(found, guess, sigma);
      });
}

void Agent::CommandComponent::place_found(const Result<perception::RecognisedPlace>& found,
                                          const Pose3& guess, double sigma) {
  constexpr double kAlike = 0.1, kAlikeTurn = 0.02;  // What align() leaves, m and rad.
  if (!found || found->match != perception::PlaceMatch::found) return found_.reset();
  if (!found_.agrees(found->correction, guess, {frames_.odom_epoch(), correction_.jumps()})) return;
  if (log().on(LogLevel::info)) log().info("found its place again by what it saw before");
  correct_odometry(found->correction, std::hypot(sigma, kAlike), kAlikeTurn);
}

void Agent::CommandComponent::correct_odometry(const Pose3& correction, double sigma, double sigma_heading) {
  const auto T_odom_local = correction_.T_odom_local();
  if (!T_odom_local) return;
  // One that failed is lost still, and searches again.
  call(context_.found_place,
       {correction_.instance(), correction_.steps(), T_odom_local->inverse() * correction * *T_odom_local,
        sigma, sigma_heading},
       {.deadline = 1s}, [](const Result<std::uint32_t>&) {});
}

void Agent::CommandComponent::place_set() {
  if (!correction_.T_odom_local()) return;
  correction_.hold_steps();
  call(context_.found_place, {.instance = correction_.instance()}, {.deadline = 1s},
       [this](const Result<std::uint32_t>& steps) {
         correction_.release_steps(steps ? std::optional(*steps) : std::nullopt);
       });
}

void Agent::CommandComponent::place_unknown(const std::string& why) {
  context_.place.refuse();
  frames_.begin_frame();  // What was stored in the odometry frame may be elsewhere now.
  navigation_.clear();
  waiting_scan_.reset();
  behaviour_.hold(Reason::not_localised_here, now());
  keep();
  notices_.not_localised_here(frames_.T_map_base(), why);
}

void Agent::CommandComponent::scan(LidarScan lidar) {
  protect([&] {
    if (!frames_.initialised()) return;
    if (waiting_scan_) add_waiting_scan();
    waiting_scan_ = std::move(lidar);
    if (!is_ahead(waiting_scan_->stamp)) add_waiting_scan();
  });
}

bool Agent::CommandComponent::is_ahead(std::uint64_t stamp) const {
  constexpr std::uint64_t kLongest = 200'000'000;  // In ns; a stamp farther ahead is from another clock.
  const std::uint64_t newest = frames_.newest_stamp();
  return newest != 0 && stamp > newest && stamp - newest <= kLongest;
}

void Agent::CommandComponent::add_waiting_scan() {
  LidarScan waiting = *std::exchange(waiting_scan_, std::nullopt);
  if (waiting.odometry) {
    correction_.take(*waiting.odometry, now());
    context_.odometry = correction_.account();
  }
  auto scan = std::make_shared<Scan>();
  scan->points = std::move(*waiting.points);
  scan->planar = waiting.planar;
  scan->isolated = std::move(waiting.isolated);
  scan->parts = std::move(waiting.parts);
  const auto T_odom_base = frames_.T_odom_base_at(waiting.stamp);
  // Without a common clock the newest pose is the best guess. With another clock one of that stamp is of long
  // ago.
  const bool paired = T_odom_base && frames_.newest_stamp() - waiting.stamp <= kLongestInDriver;
  scan->body = paired ? *T_odom_base : frames_.T_odom_base();
  // The yaw is the odometry's; how the body leans the IMU knows better.
  if (waiting.attitude) scan->body = perception::with_attitude(scan->body, *waiting.attitude);
  const auto located = waiting.odometry ? correction_.located(*waiting.odometry) : std::nullopt;
  scan->located = located.value_or(scan->body);
  scan->jumps = correction_.jumps();
  // A pose that is being corrected moves everything.
  if (localisation(now()) == Localisation::ok) scan->movers = navigation_.movers(now());
  if (context_.place.waits() && paired) compare_place(scan);
  if (waiting.odometry && located) search_place(scan);
  if (waiting.odometry) watch_grip(*waiting.odometry, now());
  if (context_.place.known()) add_to_map(scan);
  navigation_.add_scan(std::move(scan), waiting.received, now(), team(now()));
}

void Agent::CommandComponent::make_keyframe(const std::shared_ptr<const Scan>& scan) {
  if (!context_.keyframes->wants(scan->located.position, frames_.odom_epoch())) return;
  compute(
      {.name = "make keyframe", .modelled = kKeyframe, .latest_only = true},
      [scan, epoch = frames_.odom_epoch()] {
        return perception::make_keyframe(scan->lasting(), scan->located, epoch, scan->planar);
      },
      [this](Result<perception::Keyframe> keyframe) {
        if (keyframe) context_.keyframes->add(std::move(*keyframe));
      });
}

void Agent::CommandComponent::add_to_map(const std::shared_ptr<const Scan>& scan) {
  const Localisation health = localisation(now());
  if (health == Localisation::ok) make_keyframe(scan);
  // A map made by a pose that is lost would be wrong for ever.
  if (!context_.map || health == Localisation::lost || health == Localisation::starting) return;
  auto job = context_.map->job(scan, team(now()), frames_.odom_epoch(), now());
  if (!job) return;
  call(context_.map_insertion, std::move(job), {.deadline = 2s},
       [this](const Result<MapStep>& step) { context_.map->taken(step, frames_.map_frame()); });
}

void Agent::CommandComponent::send_content() {
  if (context_.map && frames_.initialised()) {
    context_.map->follow(frames_.map_frame());
    if (context_.map->is_behind() && now() - looked_ahead_ >= kLookAhead) {
      looked_ahead_ = now();
      contract::Route route = followed_route(now());
      if (route.points.empty()) route.points.push_back(frames_.to_map(frames_.T_odom_base().position));
      context_.map->look_ahead(route.points);
    }
  }
  if (context_.content->needs_carriers(now()) && context_.peers.carrier_present())
    context_.radio->reach_carriers();
  send_pieces();
}

void Agent::CommandComponent::send_pieces() {
  protect([&] {
    const wire::SenderState link = context_.wire->sender();
    for (const transfer::Piece& piece : context_.content->due(now(), link))
      context_.radio->send(piece, context_.content->session());
    if (!context_.carrier) return;
    if (const auto receipts = context_.carrier->due(now(), link.link != nullptr ? link.link->bandwidth : 0.0))
      context_.radio->send(context_.carrier->id(), *receipts);
  });
}

StoredFrames Agent::CommandComponent::stored_place() const {
  StoredFrames place = frames_.stored();
  if (localises()) {
    place.T_odom_driver = correction_.T_odom_driver();
    place.pose_sigma = correction_.sigma();
  }
  place.recognised = !context_.place.refused();
  return place;
}

Localisation Agent::CommandComponent::localisation(Time at) const {
  if (!localises()) return Localisation::off;
  if (context_.place.known()) return correction_.health(at);
  return context_.place.refused() ? Localisation::lost : Localisation::starting;
}

double Agent::CommandComponent::place_sigma() const {
  if (context_.place.refused()) return std::numeric_limits<double>::infinity();
  return localises() ? correction_.sigma() : 0.0;
}

void Agent::CommandComponent::watch_grip(const OdometryReport& report, Time at) {
  if (std::exchange(modes_seen_, behaviour_.modes_begun()) != behaviour_.modes_begun()) grip_.begin_mode();
  const auto event = grip_.note(report.wheels_slip, report.T_local_base.position, at);
  if (event == GripWatch::Event::slips) notices_.wheels_slip(params_.platform.flies());
  if (event != GripWatch::Event::stuck || !behaviour_.mode().autonomous()) return;
  behaviour_.hold(Reason::stuck, at);
  notices_.stuck();
}

void Agent::CommandComponent::watch_localisation(Time at) {
  if (!context_.place.known()) return;  // That was reported.
  // A robot that passes a smooth wall is weak for a moment, which the operator need not know.
  constexpr Duration kWeakFor = 3s;
  const Localisation health = localisation(at);
  if (health == reported_localisation_ || health == Localisation::starting || health == Localisation::off) {
    localisation_since_ = at;
    return;
  }
  if (health != Localisation::lost && at - localisation_since_ < kWeakFor) return;
  const bool first = reported_localisation_ == Localisation::starting;
  reported_localisation_ = health;
  localisation_since_ = at;
  if (!(first && health == Localisation::ok)) notices_.localisation(health, correction_.sigma());
}

}  // namespace adit::agent
