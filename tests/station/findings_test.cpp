// SPDX-License-Identifier: Apache-2.0
// What robots find, at a station: on its disk, acknowledged, listed.
#include "core/findings/finding_piece.hpp"
#include "core/findings/mark_data.hpp"
#include "core/store/memory_disk.hpp"
#include "core/transfer/receiver.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class FindingsTest : public StationTest {
 protected:
  FindingsTest() : robot_(add("r1")) {
    begin_station();
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
  /// Sends a piece with these bytes and returns its id.
  std::uint32_t send(const store::Bytes& data, const std::string& robot = "r1",
                     transfer::Kind kind = transfer::Kind::findings) {
    radio::BulkPiece piece;
    piece.robot(robot);
    piece.session(3);
    piece.id(++pieces_);
    piece.kind(static_cast<std::uint8_t>(kind));
    piece.data(data);
    robot_.send(piece);
    run_for(500ms);
    return pieces_;
  }
  static findings::Finding found(std::uint64_t number, std::uint8_t importance = 1,
                                 const std::string& kind = "artifact") {
    findings::Finding f;
    f.key = {"r1", number};
    f.kind = kind;
    f.importance = importance;
    f.position = {1, 2, 3};
    f.text = "a \x1b[31mred backpack";
    return f;
  }
  std::uint32_t find(std::uint64_t number, std::uint8_t importance = 1,
                     const std::string& kind = "artifact") {
    return send(findings::encode({"r1", 5, 0, {found(number, importance, kind)}}));
  }
  /// Whether the station acknowledged a piece.
  bool acknowledged(std::uint32_t piece) {
    run_for(1s);
    bool has = false;
    for (const radio::BulkAck& ack : robot_.piece_acks())
      for (const radio::BulkReceipt& receipt : ack.receipts())
        has |= transfer::Receipt{receipt.session(), receipt.newest(), receipt.received()}.has(piece);
    return has;
  }
  std::size_t listed() { return execute("findings").json["findings"].size(); }

  std::shared_ptr<store::MemoryDisk> disk_{std::make_shared<store::MemoryDisk>()};
  FakeRobot& robot_;
  std::uint32_t pieces_{};
};

TEST_F(FindingsTest, AreListedMostImportantFirstAndAcknowledged) {
  EXPECT_THAT(execute("findings").text, HasSubstr("nothing was found yet"));
  EXPECT_TRUE(acknowledged(find(1)));
  EXPECT_TRUE(acknowledged(find(2, 9, "person")));
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
  EXPECT_TRUE(acknowledged(find(1)));
  EXPECT_EQ(listed(), 1u);
}

TEST_F(FindingsTest, AStationOfARobotsNameDoesNotEndTheSessionOfTheRobot) {
  const std::uint32_t piece = find(1);
  ASSERT_TRUE(acknowledged(piece));
  constexpr Id kOther{7, 7};
  const auto wire = network_.join(77, "other");
  auto presence = wire::Writer<radio::Presence>::make(*wire, wire::topics::kPresence).value();
  auto bulk = wire::Writer<radio::BulkPiece>::make(*wire, wire::topics::kBulk).value();
  radio::Presence station;
  station.kind(radio::AGENT_STATION);
  station.name("r1");
  station.id(kOther);
  station.protocol(1);
  (void)presence.write(station);
  run_for(1s);
  findings::Finding mark = found(2);
  mark.key.owner = kOther;
  mark.data = findings::encode_mark();
  findings::FindingPiece marks{"r1", 1, 0, {mark}};
  marks.owner = kOther;
  radio::BulkPiece sent;
  sent.robot("r1");
  sent.session(8);
  sent.id(1);
  sent.kind(static_cast<std::uint8_t>(transfer::Kind::findings));
  sent.data(findings::encode(marks));
  (void)bulk.write(sent);
  run_for(5s);
  EXPECT_EQ(listed(), 1U);
  ASSERT_FALSE(robot_.piece_acks().back().receipts().empty());
  EXPECT_EQ(robot_.piece_acks().back().receipts().front().session(), 3U);
  EXPECT_TRUE(acknowledged(piece));
}

TEST_F(FindingsTest, ThatChangeAreListedWithTheirNewestContentAndNotifiedOnce) {
  const auto notices = [this] {
    const auto& all = op_->fleet().notices();
    return std::count_if(all.begin(), all.end(), [](const auto& notice) { return notice.code == "found"; });
  };
  find(1);
  EXPECT_EQ(notices(), 1);
  EXPECT_EQ(execute("finding 1 confirm").exit_code, 0);
  findings::Finding f = found(1);
  f.revision = 4;
  f.position = {7, 8, 9};
  f.text = "a blue backpack";
  EXPECT_TRUE(acknowledged(send(findings::encode({"r1", 5, 0, {f}}))));
  f.revision = 3;
  f.text = "a green backpack";
  EXPECT_TRUE(acknowledged(send(findings::encode({"r1", 5, 0, {f}})))) << "a newer one is on the disk";
  EXPECT_EQ(notices(), 1);
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = execute("findings");
    ASSERT_EQ(outcome.json["findings"].size(), 1U);
    const auto row = outcome.json["findings"][0];
    EXPECT_EQ(row["text"], "a blue backpack");
    EXPECT_EQ(row["position"][0], 7);
    EXPECT_EQ(row["verdict"], "confirmed");
    EXPECT_EQ(row["number"], 1);
    EXPECT_FALSE(row.contains("withdrawn"));
    begin_station();
    run_for(2s);
  }
}

TEST_F(FindingsTest, ThatAreWithdrawnStayInTheList) {
  find(1);
  find(2, 9, "person");
  EXPECT_EQ(execute("finding 2 reject").exit_code, 0);
  for (std::uint64_t id = 1; id <= 2; ++id) {
    findings::Finding f = found(id);
    f.revision = 1;
    f.withdrawn = true;
    EXPECT_TRUE(acknowledged(send(findings::encode({"r1", 5, 0, {f}}))));
  }
  const Outcome outcome = execute("findings");
  EXPECT_THAT(outcome.text, HasSubstr(" withdrawn"));
  EXPECT_THAT(outcome.text, HasSubstr("rejected, withdrawn"));
  ASSERT_EQ(outcome.json["findings"].size(), 2U);
  EXPECT_EQ(outcome.json["findings"][0]["withdrawn"], true);
  findings::Finding back = found(1);
  back.revision = 2;
  EXPECT_TRUE(acknowledged(send(findings::encode({"r1", 5, 0, {back}}))));
  EXPECT_FALSE(execute("findings").json["findings"][0].contains("withdrawn"));
}

TEST_F(FindingsTest, ThatChangeReachFrontEndsAndMakeALineInTheLogOnlyWhereWordsChange) {
  const auto codes = [this] {
    std::vector<std::string> all;
    for (const StoredNotice& notice : op_->fleet().notices()) all.push_back(notice.code);
    return all;
  };
  std::size_t calls = 0;
  op_->on_changed = [&calls] { ++calls; };
  find(1);
  const auto counts = [this] { return op_->world().findings; };
  EXPECT_EQ(counts().listed, 1U);
  EXPECT_EQ(counts().open, 1U);
  findings::Finding f = found(1);
  const auto revise = [&] {
    const std::uint64_t before = counts().changes;
    const std::size_t lines = op_->fleet().notices().size();
    ++f.revision;
    send(findings::encode({"r1", 1, 0, {f}}));
    EXPECT_EQ(counts().changes, before + 1);
    return op_->fleet().notices().size() - lines;
  };
  f.position = {7, 8, 9};
  f.data = {1, 2};
  calls = 0;
  EXPECT_EQ(revise(), 0U) << "a refined place";
  EXPECT_GT(calls, 0U);
  f.text = "a blue backpack";
  EXPECT_EQ(revise(), 1U);
  EXPECT_EQ(codes().back(), "finding_changed");
  EXPECT_EQ(op_->fleet().notices().back().text, "finding 1 of r1 is now artifact: a blue backpack");
  f.withdrawn = true;
  EXPECT_EQ(revise(), 1U);
  EXPECT_EQ(codes().back(), "finding_withdrawn");
  EXPECT_EQ(counts().listed, 1U);
  EXPECT_EQ(counts().open, 0U);
  f.text = "still withdrawn";
  EXPECT_EQ(revise(), 0U);
  f.withdrawn = false;
  EXPECT_EQ(revise(), 1U);
  EXPECT_EQ(codes().back(), "found");
  EXPECT_EQ(counts().open, 1U);
  const std::uint64_t before = counts().changes;
  EXPECT_EQ(execute("finding 1 confirm").exit_code, 0);
  EXPECT_GT(counts().changes, before);
  EXPECT_EQ(counts().open, 0U);
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
  const std::uint32_t piece = find(1);
  EXPECT_FALSE(acknowledged(piece));
  EXPECT_EQ(op_->fleet().notices().back().code, "store_failing");
  disk_->set_full(false);
  run_for(3s);
  EXPECT_TRUE(acknowledged(piece));
}

TEST_F(FindingsTest, APieceIsAcknowledgedOnceEachOfItsFindingsIsOnTheDisk) {
  disk_->set_refused(findings::file_name({"r1", 2}), true);
  const std::uint32_t piece = send(findings::encode({"r1", 5, 0, {found(1), found(2), found(3)}}));
  run_for(3s);
  EXPECT_FALSE(acknowledged(piece));
  EXPECT_TRUE(acknowledged(find(3))) << "it was stored with them";
  disk_->set_refused(findings::file_name({"r1", 2}), false);
  run_for(3s);
  EXPECT_TRUE(acknowledged(piece));
}

TEST_F(FindingsTest, ThatAreDamagedOrOfAnotherRobotAreRefusedAndCounted) {
  EXPECT_FALSE(acknowledged(find(0)));
  EXPECT_FALSE(acknowledged(find(1, 1, "")));
  EXPECT_FALSE(acknowledged(find(2, 1, std::string(60, 'k'))));
  store::Bytes cut = findings::encode({"r1", 5, 0, {found(1)}});
  cut.pop_back();
  EXPECT_FALSE(acknowledged(send(cut)));
  findings::Finding foreign = found(1);
  foreign.key.robot = "r2";
  EXPECT_FALSE(acknowledged(send(findings::encode({"r2", 5, 0, {foreign}}))));
  EXPECT_FALSE(acknowledged(send(findings::encode({"r2", 5, 0, {foreign}}), "r2"))) << "r1 sent it";
  EXPECT_FALSE(acknowledged(send({})));
  EXPECT_EQ(listed(), 0u);
  const Outcome outcome = execute("findings");
  EXPECT_EQ(outcome.json["refused_pieces"], 6);
  EXPECT_THAT(outcome.text, HasSubstr("6 pieces of findings refused"));
  EXPECT_TRUE(acknowledged(find(3))) << "the rest goes on";
}

TEST_F(FindingsTest, OfAnotherReleaseStayWithTheRobot) {
  store::Bytes bytes = findings::encode({"r1", 5, 0, {found(1)}});
  bytes[0] = 9;
  EXPECT_FALSE(acknowledged(send(bytes)));
  EXPECT_TRUE(acknowledged(send({1, 2, 3}, "r1", static_cast<transfer::Kind>(77))))
      << "a kind that this release will never understand would come again without end";
}

TEST_F(FindingsTest, AreTakenWhileTheMapComesIn) {
  EXPECT_TRUE(acknowledged(find(1)));
  EXPECT_EQ(execute("map status").json["robots"].size(), 0u) << "they are no part of the map";
}

}  // namespace
}  // namespace adit::station
