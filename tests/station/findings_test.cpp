// SPDX-License-Identifier: Apache-2.0
// What robots find, at a station: on its disk, acknowledged, listed.
#include "adit/findings.h"
#include "core/store/memory_disk.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FindingsTest : public StationTest {
 protected:
  FindingsTest() {
    add("r1");
    begin_station();
    finder_ = network_.join(77, "finder");
    strand2_ = machine_->strand("finder");
    writer_ = wire::Writer<radio::Finding>::make(*finder_, wire::topics::kFinding).value();
    acks_ = wire::make_reader(*finder_, wire::topics::kFindingsAck, *strand2_,
                              [this](const radio::FindingsAck& a, const wire::SampleInfo&) {
                                for (const auto one : a.ids()) acknowledged_.push_back(one);
                              })
                .value();
    run_for(6s);
  }
  void begin_station() {
    op_.reset();
    wire_.reset();
    wire_ = network_.join(77, "op1");
    StationParams params;
    params.name = "op1";
    params.id = kId;
    params.disk = disk_;
    op_ = std::make_unique<Station>(params, *strand_, *wire_);
    ASSERT_TRUE(op_->start().ok());
  }
  void find(std::uint64_t number, std::uint8_t importance = 1, const std::string& kind = "artifact") {
    radio::Finding f;
    f.robot("r1");
    f.id(number);
    f.kind(kind);
    f.importance(importance);
    f.position({1, 2, 3});
    f.text("a \x1b[31mred backpack");
    f.kept(5);
    (void)writer_.write(f);
    run_for(500ms);
  }

  std::shared_ptr<store::MemoryDisk> disk_{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<wire::Participant> finder_{};
  std::shared_ptr<Executor> strand2_{};
  wire::Writer<radio::Finding> writer_{};
  std::unique_ptr<wire::RawReader> acks_{};
  std::vector<std::uint64_t> acknowledged_{};
};

TEST_F(FindingsTest, AreListedMostImportantFirstAndAcknowledged) {
  EXPECT_THAT(execute("findings").text, HasSubstr("nothing was found yet"));
  find(1);
  find(2, 9, "person");
  EXPECT_THAT(acknowledged_, ElementsAre(1, 2));
  const Outcome outcome = execute("findings r1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_LT(outcome.text.find("person"), outcome.text.find("artifact"));
  EXPECT_THAT(outcome.text, HasSubstr("red backpack"));
  EXPECT_EQ(outcome.text.find('\x1b'), std::string::npos) << "what a robot writes moves no terminal";
  EXPECT_THAT(outcome.text, HasSubstr("r1 has 5, 2 are here"));
  ASSERT_EQ(outcome.json["findings"].size(), 2u);
  EXPECT_EQ(outcome.json["findings"][0]["kind"], "person");
  EXPECT_EQ(outcome.json["findings"][0]["id"], "0000000000000002");
  EXPECT_EQ(execute("findings r2").json["findings"].size(), 0u);
}

TEST_F(FindingsTest, ARepeatIsAcknowledgedAgainAndListedOnce) {
  find(1);
  find(1);
  EXPECT_THAT(acknowledged_, ElementsAre(1, 1));
  EXPECT_EQ(execute("findings").json["findings"].size(), 1u);
}

TEST_F(FindingsTest, SurviveARestartOfTheStation) {
  find(1);
  begin_station();
  run_for(2s);
  EXPECT_EQ(execute("findings").json["findings"].size(), 1u);
}

TEST_F(FindingsTest, AreJudgedByTheirNumberAndThatSurvivesARestart) {
  find(7);
  find(8, 9, "person");
  EXPECT_EQ(execute("finding 1 confirm").text, "finding 1 of r1 is confirmed\n");
  EXPECT_EQ(execute("finding 2 reject").exit_code, 0);
  EXPECT_EQ(execute("finding 2 note near the second pillar").json["note"], "near the second pillar");
  begin_station();
  run_for(2s);
  find(3, 20);
  const auto rows = execute("findings").json["findings"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["number"], 3) << "a new finding takes no number of an old one";
  EXPECT_EQ(rows[0]["verdict"], "open");
  EXPECT_EQ(rows[1]["number"], 2);
  EXPECT_EQ(rows[1]["verdict"], "rejected");
  EXPECT_EQ(rows[1]["note"], "near the second pillar");
  EXPECT_EQ(rows[2]["verdict"], "confirmed");
  EXPECT_EQ(execute("finding 1 reopen").json["verdict"], "open");
  EXPECT_EQ(execute("finding 2 note").text, "finding 2 of r1 has no note\n");
}

TEST_F(FindingsTest, AreJudgedOnlyIfTheyExistAndTheJudgementIsStored) {
  find(7);
  for (const char* line : {"finding 2 confirm", "finding 1.5 confirm", "finding 99 note x"})
    EXPECT_EQ(execute(line).json["reason"], "out_of_range") << line;
  for (const char* line : {"finding 0 confirm", "finding 1 maybe", "finding 1", "finding x note"})
    EXPECT_EQ(execute(line).exit_code, 2) << line;
  disk_->set_full(true);
  const Outcome outcome = execute("finding 1 confirm");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("not stored"));
  disk_->set_full(false);
  EXPECT_EQ(execute("finding 1 confirm").exit_code, 0);
}

TEST_F(FindingsTest, ADamagedFileOfJudgementsIsPreservedAndReported) {
  find(7);
  const std::vector<std::string> bad{
      "",
      "{",
      "[]",
      R"({"version": 2, "findings": []})",
      R"({"version": 1, "findings": [{"robot": 5}]})",
      R"({"version": 1, "findings": [{"robot": "r1", "id": "x", "number": 1}]})"};
  for (const std::string& text : bad) {
    op_.reset();
    ASSERT_TRUE(
        disk_->replace("judgements", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    begin_station();
    run_for(2s);
    EXPECT_EQ(op_->fleet().notices().back().code, "findings_damaged") << text;
    const auto aside = disk_->read("judgements.bad");
    ASSERT_TRUE(aside && *aside) << text;
    EXPECT_EQ(std::string((*aside)->begin(), (*aside)->end()), text);
    EXPECT_EQ(execute("finding 1 confirm").exit_code, 0) << "numbers are given again";
  }
}

TEST_F(FindingsTest, AreNotAcknowledgedWhileTheDiskFails) {
  disk_->set_full(true);
  find(1);
  EXPECT_THAT(acknowledged_, IsEmpty());
  EXPECT_EQ(op_->fleet().notices().back().code, "store_failing");
  disk_->set_full(false);
  run_for(3s);
  EXPECT_THAT(acknowledged_, ElementsAre(1));
}

TEST_F(FindingsTest, ThatAreNoneAreIgnored) {
  find(0);
  find(1, 1, "");
  find(2, 1, std::string(60, 'k'));
  EXPECT_THAT(acknowledged_, IsEmpty());
  EXPECT_EQ(execute("findings").json["findings"].size(), 0u);
}

}  // namespace
}  // namespace adit::station
