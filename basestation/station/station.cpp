// SPDX-License-Identifier: Apache-2.0
#include "basestation/station/station.hpp"

#include <utility>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "basestation/findings/stairs_report.hpp"
#include "basestation/fleet/summary.hpp"
#include "core/command/words.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

using namespace std::chrono_literals;

namespace {
constexpr Duration kTickPeriod = 100ms;
constexpr Duration kChanges = 20ms;  // Changes within it are reported together.
}  // namespace

Station::Station(StationParams params, Executor& strand, wire::Participant& radio)
    : params_(std::move(params)),
      strand_(strand),
      radio_(radio),
      fleet_(params_.name, params_.id),
      random_(params_.seed),
      presence_(params_, strand, radio, fleet_, random_),
      content_(params_, strand, radio, fleet_, presence_),
      cameras_(params_, strand, radio, fleet_, presence_),
      commands_(params_, strand, radio, fleet_, presence_, content_, cameras_, random_),
      map_view_(strand, content_.chunks(), content_.prior) {}

template <class T, class Take>
Result<void> Station::read(const wire::Topic<T>& topic, Take take) {
  auto reader = wire::make_reader(radio_, topic, strand_, std::move(take));
  if (!reader) return reader.error();
  readers_.push_back(std::move(*reader));
  return {};
}

template <class T>
Result<void> Station::read(const wire::Topic<T>& topic) {
  return read(topic, [this](const T& sample, const wire::SampleInfo& info) {
    fleet_.hear(sample, info);
    changed();
  });
}

Result<void> Station::start() {
  if (!command::valid_name(params_.name))
    return {Reason::bad_argument, "'" + command::clean(params_.name, 40) +
                                      "' cannot be an operator's name "
                                      "(1 to 32 of A-Z a-z 0-9 _ -); choose another --name"};
  observe();
  if (auto opened = presence_.open(); !opened) return opened;
  content_.load_findings();
  const auto answered = [this](const radio::Acknowledgement& sample, const wire::SampleInfo& info) {
    commands_.hear(sample, info);
  };
  for (const Result<void>& opened :
       {read(wire::topics::kAcknowledgement, answered), read(wire::topics::kCapabilities),
        read(wire::topics::kPresence), read(wire::topics::kRobotState), read(wire::topics::kAuthority),
        read(wire::topics::kBehaviour), read(wire::topics::kRoute), read(wire::topics::kNotification),
        read(wire::topics::kHealth), read(wire::topics::kLinkReport)})
    if (!opened) return opened.error();
  if (auto opened = content_.open(); !opened) return opened;
  if (auto started = presence_.start(); !started) return started;
  tick_timer_ = strand_.every(kTickPeriod, [this] { tick(); });
  return {};
}

void Station::observe() {
  fleet_.on_notice = [this](const StoredNotice& notice) {
    if (on_notice) on_notice(notice);
    changed();
  };
  fleet_.on_robot = [this](const RobotView& robot) {
    commands_.prepare(robot.name);
    content_.greet();
    presence_.announce_often();
  };
  content_.on_findings = [this] { changed(); };
  content_.on_shot = [this](const std::string& robot, std::span<const std::uint8_t> bytes) {
    return cameras_.take_shot(robot, bytes);
  };
  cameras_.on_change = [this] { changed(); };
  commands_.on_answer = [this] { changed(); };
  commands_.on_down = [this] {
    if (on_down) on_down();
  };
}

StairsReport Station::stairs() const {
  return stairs_report(content_.desk(), content_.book(), content_.chunks(), fleet_);
}

FoundReport Station::found() const { return content_.found(fleet_, {}); }

World Station::world() const {
  World world = world_of(fleet_, now());
  for (Robot& robot : world.robots)
    if (const RobotView* view = fleet_.robot(robot.name)) robot.cameras = cameras_.status(*view);
  world.link = params_.link;
  world.commands = counts();
  world.findings = content_.finding_counts();
  return world;
}

/// Many samples come together: front ends receive their result once.
void Station::changed() {
  if (change_pending_ || !on_changed) return;
  change_pending_ = true;
  change_timer_ = strand_.after(kChanges, [this] {
    change_pending_ = false;
    on_changed();
  });
}

void Station::tick() {
  fleet_.check(strand_.now());
  for (const auto& [name, robot] : fleet_.robots())
    if (robot.located) radio_.set_place(robot.participant, {robot.x, robot.y, robot.z});
  content_.acknowledge();
  content_.send_marks();
  cameras_.tick();
  commands_.tick();
}

}  // namespace adit::station
