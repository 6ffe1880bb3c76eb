// SPDX-License-Identifier: Apache-2.0
// Objects that programs on the robot detect become findings.
#include <gmock/gmock.h>

#include <limits>

#include "core/config/node.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/findings/object_data.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/findings/detection_messages.hpp"
#include "robot_agent/findings/detection_reporter.hpp"
#include "robot_agent/program/robot_config.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using vision_msgs::msg::Detection3D;
using vision_msgs::msg::Detection3DArray;

Detection3D object(const std::string& class_id, double score, double x) {
  Detection3D out;
  out.results().resize(1);
  out.results()[0].hypothesis().class_id(class_id);
  out.results()[0].hypothesis().score(score);
  out.results()[0].pose().pose().position().x(x);
  return out;
}

Detection3DArray message(const std::vector<Detection3D>& objects) {
  Detection3DArray out;
  out.header().frame_id("/camera");
  out.header().stamp().sec(7);
  out.detections() = objects;
  return out;
}

class DetectionMessages : public testing::Test {
 protected:
  Result<std::vector<Detection>> read(const Detection3DArray& array) {
    refused.clear();
    return detections_of(array, "detections", params, [&](const Error& why) { refused.push_back(why); });
  }
  DetectionParams params{};
  std::vector<Error> refused{};
};

TEST_F(DetectionMessages, TheBestHypothesisCounts) {
  Detection3D two = object("cat", 0.6, 1.0);
  two.results().push_back(object("person", 0.9, 2.0).results()[0]);
  two.id("17");
  const auto read_ = read(message({two}));
  ASSERT_TRUE(read_.ok());
  ASSERT_EQ(read_->size(), 1U);
  const Detection& d = (*read_)[0];
  EXPECT_EQ(d.kind, "person");
  EXPECT_EQ(d.id, "17");
  EXPECT_EQ(d.frame, "camera");
  EXPECT_EQ(d.stamp, 7'000'000'000U);
  EXPECT_EQ(d.position.x(), 2.0);
}

TEST_F(DetectionMessages, TheBoxHoldsThePlaceWhereTheResultHasNone) {
  Detection3D boxed = object("person", 0.9, 0.0);
  boxed.bbox().center().position().y(3.0);
  const auto read_ = read(message({boxed}));
  ASSERT_EQ(read_->size(), 1U);
  EXPECT_EQ((*read_)[0].position.y(), 3.0);
}

TEST_F(DetectionMessages, LowScoresAndUnwantedKindsAreIgnored) {
  params.importance["chair"] = 0;
  EXPECT_THAT(*read(message({object("person", 0.4, 1.0), object("chair", 0.9, 1.0)})), IsEmpty());
  EXPECT_THAT(refused, IsEmpty());
}

TEST_F(DetectionMessages, WhatCannotBeUsedIsRefusedAndNothingElseIsLost) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Detection3D none = object("person", 0.9, 1.0);
  none.results().clear();
  Detection3D many = object("person", 0.9, 1.0);
  many.results().resize(kMaxHypotheses + 1, many.results()[0]);
  Detection3D long_id = object("person", 0.9, 1.0);
  long_id.id(std::string(100'000, 'x'));
  Detection3D long_frame = object("person", 0.9, 1.0);
  long_frame.header().frame_id(std::string(100'000, 'x'));
  const std::vector<Detection3D> bad{object("person", 0.9, kNan),
                                     object("person", kNan, 1.0),
                                     object("person", 1.5, 1.0),
                                     object("person", 0.9, 1e9),
                                     object("person", 0.9, 0.0),
                                     object("", 0.9, 1.0),
                                     object(std::string(100'000, '\n'), 0.9, 1.0),
                                     none,
                                     many,
                                     long_id,
                                     long_frame};
  std::vector<Detection3D> all = bad;
  all.insert(all.begin() + 4, object("person", 0.9, 4.0));
  const auto read_ = read(message(all));
  ASSERT_EQ(read_->size(), 1U);
  EXPECT_EQ((*read_)[0].position.x(), 4.0);
  EXPECT_EQ(refused.size(), bad.size());
  for (const Error& why : refused) {
    EXPECT_LT(why.text.size(), 200U);
    EXPECT_EQ(why.text.find('\n'), std::string::npos);
  }
}

TEST_F(DetectionMessages, TenThousandObjectsAreRefusedAsOne) {
  const auto read_ = read(message(std::vector<Detection3D>(10'000, object("person", 0.9, 1.0))));
  EXPECT_EQ(read_.reason(), Reason::out_of_range);
  EXPECT_THAT(read_.error().text, HasSubstr("10000 objects"));
}

TEST_F(DetectionMessages, AFrameIsNeeded) {
  Detection3DArray nowhere = message({object("person", 0.9, 1.0)});
  nowhere.header().frame_id("");
  EXPECT_THAT(*read(nowhere), IsEmpty());
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].reason, Reason::frame_unknown);
}

TEST(DetectionKind, IsShortAndPlain) {
  EXPECT_EQ(kind_of("fire extinguisher"), "fire_extinguisher");
  EXPECT_EQ(kind_of("\xc3\xa4\n<b>"), "____b_");
  EXPECT_EQ(kind_of(std::string(500, 'a')), std::string(32, 'a'));
  EXPECT_EQ(kind_of("stairs"), "staircase");
}

/// The key `detections` of a robot's file; `error`: of the file.
DetectionParams configured(const std::string& text, std::string& error) {
  RobotConfig config;
  const auto root = config::parse(text, "r1.yaml").value();
  read_robot_keys(root, "r1.yaml", config);
  const auto read = root.finish();
  error = read ? "" : read.error().text;
  return agent_params(config).detections;
}

TEST(DetectionConfig, IsReadFromTheRobotsFile) {
  std::string error;
  const DetectionParams params = configured(
      "detections: {topics: [front/objects, rear], min_score: 0.7, sightings: 5, "
      "importance: {person: 9, fire extinguisher: 0, default: 2}}",
      error);
  EXPECT_EQ(error, "");
  EXPECT_THAT(params.topics, ElementsAre("front/objects", "rear"));
  EXPECT_EQ(params.min_score, 0.7);
  EXPECT_EQ(params.sightings, 5);
  EXPECT_EQ(params.importance_of("person"), 9);
  EXPECT_EQ(params.importance_of("fire_extinguisher"), 0);
  EXPECT_EQ(params.importance_of("cat"), 2);
}

TEST(DetectionConfig, WrongValuesAreRefusedWithTheirLine) {
  for (const char* wrong : {"topics: [/x]", "topics: [a, a]", "topics: [a, b, c, d, e]", "topics: ['a b']",
                            "min_score: 2", "sightings: 0", "importance: {person: 256}", "min_scor: 0.5"}) {
    std::string error;
    configured("detections: {" + std::string(wrong) + "}", error);
    EXPECT_THAT(error, HasSubstr("r1.yaml:1")) << wrong;
  }
}

class DetectionReporterTest : public testing::Test {
 protected:
  /// One message with objects at these x; `ids` empty: without ids.
  void see(const std::vector<double>& places, const std::vector<std::string>& ids = {},
           const std::string& source = "camera", double score = 0.8) {
    now_ += 100ms;
    ++message_;
    for (std::size_t n = 0; n < places.size(); ++n) {
      const Detection detection{
          .source = source, .id = ids.empty() ? "" : ids[n], .kind = "person", .score = score};
      last_ = reporter_->take(detection, {places[n], 0, 0}, message_, now_);
    }
    source_.tick(now_);
  }
  std::vector<double> places() const {
    std::vector<double> out;
    for (const auto& [key, finding] : source_.finding_store().all()) out.push_back(finding.position[0]);
    std::sort(out.begin(), out.end());
    return out;
  }
  std::uint32_t revision() const { return source_.finding_store().all().begin()->second.revision; }
  void restart() { reporter_.emplace(DetectionParams{}, "r1", source_); }

  VirtualScheduler scheduler_{1};
  std::unique_ptr<Runtime> machine_{scheduler_.machine("r1", 5s)};
  std::shared_ptr<Executor> strand_{machine_->strand("command")};
  FindingSource source_{{.robot = "r1", .owner = {7}}, nullptr, *strand_, nullptr, {}};
  std::optional<DetectionReporter> reporter_{std::in_place, DetectionParams{}, "r1", source_};
  Time now_{10s};
  std::uint64_t message_{};
  Result<void> last_{};
};

TEST_F(DetectionReporterTest, ThreeSightingsMakeOneFinding) {
  see({2.0});
  see({2.1});
  EXPECT_THAT(places(), IsEmpty());
  for (int n = 0; n < 100; ++n) see({2.0});
  EXPECT_EQ(places().size(), 1U);
  EXPECT_EQ(revision(), 0U) << "nothing that an operator would notice";
}

TEST_F(DetectionReporterTest, SightingsFarApartInTimeConfirmNothing) {
  for (int n = 0; n < 5; ++n) {
    see({2.0});
    now_ += 4s;
  }
  EXPECT_THAT(places(), IsEmpty());
}

TEST_F(DetectionReporterTest, PartsInOneMessageAreOneSighting) {
  see({2.0, 2.1, 2.2, 2.3});
  EXPECT_THAT(places(), IsEmpty());
}

TEST_F(DetectionReporterTest, WhatMovesIsAnUpdateEachTwoSecondsAtMost) {
  for (int n = 0; n < 100; ++n) see({2.0 + 0.05 * n}, {"7"});  // 0.5 m/s for 10 s.
  EXPECT_EQ(places().size(), 1U);
  EXPECT_NEAR(places()[0], 6.5, 1.2);
  EXPECT_GE(revision(), 3U);
  EXPECT_LE(revision(), 5U);
}

TEST_F(DetectionReporterTest, IdsKeepNeighboursApart) {
  for (int n = 0; n < 5; ++n) see({2.0, 2.5}, {"1", "2"});
  EXPECT_EQ(places().size(), 2U);
}

TEST_F(DetectionReporterTest, ADetectorThatWasRestartedReportsNothingTwice) {
  for (int n = 0; n < 5; ++n) see({2.0}, {"1"});
  now_ += 5s;
  for (int n = 0; n < 5; ++n) see({2.2}, {"40"}, "camera 2");
  EXPECT_EQ(places().size(), 1U);
  restart();  // The agent.
  for (int n = 0; n < 5; ++n) see({2.1}, {"3"}, "camera 3");
  EXPECT_EQ(places().size(), 1U);
}

TEST_F(DetectionReporterTest, WhatOthersReportedOfAnObjectStays) {
  EXPECT_TRUE(source_
                  .report({.kind = "person",
                           .importance = 9,
                           .position = {2.0, 0.0, 0.0},
                           .text = "trapped, leg",
                           .data = {1, 2, 3}})
                  .ok());
  for (int n = 0; n < 40; ++n) see({2.8});
  ASSERT_EQ(source_.finding_store().all().size(), 1U);
  const findings::Finding& found = source_.finding_store().all().begin()->second;
  EXPECT_GT(found.position[0], 2.5) << "it is where it was seen last";
  EXPECT_EQ(found.text, "trapped, leg");
  EXPECT_EQ(found.data, (store::Bytes{1, 2, 3}));
}

TEST_F(DetectionReporterTest, AnIdThatIsUsedAgainFarAwayIsAnotherObject) {
  for (int n = 0; n < 5; ++n) see({2.0}, {"1"});
  now_ += 60s;
  for (int n = 0; n < 5; ++n) see({30.0}, {"1"});
  EXPECT_THAT(places(), ElementsAre(2.0, 30.0));
}

TEST_F(DetectionReporterTest, AWithdrawnFindingComesBackWhenItIsSeen) {
  for (int n = 0; n < 5; ++n) see({2.0});
  ASSERT_TRUE(source_.withdraw(source_.finding_store().all().begin()->first.id));
  now_ += 5s;
  source_.tick(now_);
  ASSERT_TRUE(source_.finding_store().all().begin()->second.withdrawn);
  restart();
  for (int n = 0; n < 50; ++n) see({2.0});
  EXPECT_EQ(places().size(), 1U);
  EXPECT_FALSE(source_.finding_store().all().begin()->second.withdrawn);
}

TEST_F(DetectionReporterTest, TheAgentsOwnDetectorAddsSigmaAndTheBestPhoto) {
  std::vector<std::uint64_t> stored;
  ObjectsParams params;
  reporter_.emplace(
      params.report, "r1", source_,
      [&stored](const findings::Photo& photo, std::uint8_t) -> std::optional<findings::PhotoRef> {
        stored.push_back(photo.hash);
        return findings::ref_of(photo);
      });
  const auto sight = [&](double x, double score, double sigma, std::uint64_t photo) {
    now_ += 1s;
    const Detection detection{.source = "camera front",
                              .kind = "person",
                              .score = score,
                              .sigma = sigma,
                              .photo = std::make_shared<findings::Photo>(findings::Photo{
                                  .picture = store::Bytes(9), .thumbnail = store::Bytes(3), .hash = photo})};
    last_ = reporter_->take(detection, {x, 0, 0}, ++message_, now_);
    source_.tick(now_);
  };
  sight(5.0, 0.7, 0.9, 11);
  EXPECT_THAT(places(), IsEmpty());
  sight(6.5, 0.8, 0.4, 12);
  ASSERT_EQ(places().size(), 1U) << "within 2 m it is one object";
  EXPECT_NEAR(places()[0], 5.75, 1e-9);
  EXPECT_THAT(stored, ElementsAre(12U)) << "only the best photo is stored";
  const findings::Finding& found = source_.finding_store().all().begin()->second;
  EXPECT_EQ(found.text, "score 0.80, sigma 0.4 m");
  EXPECT_EQ(found.photo->content, 12U);
  ASSERT_TRUE(findings::read_object(found));
  EXPECT_NEAR(findings::read_object(found)->sigma, 0.4, 0.005);
  EXPECT_NEAR(findings::read_object(found)->score, 0.8, 0.003);
  sight(5.75, 0.5, 0.4, 13);
  sight(5.75, 0.95, 0.4, 14);
  sight(5.75, 0.95, 0.4, 15);
  EXPECT_THAT(stored, ElementsAre(12U, 14U)) << "another one only where it is surer";
}

TEST_F(DetectionReporterTest, ALoneSightingOfLongAgoLendsNoScoreToALaterOne) {
  reporter_.emplace(ObjectsParams{}.report, "r1", source_);
  see({5.0}, {}, "camera front", 0.9);
  now_ += 1h;
  see({5.0}, {}, "camera front", 0.6);
  see({5.0}, {}, "camera front", 0.6);
  ASSERT_EQ(places().size(), 1U);
  EXPECT_EQ(source_.finding_store().all().begin()->second.text, "score 0.60");
}

TEST_F(DetectionReporterTest, AFloodIsBounded) {
  for (int n = 0; n < 30; ++n) {  // Three seconds.
    std::vector<double> many;
    std::vector<std::string> ids;
    for (int k = 0; k < 256; ++k) {
      many.push_back(10.0 * k);
      ids.push_back(std::to_string(k));
    }
    see(many, ids);
  }
  EXPECT_LE(places().size(), 20U + 3U);
  EXPECT_LE(reporter_->tracks(), DetectionReporter::kTracks);
  for (int n = 0; n < 20; ++n) see({5000.0 + 3 * n}, {"x" + std::to_string(n)});
  EXPECT_LE(reporter_->tracks(), DetectionReporter::kTracks);
}

}  // namespace
}  // namespace adit::agent
