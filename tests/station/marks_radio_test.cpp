// SPDX-License-Identifier: Apache-2.0
// Marks of two operators on their way to each other over a thin link that loses.
#include <algorithm>
#include <array>

#include "core/contract/bulk.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/findings/mark_data.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;

class MarksRadioTest : public testing::TestWithParam<std::uint64_t> {
 protected:
  struct Operator {
    std::string name{};
    Id id{};
    std::unique_ptr<Runtime> machine{};
    std::shared_ptr<Executor> strand{};
    std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
    std::unique_ptr<wire::Participant> wire{};
    std::unique_ptr<Station> station{};
    std::uint64_t starts{};
  };
  MarksRadioTest()
      : network_(scheduler_,
                 {.seed = GetParam(),
                  .link = {.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1}}) {
    for (std::size_t i = 0; i < ops_.size(); ++i) {
      Operator& op = ops_[i];
      op.name = "op" + std::to_string(i + 1);
      op.id[0] = static_cast<std::uint8_t>(i + 1);
      op.machine = scheduler_.machine(op.name, (3 + 2 * static_cast<int>(i)) * 1s);
      op.strand = op.machine->strand("station");
      start(op);
    }
    run_for(10s);
  }
  void start(Operator& op) {
    op.wire = network_.join(77, op.name);
    StationParams params;
    params.name = op.name;
    params.id = op.id;
    params.seed = 10 * GetParam() + ++op.starts + 1000U * op.id[0];
    params.disk = op.disk;
    op.station = std::make_unique<Station>(params, *op.strand, *op.wire);
    ASSERT_TRUE(op.station->start().ok());
  }
  /// Ends a station without a goodbye, and starts it again.
  void restart(Operator& op, Duration pause) {
    network_.crash(op.name);
    op.station.reset();
    op.wire.reset();
    run_for(pause);
    start(op);
  }
  void run_for(Duration span) { scheduler_.run_until(scheduler_.elapsed() + span); }
  Outcome execute(Operator& op, const std::string& line) {
    auto ended = std::make_shared<std::optional<Outcome>>();
    op.strand->post([&op, line, ended] {
      op.station->execute(line, [ended](const Outcome& outcome) { *ended = outcome; });
    });
    for (int i = 0; i < 600 && !*ended; ++i) run_for(10ms);
    if (!*ended) ADD_FAILURE() << line << " did not end";
    return ended->value_or(Outcome{.exit_code = -1});
  }
  /// What a station has, without what is its own: numbers, ages.
  std::vector<std::string> marks(Operator& op) {
    std::vector<std::string> out;
    const auto rows = execute(op, "findings").json["findings"];
    for (const auto& row : rows)
      out.push_back(row["robot"].get<std::string>() + " " + row["id"].get<std::string>() + " " +
                    row["kind"].get<std::string>() + " " + row["text"].get<std::string>() +
                    (row.contains("withdrawn") ? " withdrawn" : "") + (row.contains("mark") ? " mark" : ""));
    std::ranges::sort(out);
    return out;
  }

  VirtualScheduler scheduler_{7};
  wire::SimulatedNetwork network_;
  std::array<Operator, 2> ops_{};
};

TEST_P(MarksRadioTest, BothStationsHaveTheSameAfterLossAndRestartsOfEither) {
  auto& [one, two] = ops_;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(execute(one, "finding add gas 1 2 0 number " + std::to_string(i)).exit_code, 0);
    EXPECT_EQ(execute(two, "finding add exit 1 2 0 number " + std::to_string(i)).exit_code, 0);
  }
  EXPECT_EQ(execute(one, "finding 1 confirm").exit_code, 0);
  network_.degrade("op1", "op2", 0.4);
  run_for(2s);
  restart(two, 5s);
  EXPECT_EQ(execute(one, "finding remove 1").exit_code, 0);
  EXPECT_EQ(execute(one, "finding add person 3 4 0 while the other is away").exit_code, 0);
  run_for(3s);
  restart(one, 3s);
  run_for(5s);
  network_.degrade("op1", "op2", std::nullopt);
  run_for(60s);
  const auto all = marks(one);
  EXPECT_EQ(all.size(), 13U);
  EXPECT_EQ(marks(two), all);
  EXPECT_EQ(std::ranges::count_if(all, [](const auto& row) { return row.ends_with(" withdrawn mark"); }), 1);
  restart(two, 1s);
  EXPECT_EQ(marks(two), all) << "they are on its disk";
}

TEST_P(MarksRadioTest, NothingIsSentOnceBothHaveThem) {
  auto& [one, two] = ops_;
  for (int i = 0; i < 6; ++i) EXPECT_EQ(execute(one, "finding add gas 1 2 0").exit_code, 0);
  run_for(60s);
  EXPECT_EQ(marks(two).size(), 6U);
  std::size_t pieces = 0, acks = 0;
  network_.set_tap([&](const wire::SampleEvent& event) {
    if (event.kind != wire::SampleEvent::Kind::sent) return;
    pieces += event.topic == wire::topics::kBulk.name ? 1 : 0;
    acks += event.topic == wire::topics::kBulkAck.name ? 1 : 0;
  });
  run_for(60s);
  network_.set_tap({});
  EXPECT_EQ(pieces, 0U);
  EXPECT_LE(acks, 2U * 31U) << "each station says every 2 s that it is there";
}

TEST_P(MarksRadioTest, OfOneStationComeFromNoOther) {
  auto& [one, two] = ops_;
  EXPECT_EQ(execute(one, "finding add gas 1 2 0 genuine").exit_code, 0);
  EXPECT_EQ(execute(two, "finding add gas 1 2 0 genuine").exit_code, 0);
  run_for(30s);
  ASSERT_EQ(marks(two).size(), 2U);
  const std::string mark_of_one = marks(one)[0];
  // A third participant says that it is op1, with a higher revision of its mark.
  const auto rows = execute(one, "findings op1").json["findings"];
  const std::uint64_t mark = std::stoull(rows[0]["id"].get<std::string>(), nullptr, 16);
  findings::Finding forged{.key = {"op1", mark, one.id}, .revision = 9, .withdrawn = true, .kind = "gas"};
  forged.data = findings::encode_mark();
  const auto machine = scheduler_.machine("thief", 1s);
  const auto wire = network_.join(77, "thief");
  auto writer = wire::Writer<radio::BulkPiece>::make(*wire, wire::topics::kBulk);
  ASSERT_TRUE(writer.ok());
  run_for(5s);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    (void)writer->write(contract::encode(
        contract::BulkPiece{"op1", 77, i, static_cast<std::uint8_t>(transfer::Kind::findings), 0,
                            findings::encode({"op1", 1, 0, {forged}, one.id})}));
    run_for(500ms);
  }
  EXPECT_EQ(marks(two)[0], mark_of_one);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MarksRadioTest, testing::Range<std::uint64_t>(1, 5));

/// The desk judges what a station sends: with its own mark, name and identity it passes, with others not.
TEST(MarksDesk, TakesOfAStationItsOwnMarksAlone) {
  VirtualScheduler scheduler{7};
  const auto machine = scheduler.machine("op1", 1s);
  const auto strand = machine->strand("station");
  FindingDesk desk(
      {}, nullptr, *strand,
      FindingDesk::Outputs{[](const findings::Finding&) {}, [](const std::string&, const std::string&) {}});
  const findings::Owner id{7};
  const auto mark = [](std::uint64_t number, const findings::Owner& by) {
    return findings::Finding{.key = {"op2", number, by}, .kind = "gas", .data = findings::encode_mark()};
  };
  std::size_t stored = 0;
  const auto hear = [&](const std::string& name, const findings::FindingPiece& piece) {
    const auto heard = desk.hear_station(name, id, findings::encode(piece), [&stored] { ++stored; });
    return heard ? Reason::none : heard.reason();
  };
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(1, id)}, id}), Reason::none);
  EXPECT_EQ(stored, 1U);
  EXPECT_EQ(hear("op3", {"op2", 1, 0, {mark(2, id)}, id}), Reason::malformed) << "another station's";
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(2, {8})}, {8}}), Reason::malformed) << "another one of that name";
  findings::Finding plain = mark(2, id);
  plain.data.clear();
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {plain}, id}), Reason::malformed) << "no mark";
  findings::Finding stairs = mark(2, id);
  stairs.kind = "stairs";
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(3, id), stairs}, id}), Reason::malformed);
  EXPECT_EQ(desk.all().size(), 1U) << "nothing of a refused piece is taken";
  findings::Finding robots{.key = {"op2", 9, id}, .kind = "gas"};
  EXPECT_TRUE(desk.hear("op2", findings::encode({"op2", 1, 0, {robots}, id}), [] {}).ok());
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(9, id)}, id}), Reason::malformed)
      << "a robot of that name found it";
  EXPECT_EQ(hear("op2", {}), Reason::malformed);
  for (std::uint64_t i = 100; i < 100 + FindingDesk::kMaxMarks - 1; ++i)
    EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(i, id)}, id}), Reason::none);
  EXPECT_EQ(hear("op2", {"op2", 1, 0, {mark(9999, id)}, id}), Reason::queue_full);
}

}  // namespace
}  // namespace adit::station
