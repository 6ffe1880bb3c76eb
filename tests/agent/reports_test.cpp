// SPDX-License-Identifier: Apache-2.0
// What programs on the robot report with a text and a photo.
#include <gmock/gmock.h>

#include <limits>

#include "core/config/node.hpp"
#include "core/findings/photo.hpp"
#include "core/wire/qos.hpp"
#include "core/wire/topics.hpp"
#include "robot_agent/findings/report_messages.hpp"
#include "robot_agent/program/robot_config.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit::agent {
namespace {

using testing::HasSubstr;
using visualization_msgs::msg::Marker;

Marker marker(const std::string& ns, std::int32_t number, double x) {
  Marker out;
  out.header().frame_id("/camera");
  out.header().stamp().sec(7);
  out.ns(ns);
  out.id(number);
  out.text("a red backpack");
  out.pose().position().x(x);
  return out;
}

TEST(ReportMessages, HaveAKindATextAPlaceAndAPhoto) {
  Marker m = marker("back pack", 3, 2.0);
  m.texture().data().assign(1000, 5);
  const auto report = report_of(m);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->object.kind, "back_pack");
  EXPECT_EQ(report->object.text, "a red backpack");
  EXPECT_EQ(report->object.frame, "camera");
  EXPECT_EQ(report->object.stamp, 7'000'000'000U);
  EXPECT_EQ(report->object.position.x(), 2.0);
  ASSERT_NE(report->jpeg, nullptr);
  EXPECT_EQ(report->jpeg->size(), 1000U);
  EXPECT_FALSE(report->withdraws);
}

TEST(ReportMessages, NamespaceAndNumberNameTheFinding) {
  const std::uint64_t id = report_of(marker("person", 3, 1.0))->id;
  EXPECT_EQ(report_of(marker("person", 3, 9.0))->id, id);
  EXPECT_NE(report_of(marker("person", 4, 1.0))->id, id);
  EXPECT_NE(report_of(marker("fire", 3, 1.0))->id, id);
  EXPECT_NE(id, 0U);
  Marker gone = marker("person", 3, 1.0);
  gone.header().frame_id("");
  gone.action(2);
  const auto withdrawn = report_of(gone);
  ASSERT_TRUE(withdrawn.ok()) << "it needs no place";
  EXPECT_TRUE(withdrawn->withdraws);
  EXPECT_EQ(withdrawn->id, id);
}

TEST(ReportMessages, WhatCannotBeUsedIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(report_of(marker("", 1, 1.0)).reason(), Reason::malformed);
  EXPECT_EQ(report_of(marker(std::string(100'000, '\n'), 1, 1.0)).reason(), Reason::malformed);
  EXPECT_EQ(report_of(marker("person", 1, kNan)).reason(), Reason::malformed);
  EXPECT_EQ(report_of(marker("person", 1, 1e9)).reason(), Reason::malformed);
  Marker m = marker("person", 1, 1.0);
  m.action(3);
  EXPECT_EQ(report_of(m).reason(), Reason::malformed);
  m = marker("person", 1, 1.0);
  m.header().frame_id("");
  EXPECT_EQ(report_of(m).reason(), Reason::frame_unknown);
  m.header().frame_id(std::string(100'000, 'x'));
  EXPECT_EQ(report_of(m).reason(), Reason::frame_unknown);
}

TEST(ReportMessages, APhotoThatIsTooLargeCostsOnlyThePhoto) {
  Marker m = marker("person", 1, 1.0);
  m.texture().data().resize(20'000'000);
  const auto report = report_of(m);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->jpeg, nullptr);
  ASSERT_TRUE(report->no_photo.has_value());
  EXPECT_THAT(report->no_photo->text, HasSubstr("19531 kB"));
}

TEST(ReportMessages, ALongTextIsCutBetweenCharacters) {
  Marker m = marker("person", 1, 1.0);
  m.text("x" + std::string(63, '.') + [] {
    std::string out;
    for (int i = 0; i < 100; ++i) out += "é";
    return out;
  }());
  const auto report = report_of(m);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->object.text.size(), 128U);
  m.text("x" + m.text());
  EXPECT_EQ(report_of(m)->object.text.size(), 127U);
}

/// The key `reports` of a robot's file; `error`: of the file.
ReportParams reports_configured(const std::string& text, std::string& error) {
  RobotConfig config;
  const auto root = config::parse(text, "r1.yaml").value();
  read_robot_keys(root, "r1.yaml", config);
  const auto read = root.finish();
  error = read ? "" : read.error().text;
  return agent_params(config).reports;
}

TEST(ReportConfig, IsReadFromTheRobotsFile) {
  std::string error;
  const ReportParams params =
      reports_configured("reports: {topics: [front/notes], importance: {person: 3, cat: 0}}", error);
  EXPECT_EQ(error, "");
  EXPECT_EQ(params.topics, std::vector<std::string>{"front/notes"});
  EXPECT_EQ(params.importance.at("person"), 3);
  EXPECT_EQ(params.importance.at("cat"), 0);
  EXPECT_EQ(reports_configured("start_height: 1", error).topics, std::vector<std::string>{"reports"});
  (void)reports_configured("reports: {topics: [/reports]}", error);
  EXPECT_THAT(error, HasSubstr("r1.yaml:1"));
  (void)reports_configured("reports: {importance: {person: 256}}", error);
  EXPECT_THAT(error, HasSubstr("255"));
}

TEST(ReportConfig, ItsReaderIsReliableAndThoseOfSensorsAreNot) {
  EXPECT_TRUE(wire::reader_qos(wire::topics::kReports).reliable) << "a photo has many fragments";
  EXPECT_FALSE(wire::reader_qos(wire::topics::kReports).transient_local);
  EXPECT_FALSE(wire::reader_qos(wire::topics::kDetections).reliable);
}

}  // namespace
}  // namespace adit::agent
