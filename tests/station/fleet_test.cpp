// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/fleet.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "adit/authority.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "basestation/model/json.hpp"
#include "basestation/report/json.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr Id kOwnId{1};

wire::SampleInfo at(Duration when) { return {.sender = {9}, .received = Time(when)}; }

radio::RobotState state(const std::string& robot) {
  radio::RobotState sample;
  sample.robot(robot);
  sample.x(1.5F);
  sample.battery(0.5F);
  return sample;
}

std::vector<std::string> codes(const Fleet& fleet) {
  std::vector<std::string> out;
  for (const StoredNotice& notice : fleet.notices()) out.push_back(notice.code);
  return out;
}

radio::ComponentHealth component(const std::string& name, radio::ComponentState state, bool healthy) {
  radio::ComponentHealth part;
  part.name(name);
  part.state(state);
  part.healthy(healthy);
  part.restarts(3);
  part.hung(1);
  part.text("a crash");
  return part;
}

radio::AuthorityStatus authority(std::uint64_t start) {
  radio::AuthorityStatus sample;
  sample.robot("r1");
  sample.epoch().start(start);
  return sample;
}

TEST(Fleet, OfTwoRobotsWithOneNameTheFirstIsShown) {
  Fleet fleet("op1", kOwnId);
  const wire::ParticipantId first{9}, second{10};
  for (int i = 0; i < 100; ++i) {
    const Time now{100ms * i};
    fleet.hear(authority(1), {.sender = first, .received = now});
    if (i >= 50) fleet.hear(authority(2), {.sender = second, .received = now + 20ms});
    EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U) << i;
  }
  EXPECT_TRUE(fleet.speaks_for("r1", first));
  EXPECT_FALSE(fleet.speaks_for("r1", second));
  // What both say to operators is shown.
  radio::Notification notification;
  notification.robot("r1");
  notification.code("name_taken");
  fleet.hear(notification, {.sender = second, .received = Time(10s)});
  EXPECT_THAT(codes(fleet), ElementsAre("name_taken"));
}

TEST(Fleet, ARobotThatGivesWayIsNotShownWhileTheOtherIsOutOfRange) {
  Fleet fleet("op1", kOwnId);
  const wire::ParticipantId first{9}, second{10};
  radio::Capabilities gives_way;
  gives_way.name("r1");
  gives_way.kind(radio::AGENT_ROBOT);
  gives_way.services({"route", "name_taken:free:0000000000000002"});
  fleet.hear(authority(1), {.sender = first, .received = Time(0s)});
  fleet.hear(gives_way, {.sender = second, .received = Time(100ms)});
  for (int i = 1; i < 50; ++i) fleet.hear(authority(2), {.sender = second, .received = Time(1s * i)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U);
  fleet.hear(authority(2), {.sender = second, .received = Time(61s)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 2U);
  fleet.hear(authority(1), {.sender = first, .received = Time(62s)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U);
}

TEST(Fleet, AForgerIsShownOnlyWhileTheRobotIsSilent) {
  Fleet fleet("op1", kOwnId);
  const wire::ParticipantId robot{9}, forger{10};
  fleet.hear(authority(1), {.sender = robot, .received = Time(0s)});
  fleet.hear(authority(2), {.sender = forger, .received = Time(900ms)});  // as a restart would
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 2U);
  fleet.hear(authority(1), {.sender = robot, .received = Time(1s)});  // may be a late sample
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 2U);
  fleet.hear(authority(1), {.sender = robot, .received = Time(2s)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U);
  fleet.hear(authority(2), {.sender = forger, .received = Time(4s)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U);
}

TEST(Fleet, ManyParticipantsWithOneNameAreBounded) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(authority(1), {.sender = {9}, .received = Time(0s)});
  for (std::uint8_t i = 10; i < 60; ++i) fleet.hear(authority(i), {.sender = {i}, .received = Time(10ms)});
  EXPECT_EQ(fleet.robot("r1")->epoch.start, 1U);
  EXPECT_GT(fleet.ignored(), 0U);
}

TEST(Fleet, HealthNamesWhatIsNotUp) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(state("r1"), at(0s));
  radio::Health health;
  health.robot("r1");
  health.components({component("command", radio::COMPONENT_UP, true),
                     component("planner", radio::COMPONENT_HUNG, false),
                     component("odd", static_cast<radio::ComponentState>(77), false)});
  fleet.hear(health, at(0s));
  const RobotView& robot = *fleet.robot("r1");
  ASSERT_EQ(robot.components.size(), 3u);
  EXPECT_EQ(robot.components[1].state, PartState::hung);
  EXPECT_EQ(robot.components[1].hung, 1u);
  EXPECT_EQ(robot.components[2].state, PartState::failed) << "a state of a later version";
  EXPECT_THAT(health_text(health_report({&robot})), testing::HasSubstr("HUNG"));
  EXPECT_THAT(json_of(health_report({&robot}))["robots"][0]["components"][0]["policy"], "manual");
  EXPECT_THAT(json_of(described(robot, Time{}))["troubles"], testing::SizeIs(2));
}

TEST(Fleet, RobotIsLostWithinThreeSecondsAndBackAtTheNextState) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(state("r1"), at(1s));
  fleet.check(Time(3500ms));
  EXPECT_FALSE(fleet.robot("r1")->lost);
  fleet.check(Time(3501ms));
  EXPECT_TRUE(fleet.robot("r1")->lost);
  fleet.check(Time(9s));
  fleet.hear(state("r1"), at(10s));
  EXPECT_FALSE(fleet.robot("r1")->lost);
  EXPECT_THAT(codes(fleet), ElementsAre("lost", "back"));
}

TEST(Fleet, OnAFullLinkASignOfLifeIsEnoughNotToBeLost) {
  Fleet fleet("op1", kOwnId);
  radio::Presence presence;
  presence.name("r1");
  presence.kind(radio::AGENT_ROBOT);
  fleet.hear(presence, at(1s));
  EXPECT_EQ(fleet.robot("r1"), nullptr);
  fleet.hear(state("r1"), at(1s));
  fleet.hear(presence, at(3s));
  fleet.check(Time(5500ms));
  EXPECT_FALSE(fleet.robot("r1")->lost);
  wire::SampleInfo another = at(5s);
  another.sender = {99};
  fleet.hear(presence, another);
  fleet.check(Time(5501ms));
  EXPECT_TRUE(fleet.robot("r1")->lost);
}

TEST(Fleet, ARouteIsWhatTheRobotFollowsUntilItSaysOtherwise) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(state("r1"), at(1s));
  radio::Route route;
  route.robot("r1");
  route.goal_id(4);
  route.corners(3);
  route.from({1.0F, 2.0F, 0.5F});
  route.points({30, 0, 0, 30, -40, 5});
  route.unknown(2);
  fleet.hear(route, at(1s));
  const contract::Route& heard = fleet.robot("r1")->route;
  ASSERT_EQ(heard.points.size(), 3U);
  EXPECT_FLOAT_EQ(heard.points[2][0], 4.0F);
  EXPECT_FLOAT_EQ(heard.points[2][1], -2.0F);
  EXPECT_FLOAT_EQ(heard.points[2][2], 1.0F);
  EXPECT_EQ(heard.unknown, 2U);
  route.from({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  fleet.hear(route, at(2s));
  EXPECT_TRUE(fleet.robot("r1")->route.points.empty()) << "a route from nowhere is none";
  // The wire does not check the bound of the sequence.
  route.from({0, 0, 0});
  route.points(std::vector<std::int16_t>(230, 7));
  fleet.hear(route, at(2s));
  EXPECT_EQ(fleet.robot("r1")->route.points.size(), contract::Route::kMaxCorners);
  route.corners(0);
  route.points({});
  fleet.hear(route, at(3s));
  EXPECT_TRUE(fleet.robot("r1")->route.points.empty());
}

TEST(Fleet, ObserverIsCalledOncePerRobot) {
  Fleet fleet("op1", kOwnId);
  int calls = 0;
  fleet.on_robot = [&](const RobotView& robot) { calls += robot.name == "r1"; };
  radio::Capabilities capabilities;
  capabilities.name("r1");
  capabilities.platform("legged");
  fleet.hear(capabilities, at(0s));
  fleet.hear(state("r1"), at(0s));
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(fleet.robot("r1")->platform, "legged");
}

TEST(Fleet, HolderIsNameAndId) {
  Fleet fleet("op1", kOwnId);
  radio::AuthorityStatus status;
  status.robot("r1");
  status.holder("op1");
  status.holder_id({2});
  fleet.hear(status, at(0s));
  EXPECT_FALSE(fleet.robot("r1")->mine);
  status.holder_id(kOwnId);
  fleet.hear(status, at(0s));
  EXPECT_TRUE(fleet.robot("r1")->mine);
}

TEST(Fleet, AnAcknowledgementIsNewerThanALateStatus) {
  Fleet fleet("op1", kOwnId);
  radio::AuthorityStatus late;
  late.robot("r1");
  late.holder("op2");
  late.epoch().start(7);
  late.epoch().counter(3);
  fleet.hear(late, at(0s));
  fleet.learn_authority("r1", "op1", {7, 4});
  fleet.hear(late, at(0s));
  EXPECT_EQ(fleet.robot("r1")->holder, "op1");
  EXPECT_EQ(fleet.robot("r1")->epoch, (Epoch{7, 4}));
  late.epoch().start(8);  // another start of the agent starts over
  late.epoch().counter(0);
  fleet.hear(late, at(0s));
  EXPECT_EQ(fleet.robot("r1")->holder, "op2");
}

TEST(Fleet, NamesAndNumbersAreBounded) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(state("bad name"), at(0s));
  fleet.hear(state("\x1b[2J"), at(0s));
  for (int i = 0; i < 100; ++i) fleet.hear(state("r" + std::to_string(i)), at(0s));
  EXPECT_EQ(fleet.robots().size(), Fleet::kMaxRobots);
  EXPECT_EQ(fleet.ignored(), 2 + 100 - Fleet::kMaxRobots);
  for (int i = 0; i < 100; ++i) {
    radio::Presence presence;
    presence.kind(radio::AGENT_STATION);
    presence.name("op" + std::to_string(i + 10));
    fleet.hear(presence, at(0s));
  }
  EXPECT_EQ(fleet.stations().size(), Fleet::kMaxStations);
}

TEST(Fleet, ARobotThatIsNamedLikeAWordOfTheGrammarIsIgnored) {
  Fleet fleet("op1", kOwnId);
  for (const char* name : {"all", "--override", "-r1"}) {
    radio::RobotState sample;
    sample.robot(name);
    fleet.hear(sample, at(0s));
  }
  EXPECT_TRUE(fleet.robots().empty());
  EXPECT_EQ(fleet.ignored(), 3U);
}

TEST(Fleet, NoticesKeepTheLastTwoHundredAndKnowWhomTheyConcern) {
  Fleet fleet("op1", kOwnId);
  radio::Notification sample;
  sample.robot("r1");
  for (int i = 0; i < 300; ++i) {
    sample.operator_name(i % 2 == 0 ? "op1" : "op2");
    sample.text("t" + std::to_string(i));
    fleet.hear(sample, at(0s));
  }
  ASSERT_EQ(fleet.notices().size(), Fleet::kMaxNotices);
  EXPECT_EQ(fleet.notices().front().text, "t100");
  EXPECT_TRUE(fleet.notices().front().mine);
  EXPECT_FALSE(fleet.notices().back().mine);
}

TEST(Fleet, EveryNoticeHasAnIdThatStays) {
  Fleet fleet("op1", kOwnId);
  std::vector<std::uint64_t> seen;
  fleet.on_notice = [&](const Notice& notice) { seen.push_back(notice.id); };
  radio::Notification sample;
  sample.robot("r1");
  sample.code("stopped");
  sample.stamp(to_stamp(Time(1000s)));
  for (std::size_t i = 0; i < Fleet::kMaxNotices + 2; ++i) fleet.hear(sample, at(0s));  // all the same
  fleet.hear(state("r1"), at(1s));                                                      // dates them
  ASSERT_EQ(seen.size(), Fleet::kMaxNotices + 2);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
  EXPECT_EQ(fleet.notices().front().id, 3U) << "the first two made room";
  EXPECT_EQ(json_of(described(fleet.notices().back(), Time(2s)))["id"], seen.back());
  EXPECT_EQ(json_of(described(fleet.notices().back(), Time(9s)))["id"], seen.back());
}

/// r1's clock is 1000 s ahead of this station's.
radio::RobotState stamped_state(Duration here) {
  radio::RobotState sample = state("r1");
  sample.stamp(to_stamp(Time(here + 1000s)));
  return sample;
}

radio::Notification arisen(Duration here) {
  radio::Notification sample;
  sample.robot("r1");
  sample.code("stopped");
  sample.stamp(to_stamp(Time(here + 1000s)));
  return sample;
}

double newest_age(const Fleet& fleet, Duration now) {
  return described(fleet.notices().back(), Time(now)).age;
}

TEST(Fleet, ANoticeThatComesAfterAGapIsAsOldAsItIs) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(stamped_state(100s), at(100s));
  fleet.hear(arisen(100s), at(100s));
  EXPECT_DOUBLE_EQ(newest_age(fleet, 100s), 0.0);
  fleet.check(Time(110s));
  fleet.hear(arisen(120s), at(300s));  // repeated by the wire, before the first state after the gap
  EXPECT_DOUBLE_EQ(newest_age(fleet, 300s), 180.0);
  EXPECT_DOUBLE_EQ(newest_age(fleet, 310s), 190.0);
}

TEST(Fleet, ANoticeBeforeTheFirstStateIsDatedByIt) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(arisen(40s), at(100s));
  EXPECT_DOUBLE_EQ(newest_age(fleet, 100s), 0.0);  // not known yet
  fleet.hear(stamped_state(101s), at(101s));
  EXPECT_DOUBLE_EQ(newest_age(fleet, 101s), 61.0);
  fleet.hear(stamped_state(150s), at(150s));
  EXPECT_DOUBLE_EQ(newest_age(fleet, 150s), 110.0);
}

TEST(Fleet, AnotherStartOfARobotMayHaveAnotherClock) {
  Fleet fleet("op1", kOwnId);
  fleet.hear(stamped_state(100s), at(100s));
  radio::Notification sample = arisen(0s);
  sample.stamp(to_stamp(Time(5s)));  // its computer was restarted
  fleet.hear(sample, {.sender = {10}, .received = Time(200s)});
  EXPECT_DOUBLE_EQ(newest_age(fleet, 200s), 0.0);
  radio::RobotState after = state("r1");
  after.stamp(to_stamp(Time(8s)));
  fleet.hear(after, {.sender = {10}, .received = Time(201s)});
  EXPECT_DOUBLE_EQ(newest_age(fleet, 201s), 3.0);
}

TEST(Fleet, WhatARobotClaimsOfTheTimeStaysWithinBounds) {
  for (const std::uint64_t stamp :
       {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
    Fleet fleet("op1", kOwnId);
    fleet.hear(stamped_state(1s), at(1s));
    radio::Notification sample = arisen(0s);
    sample.stamp(stamp);
    fleet.hear(sample, at(1s));
    EXPECT_GE(newest_age(fleet, 1s), 0.0) << stamp;
    EXPECT_LE(newest_age(fleet, 1s), 240.0 * 3600.0) << stamp;
  }
}

TEST(Ages, AreShortAndReadable) {
  EXPECT_EQ(short_age(59.0), "59s");
  EXPECT_EQ(short_age(180.0), "3m");
  EXPECT_EQ(short_age(1e5), "28h");
  EXPECT_EQ(short_age(std::nan("")), "-");
  EXPECT_EQ(ago(2.0), "");
  EXPECT_EQ(ago(12.0), "12 s ago");
  EXPECT_EQ(ago(180.0), "3 min ago");
  EXPECT_EQ(ago(1e5), "28 h ago");
}

TEST(Fleet, TextFromTheRadioIsMadeSafe) {
  Fleet fleet("op1", kOwnId);
  radio::Notification sample;
  sample.robot("r1");
  sample.text("a\x1b]0;owned\x07" + std::string(1000, 'x'));
  sample.severity(static_cast<radio::Severity>(77));
  fleet.hear(sample, at(0s));
  EXPECT_EQ(fleet.notices().back().text.find('\x1b'), std::string::npos);
  EXPECT_LE(fleet.notices().back().text.size(), 240U);
  EXPECT_EQ(fleet.notices().back().severity, Severity::error);
}

TEST(Fleet, AnotherStationWithOurNameIsReportedOnceAMinute) {
  Fleet fleet("op1", kOwnId);
  radio::Presence presence;
  presence.kind(radio::AGENT_STATION);
  presence.name("op1");
  presence.id({3});
  for (int i = 0; i < 10; ++i) fleet.hear(presence, at(std::chrono::seconds(i)));
  EXPECT_THAT(codes(fleet), ElementsAre("name_in_use"));
  presence.id(kOwnId);  // ourselves, or our own former participant
  fleet.hear(presence, at(11s));
  EXPECT_TRUE(fleet.stations().empty());
}

TEST(Fleet, SilentStationsAreForgotten) {
  Fleet fleet("op1", kOwnId);
  radio::Presence presence;
  presence.kind(radio::AGENT_STATION);
  presence.name("op2");
  fleet.hear(presence, at(0s));
  fleet.check(Time(59s));
  EXPECT_EQ(fleet.stations().size(), 1U);
  fleet.check(Time(61s));
  EXPECT_TRUE(fleet.stations().empty());
}

}  // namespace
}  // namespace adit::station
