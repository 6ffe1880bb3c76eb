// SPDX-License-Identifier: Apache-2.0
// Objects that robots' own detectors found, as the station lists them.
#include <gmock/gmock.h>

#include "basestation/model/json.hpp"
#include "core/findings/object_data.hpp"
#include "tests/station/findings_fixture.hpp"

namespace adit::station {
namespace {

using testing::ElementsAre;

class ObjectsReport : public StoredFindings {
 protected:
  void find(const std::string& robot, std::uint64_t id, double x, const std::string& kind = "person",
            bool detected = true) {
    findings::Finding finding{.key = {robot, id}, .kind = kind, .importance = 5, .position = {x, 1, 0}};
    finding.text = "score 0.80";
    if (detected) finding.data = findings::encode_object({0.4, 0.8});
    StoredFindings::find(finding);
  }
  std::vector<FoundItem> listed() { return found().findings; }
};

TEST_F(ObjectsReport, AnObjectOfTwoRobotsIsListedOnce) {
  find("r2", 7, 5.0);
  find("r1", 3, 6.5);
  find("r3", 1, 4.2);
  const auto items = listed();
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0].number, 1U) << "that of r2, which was here first";
  EXPECT_EQ(items[0].robot, "r2");
  EXPECT_THAT(items[0].also, ElementsAre(2U, 3U));
  EXPECT_EQ(items[0].text, "score 0.80, also by r1, also by r3");
}

TEST_F(ObjectsReport, OthersStayApart) {
  find("r1", 1, 5.0);
  find("r1", 2, 5.5);                   // Of the same robot, which knows that they are two.
  find("r2", 1, 7.7);                   // Too far.
  find("r2", 2, 5.0, "rope");           // Of another kind.
  find("r3", 1, 5.0, "person", false);  // Of another program, or of a crew that knows better.
  EXPECT_EQ(listed().size(), 5U);
}

TEST_F(ObjectsReport, TwoPeopleSeenByTwoRobotsAreTwo) {
  find("r1", 1, 5.0);
  find("r1", 2, 6.0);
  find("r2", 2, 6.1);
  find("r2", 1, 5.1);
  const auto items = listed();
  ASSERT_EQ(items.size(), 2U);
  EXPECT_THAT(items[0].also, ElementsAre(4U)) << "the nearest one, not the first one within 2 m";
  EXPECT_THAT(items[1].also, ElementsAre(3U));
}

TEST_F(ObjectsReport, AVerdictOnOneIsThatOfTheObject) {
  find("r1", 1, 5.0);
  book_.judge({"r1", 1}, Verdict::rejected, [](const Result<void>&) {});
  find("r2", 1, 5.1);
  ASSERT_EQ(listed().size(), 1U);
  EXPECT_EQ(listed()[0].verdict, Verdict::rejected);
}

TEST_F(ObjectsReport, TheListAsTextAndAsJson) {
  find("r1", 1, 5.0);
  find("r2", 1, 5.1);
  const FoundReport report = found();
  EXPECT_THAT(findings_text(report), testing::HasSubstr("score 0.80, also by r2"));
  EXPECT_EQ(findings_json(report, desk_, book_)["findings"][0]["also"], nlohmann::json({2}));
}

}  // namespace
}  // namespace adit::station
