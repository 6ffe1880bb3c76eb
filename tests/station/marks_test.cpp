// SPDX-License-Identifier: Apache-2.0
// Marks of an operator: findings of his station.
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/findings/finding_piece.hpp"
#include "core/findings/mark_data.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/folders/folders.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class MarksTest : public StationTest {
 protected:
  MarksTest() : robot_(add("r1")) { begin_station(); }
  void begin_station(std::uint64_t seed = 1) {
    op_.reset();
    wire_.reset();
    wire_ = network_.join(77, "op1");
    StationParams params;
    params.name = "op1";
    params.id = kId;
    params.seed = seed;
    params.disk = disk_;
    op_ = std::make_unique<Station>(params, *strand_, *wire_);
    ASSERT_TRUE(op_->start().ok());
    run_for(6s);
  }
  nlohmann::json listed() { return execute("findings").json["findings"]; }
  void send(const findings::FindingPiece& content) {
    radio::BulkPiece piece;
    piece.robot("r1");
    piece.session(3);
    piece.id(++pieces_);
    piece.kind(static_cast<std::uint8_t>(transfer::Kind::findings));
    piece.data(findings::encode(content));
    robot_.send(piece);
    run_for(500ms);
  }

  std::shared_ptr<store::MemoryDisk> disk_{std::make_shared<store::MemoryDisk>()};
  FakeRobot& robot_;
  std::uint32_t pieces_{};
};

TEST_F(MarksTest, AreFindingsOfTheStationAndSurviveARestart) {
  const Outcome added = execute("finding add person 12 -4.5 calls for help");
  ASSERT_EQ(added.exit_code, 0) << added.error;
  EXPECT_EQ(added.text, "finding 1, person at 12.00 -4.50 0.00, is marked\n");
  EXPECT_EQ(execute("finding add sinkhole 1 2 3.5").exit_code, 0);
  run_for(2s);
  for (std::uint64_t start = 2; start <= 3; ++start) {
    const auto rows = listed();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0]["kind"], "person");
    EXPECT_EQ(rows[0]["robot"], "op1");
    EXPECT_EQ(rows[0]["mark"], true);
    EXPECT_EQ(rows[0]["importance"], 9);
    EXPECT_EQ(rows[0]["text"], "calls for help");
    EXPECT_EQ(rows[0]["position"], (nlohmann::json{12.0, -4.5, 0.0}));
    EXPECT_EQ(rows[0]["number"], 1);
    EXPECT_EQ(rows[0].contains("age"), start == 2) << "the clock of an earlier run is not known";
    EXPECT_EQ(rows[1]["importance"], 5);
    EXPECT_EQ(rows[1]["position"][2], 3.5);
    EXPECT_THAT(execute("findings op1").text, HasSubstr("op1 (mark)"));
    begin_station(start);
  }
  EXPECT_EQ(execute("finding 1 confirm").exit_code, 0) << "judged as any finding";
}

TEST_F(MarksTest, AreWithdrawnByTheirStationAlone) {
  EXPECT_EQ(execute("finding add person 1 2").exit_code, 0);
  findings::Finding other{.key = {"r1", 7}, .kind = "artifact"};
  send({"r1", 1, 0, {other}});
  EXPECT_EQ(execute("finding remove 2").json["reason"], "bad_argument") << "a robot found it";
  EXPECT_EQ(execute("finding remove 9").json["reason"], "out_of_range");
  EXPECT_EQ(execute("finding remove 1").text, "finding 1, person, is withdrawn\n");
  EXPECT_EQ(op_->fleet().notices().back().code, "finding_withdrawn");
  EXPECT_EQ(execute("finding remove 1").json["reason"], "bad_argument") << "it is withdrawn already";
  begin_station(2);
  EXPECT_EQ(listed()[0]["withdrawn"], true);
  EXPECT_EQ(op_->world().findings.open, 1U);
}

TEST_F(MarksTest, HaveBounds) {
  EXPECT_EQ(execute("finding add person 1 2 " + std::string(128, 'x')).exit_code, 0);
  EXPECT_EQ(execute("finding add person 1 2 " + std::string(129, 'x')).json["reason"], "bad_argument");
  EXPECT_EQ(execute("finding add stairs 1 2").json["reason"], "bad_argument") << "robots measure them";
  FindingDesk desk(
      {}, nullptr, *strand_,
      FindingDesk::Outputs{[](const findings::Finding&) {}, [](const std::string&, const std::string&) {}});
  Marks marks("op1", kId, 5, desk, *strand_);
  std::size_t on_disk = 0;
  const auto add_one = [&] {
    return marks.add({.kind = "gas"}, [&](const findings::Finding&, bool stored) { on_disk += stored; })
        .reason();
  };
  for (std::size_t i = 0; i < Marks::kMaxMarks; ++i) EXPECT_EQ(add_one(), Reason::none);
  EXPECT_EQ(add_one(), Reason::queue_full);
  EXPECT_EQ(on_disk, Marks::kMaxMarks);
  EXPECT_EQ(desk.all().size(), Marks::kMaxMarks) << "each has an id of its own";
}

TEST_F(MarksTest, AreAnsweredWhileTheDiskFailsAndStoredLater) {
  disk_->set_full(true);
  const Outcome added = execute("finding add person 1 2");
  EXPECT_EQ(added.exit_code, 0);
  EXPECT_EQ(added.json["on_disk"], false);
  EXPECT_THAT(added.text, HasSubstr("not on the disk yet"));
  EXPECT_EQ(listed().size(), 1U);
  disk_->set_full(false);
  run_for(3s);
  begin_station(2);
  EXPECT_EQ(listed().size(), 1U);
}

TEST_F(MarksTest, OfAStationComeFromNoRobot) {
  EXPECT_EQ(execute("finding add person 1 2").exit_code, 0);
  const findings::Finding forged{.key = {"r1", 7, kId}, .kind = "person", .data = findings::encode_mark()};
  send({"r1", 1, 0, {forged}, kId});
  EXPECT_EQ(listed().size(), 1U);
  EXPECT_EQ(execute("findings").json["refused_pieces"], 1);
}

TEST_F(MarksTest, OfAStationAreNotReplacedByARobotOfItsName) {
  FindingDesk desk(
      {}, nullptr, *strand_,
      FindingDesk::Outputs{[](const findings::Finding&) {}, [](const std::string&, const std::string&) {}});
  Marks marks("op1", kId, 5, desk, *strand_);
  ASSERT_TRUE(marks.add({.kind = "person"}, [](const findings::Finding&, bool) {}).ok());
  findings::Finding robots = desk.all().begin()->second;
  robots.revision = 9;
  robots.data.clear();
  EXPECT_EQ(desk.hear("op1", findings::encode({"op1", 1, 0, {robots}, kId}), [] {}).reason(),
            Reason::malformed);
  EXPECT_TRUE(marks.is_own(desk.all().begin()->second));
}

TEST_F(MarksTest, AreWrittenAsCsvAndGeoJson) {
  EXPECT_EQ(execute("finding add person 12 -4.5 1 'calls, \"help\"'").exit_code, 0);
  const std::filesystem::path folder = scratch_folder();
  const auto text_of = [](const std::filesystem::path& file) {
    std::ostringstream out;
    out << std::ifstream(file).rdbuf();
    return out.str();
  };
  const std::string csv = (folder / "f.csv").string(), geo = (folder / "f.geojson").string();
  const Outcome written = execute("findings --export " + csv);
  EXPECT_EQ(written.exit_code, 0) << written.error;
  EXPECT_EQ(written.json["count"], 1);
  EXPECT_THAT(text_of(csv), HasSubstr("\"person\",9,12.000,-4.500,1.000,"));
  EXPECT_THAT(text_of(csv), HasSubstr("\"calls, \"\"help\"\"\",\"\",no,yes\r\n"));
  EXPECT_EQ(execute("findings --export " + geo).exit_code, 0);
  const auto object = nlohmann::json::parse(text_of(geo));
  EXPECT_EQ(object["type"], "FeatureCollection");
  EXPECT_EQ(object["features"][0]["geometry"]["coordinates"], (nlohmann::json{12.0, -4.5, 1.0}));
  EXPECT_EQ(object["features"][0]["properties"]["mark"], true);
  EXPECT_EQ(execute("findings --export " + (folder / "f.txt").string()).json["reason"], "bad_argument");
  EXPECT_EQ(execute("findings --export /nowhere/f.csv").exit_code, 1);
}

}  // namespace
}  // namespace adit::station
