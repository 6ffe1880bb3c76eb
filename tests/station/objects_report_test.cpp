// SPDX-License-Identifier: Apache-2.0
// Objects that robots' own detectors found, as the station lists them.
#include <gmock/gmock.h>

#include "basestation/findings/report.hpp"
#include "basestation/model/json.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/findings/object_data.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using testing::ElementsAre;

class ObjectsReport : public StationTest {
 protected:
  ObjectsReport()
      : book_(nullptr, *strand_),
        desk_({}, std::make_shared<store::MemoryDisk>(), *strand_,
              {[this](const findings::Finding& f) { book_.add(f.key); },
               [](const std::string&, const std::string&) {}}) {}

  void find(const std::string& robot, std::uint64_t id, double x, const std::string& kind = "person",
            bool detected = true) {
    findings::Finding finding{.key = {robot, id}, .kind = kind, .importance = 5, .position = {x, 1, 0}};
    finding.text = "score 0.80";
    if (detected) finding.data = findings::encode_object({0.4, 0.8});
    ASSERT_TRUE(desk_.hear(robot, findings::encode({robot, 1, 0, {finding}}), [] {}));
  }
  std::vector<FoundItem> listed() {
    return findings_report(desk_, book_, marks_, photos_, chunks_, fleet_, {}).findings;
  }
  std::vector<std::uint32_t> numbers() {
    std::vector<std::uint32_t> out;
    for (const FoundItem& item : listed()) out.push_back(item.number);
    return out;
  }

  FindingBook book_;
  FindingDesk desk_;
  Marks marks_{"op1", {1}, 1, desk_, *strand_};
  findings::PhotoStore photos_{{}, nullptr, *strand_, nullptr, {}};
  ChunkStore chunks_;
  Fleet fleet_{"op1", {1}};
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
  const FoundReport report = findings_report(desk_, book_, marks_, photos_, chunks_, fleet_, {});
  EXPECT_THAT(findings_text(report), testing::HasSubstr("score 0.80, also by r2"));
  EXPECT_EQ(findings_json(report, desk_, book_)["findings"][0]["also"], nlohmann::json({2}));
}

}  // namespace
}  // namespace adit::station
