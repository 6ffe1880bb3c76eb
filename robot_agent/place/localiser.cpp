// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/place/localiser.hpp"

#include <algorithm>
#include <utility>

#include "perception/place/recognise.hpp"
#include "perception/place/relocalise.hpp"

namespace adit::agent {
namespace {

constexpr Duration kRecognition = 150ms;  // Duration in rehearsal.
constexpr Duration kSearch = 400ms;       // The same.
constexpr Duration kKeyframe = 5ms;       // The same.
constexpr const char* kUnreadable = "what it saw before cannot be read from its disk";
constexpr std::uint64_t kLongestInDriver = 500'000'000;  // ns; no driver keeps a scan for longer.

/// Of a state of an earlier version: 1 % of the distance from the start, the usual drift of wheels, at least.
double sigma_of(const StoredFrames& stored) {
  constexpr double kUsualDrift = 0.01;
  const double distance = stored.newest ? stored.newest->T_odom_base.position.norm() : 0.0;
  return stored.pose_sigma.value_or(kUsualDrift * distance);
}

}  // namespace

Localiser::Localiser(const AgentParams& params, Executor& strand, Log log, Frames& frames,
                     PlaceMemory& memory, const Notices& notices, Outputs outputs)
    : Component("localiser", strand, std::move(log)),
      params_(params),
      frames_(frames),
      memory_(memory),
      notices_(notices),
      outputs_(std::move(outputs)),
      correction_(params.platform) {}

void Localiser::odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received) {
  protect([&] {
    const Pose3 T_odom_base = localises() ? correction_.apply(odom, stamp) : odom;
    if (!frames_.update(T_odom_base, twist, stamp, received)) {
      correction_.begin_frame(stamp);
      jumped();
    }
    if (waiting_ && !is_ahead(waiting_->stamp)) release_scan();
  });
}

Result<MapFrame> Localiser::correct_map(const MapFrame& corrected) {
  if (const auto taken = frames_.correct(corrected); !taken) return taken.error();
  outputs_.keep();  // Stores at once: the next instance must not use the same epoch for another place.
  return frames_.map_frame();
}

void Localiser::jumped() {
  constexpr Duration kReportAgain = 5s;  // Two drivers that write alternately cause a jump with every sample.
  // Nothing says what the robot did while the agent was away.
  if (memory_.place.pending()) return place_unknown("its odometry began again, too");
  outputs_.frame_began();
  waiting_.reset();  // It was taken in the previous odometry frame.
  outputs_.hold(Reason::odometry_jumped);
  outputs_.keep();  // As in correct_map().
  if (jump_reported_ && now() - *jump_reported_ < kReportAgain) return;
  jump_reported_ = now();
  notices_.odometry_jumped(frames_.T_map_base());
}

Result<void> Localiser::set_pose(const Pose2& pose) {
  if (!frames_.initialised())
    return {Reason::no_localisation, "pose: the driver has not sent any odometry yet"};
  if (health(now()) == Localisation::lost && memory_.place.known()) {
    // What it saw before stays where it is; where it lies from here is unknown.
    frames_.begin_frame();
    outputs_.frame_began();
    waiting_.reset();
    place_set();
  }
  frames_.set_pose(pose);
  correction_.reset_sigma();
  memory_.odometry = correction_.account();
  memory_.place.confirm();
  outputs_.keep();  // As in correct_map().
  return {};
}

void Localiser::restore(const StoredFrames& stored, bool first) {
  frames_.restore(stored);
  if (!localises()) return;
  correction_.restore(stored.T_odom_driver, sigma_of(stored), memory_.odometry);
  if (!stored.recognised)
    memory_.place.refuse();
  else if (memory_.place.pending() || (first && stored.newest))
    memory_.place.begin();
}

void Localiser::compare(const std::shared_ptr<const Scan>& scan) {
  auto keyframes = memory_.keyframes->of(frames_.odom_epoch());
  if (keyframes.empty() && memory_.keyframes->lost() > 0) return place_unknown(kUnreadable);
  memory_.place.compare();
  perception::RecogniseParams recognise{};
  recognise.planar = scan->planar;
  recognise.noise = std::max(recognise.noise, params_.platform.lidar().noise);
  compute(
      {.name = "place", .modelled = kRecognition, .deadline = 5s},
      [scan, keyframes = std::move(keyframes), recognise] {
        return perception::recognise(keyframes, scan->lasting(), scan->located, recognise);
      },
      [this, epoch = frames_.odom_epoch()](const Result<perception::RecognisedPlace>& found) {
        if (memory_.place.pending() && epoch == frames_.odom_epoch()) compared(found);
      });
}

void Localiser::compared(const Result<perception::RecognisedPlace>& found) {
  constexpr int kComparisons = 3;
  if (!found && (found.reason() != Reason::not_localised_here || ++comparisons_ < kComparisons))
    return memory_.place.again();  // The next scan may show more.
  if (!found) return place_unknown(found.error().text);
  switch (found->match) {
    case perception::PlaceMatch::cannot_tell:
      if (!memory_.place.wait_for_better(now()))
        place_unknown(
            "its lidar shows too little to tell: look whether it is covered, dirty, or not turning");
      return;
    case perception::PlaceMatch::nothing_stored:
      if (memory_.keyframes->lost() > 0) return place_unknown(kUnreadable);
      return memory_.place.confirm();
    case perception::PlaceMatch::found:
      memory_.place.confirm();
      correction_.shift(found->correction);
      if (log().on(LogLevel::info)) log().info("the surroundings are as before the restart");
      return;
  }
}

void Localiser::search(const std::shared_ptr<const Scan>& scan) {
  constexpr Duration kAgain = 1s;
  if (!correction_.lost()) {
    not_searched_ = false;
    return agreement_.reset();
  }
  if (!memory_.place.known() || (search_began_ && now() - *search_began_ < kAgain)) return;
  perception::RelocaliseParams search{.moved = correction_.moved(), .planar = scan->planar};
  search.noise = std::max(search.noise, params_.platform.lidar().noise);
  const double sigma = correction_.sigma_seen();
  if (search.moved + 3.0 * sigma > perception::kMaxRelocaliseRadius) {
    if (!std::exchange(not_searched_, true)) notices_.place_not_searched(perception::kMaxRelocaliseRadius);
    return;
  }
  search_began_ = now();
  compute(
      {.name = "search place", .modelled = kSearch, .deadline = 5s},
      [scan, keyframes = memory_.keyframes->of(frames_.odom_epoch()), sigma, search] {
        return perception::relocalise(keyframes, scan->lasting(), scan->located, sigma, search);
      },
      [this, epoch = frames_.odom_epoch(), jumps = scan->jumps, guess = scan->located,
       sigma](const Result<perception::RecognisedPlace>& found) {
        if (epoch == frames_.odom_epoch() && jumps == correction_.jumps()) searched(found, guess, sigma);
      });
}

void Localiser::searched(const Result<perception::RecognisedPlace>& found, const Pose3& guess, double sigma) {
  constexpr double kAlike = 0.1, kAlikeTurn = 0.02;  // What align() leaves, m and rad.
  if (!found || found->match != perception::PlaceMatch::found) return agreement_.reset();
  if (!agreement_.agrees(found->correction, guess, {frames_.odom_epoch(), correction_.jumps()})) return;
  if (log().on(LogLevel::info)) log().info("found its place again by what it saw before");
  correct_odometry(found->correction, std::hypot(sigma, kAlike), kAlikeTurn);
}

void Localiser::correct_odometry(const Pose3& correction, double sigma, double sigma_heading) {
  const auto T_odom_local = correction_.T_odom_local();
  if (!T_odom_local) return;
  // One that failed is lost still, and searches again.
  call(memory_.found_place,
       {correction_.instance(), correction_.steps(), T_odom_local->inverse() * correction * *T_odom_local,
        sigma, sigma_heading},
       {.deadline = 1s}, [](const Result<std::uint32_t>&) {});
}

void Localiser::place_set() {
  if (!correction_.T_odom_local()) return;
  correction_.hold_steps();
  call(memory_.found_place, {.instance = correction_.instance()}, {.deadline = 1s},
       [this](const Result<std::uint32_t>& steps) {
         correction_.release_steps(steps ? std::optional(*steps) : std::nullopt);
       });
}

void Localiser::place_unknown(const std::string& why) {
  memory_.place.refuse();
  frames_.begin_frame();  // What was stored in the odometry frame may be elsewhere now.
  outputs_.frame_began();
  waiting_.reset();
  outputs_.hold(Reason::not_localised_here);
  outputs_.keep();
  notices_.not_localised_here(frames_.T_map_base(), why);
}

void Localiser::scan(LidarScan lidar) {
  protect([&] {
    if (!frames_.initialised()) return;
    if (waiting_) release_scan();
    waiting_ = std::move(lidar);
    if (!is_ahead(waiting_->stamp)) release_scan();
  });
}

bool Localiser::is_ahead(std::uint64_t stamp) const {
  constexpr std::uint64_t kLongest = 200'000'000;  // In ns; a stamp farther ahead is from another clock.
  const std::uint64_t newest = frames_.newest_stamp();
  return newest != 0 && stamp > newest && stamp - newest <= kLongest;
}

void Localiser::release_scan() {
  LidarScan waiting = *std::exchange(waiting_, std::nullopt);
  if (waiting.odometry) {
    correction_.take(*waiting.odometry, now());
    memory_.odometry = correction_.account();
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
  if (health(now()) == Localisation::ok) scan->movers = outputs_.movers();
  if (memory_.place.waits() && paired) compare(scan);
  if (waiting.odometry && located) search(scan);
  if (recognised() && health(now()) == Localisation::ok) make_keyframe(scan);
  outputs_.scan(std::move(scan), waiting);
}

void Localiser::make_keyframe(const std::shared_ptr<const Scan>& scan) {
  if (!memory_.keyframes->wants(scan->located.position, frames_.odom_epoch())) return;
  compute(
      {.name = "make keyframe", .modelled = kKeyframe, .latest_only = true},
      [scan, epoch = frames_.odom_epoch()] {
        return perception::make_keyframe(scan->lasting(), scan->located, epoch, scan->planar);
      },
      [this](Result<perception::Keyframe> keyframe) {
        if (keyframe) memory_.keyframes->add(std::move(*keyframe));
      });
}

StoredFrames Localiser::stored() const {
  StoredFrames place = frames_.stored();
  if (localises()) {
    place.T_odom_driver = correction_.T_odom_driver();
    place.pose_sigma = correction_.sigma();
  }
  place.recognised = !memory_.place.refused();
  return place;
}

Reason Localiser::unknown_because(Time at) const {
  if (!memory_.place.known()) return memory_.place.why();
  return health(at) == Localisation::lost ? Reason::localisation_lost : Reason::none;
}

Localisation Localiser::health(Time at) const {
  if (!localises()) return Localisation::off;
  if (memory_.place.known()) return correction_.health(at);
  return memory_.place.refused() ? Localisation::lost : Localisation::starting;
}

double Localiser::sigma() const {
  if (memory_.place.refused()) return std::numeric_limits<double>::infinity();
  return localises() ? correction_.sigma() : 0.0;
}

void Localiser::watch(Time at) {
  if (!memory_.place.known()) return;  // That was reported.
  // A robot that passes a smooth wall is weak for a moment, which the operator need not know.
  constexpr Duration kWeakFor = 3s;
  const Localisation health = this->health(at);
  if (health == reported_ || health == Localisation::starting || health == Localisation::off) {
    changed_at_ = at;
    return;
  }
  if (health != Localisation::lost && at - changed_at_ < kWeakFor) return;
  const bool first = reported_ == Localisation::starting;
  reported_ = health;
  changed_at_ = at;
  if (!(first && health == Localisation::ok)) notices_.localisation(health, correction_.sigma());
}

}  // namespace adit::agent
