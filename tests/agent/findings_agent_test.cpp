// SPDX-License-Identifier: Apache-2.0
// What an agent found reaches every station (rule 9), as pieces of content.
#include <gmock/gmock.h>

#include "adit/bulk.h"
#include "core/contract/bulk.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/store/memory_disk.hpp"
#include "core/transfer/receiver.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::IsEmpty;

/// The stations op1 and op2 read pieces, and acknowledge them when they should.
class Found : public testing::Test {
 protected:
  struct Desk {
    AgentBench::Operator* op{};
    transfer::Receiver receiver{};
    wire::Writer<radio::BulkAck> acks{};
    std::unique_ptr<wire::RawReader> reader{};
    bool stores{false};
    std::vector<findings::FindingPiece> heard{};
    Timer timer{};
  };
  Found() {
    AgentParams params;
    params.disk = disk;
    bench = std::make_unique<AgentBench>(params);
    op1 = &bench->join("op1");
    op2 = &bench->join("op2");
    bench->run(1500ms);
    for (auto* op : {op1, op2}) {
      Desk& desk = desks[op == op2];
      desk.op = op;
      desk.acks = wire::Writer<radio::BulkAck>::make(*op->wire, wire::topics::kBulkAck).value();
      desk.reader = wire::make_reader(*op->wire, wire::topics::kBulk, bench->strand(),
                                      [this, &desk](const radio::BulkPiece& piece, const wire::SampleInfo&) {
                                        hear(desk, piece);
                                      })
                        .value();
      desk.timer = bench->strand().every(250ms, [this, &desk] { acknowledge(desk); });
    }
    bench->run(1s);
  }
  void hear(Desk& desk, const radio::BulkPiece& piece) {
    EXPECT_EQ(piece.robot(), "r1");
    EXPECT_EQ(piece.kind(), static_cast<std::uint8_t>(transfer::Kind::findings));
    const auto decoded = findings::decode_piece(piece.data());
    ASSERT_TRUE(decoded.ok());
    desk.heard.push_back(*decoded);
    session = piece.session();
    if (desk.stores) desk.receiver.take("r1", piece.session(), piece.id(), bench->strand().now());
  }
  void acknowledge(Desk& desk) {
    const auto due = desk.receiver.due(bench->strand().now(), 0.0);
    if (!due) return;
    (void)desk.acks.write(encode(contract::BulkAck{
        .station = desk.op->name, .station_id = desk.op->id, .start = 7, .receipts = *due}));
  }
  static findings::Finding finding(std::uint64_t id, const std::string& text = "") {
    findings::Finding f;
    f.key.id = id;
    f.kind = "artifact";
    f.position = {1, 2, 3};
    f.text = text;
    return f;
  }
  void report(std::uint64_t id) { bench->agent().report(finding(id)); }
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator *op1{}, *op2{};
  std::array<Desk, 2> desks{};
  std::uint32_t session{};  ///< Of the robot's pieces.
};

TEST_F(Found, IsSentUntilEveryStationHasIt) {
  report(7);
  bench->run(12s);
  const auto& heard = desks[0].heard;
  ASSERT_GE(heard.size(), 2u);
  EXPECT_EQ(heard[0].robot, "r1");
  ASSERT_EQ(heard[0].findings.size(), 1u);
  EXPECT_EQ(heard[0].findings[0].key.id, 7u);
  EXPECT_EQ(heard[0].stored, 1u);
  EXPECT_GT(heard[0].findings[0].stamp, 0u);
  desks[0].stores = true;
  bench->run(20s);
  desks[0].heard.clear();
  bench->run(20s);
  EXPECT_GE(heard.size(), 1u) << "op2 does not have it";
  desks[1].stores = true;
  bench->run(20s);
  desks[0].heard.clear();
  bench->run(60s);
  EXPECT_THAT(heard, IsEmpty());
}

TEST_F(Found, SurvivesADeathOfTheAgent) {
  report(7);
  bench->run(100ms);
  bench->stop_agent();
  bench->start_agent();
  desks[0].heard.clear();
  bench->run(10s);
  ASSERT_GE(desks[0].heard.size(), 1u);
  EXPECT_EQ(desks[0].heard[0].findings[0].key.id, 7u);
}

TEST_F(Found, IsChangedAndWithdrawn) {
  desks[0].stores = desks[1].stores = true;
  bench->agent().update(finding(7));  // It is reported, as there is none.
  bench->run(5s);
  bench->agent().update(finding(7, "nearer"));
  bench->run(5s);
  bench->agent().withdraw(7);
  bench->run(5s);
  std::vector<findings::Finding> revisions(3);
  for (const findings::FindingPiece& piece : desks[0].heard)
    for (const findings::Finding& f : piece.findings) revisions.at(f.revision) = f;
  EXPECT_EQ(revisions[0].text, "");
  EXPECT_EQ(revisions[1].text, "nearer");
  EXPECT_GT(revisions[1].stamp, revisions[0].stamp);
  EXPECT_TRUE(revisions[2].withdrawn);
  EXPECT_EQ(revisions[2].text, "nearer");
  bench->agent().withdraw(8);
  bench->run(1s);
  EXPECT_THAT(op1->notice_codes(), Contains("finding_refused"));
}

TEST_F(Found, AnotherParticipantCannotSayWhatAStationHas) {
  report(7);
  bench->run(3s);
  const auto foreign = bench->network().join(77, "stranger");
  auto writer = wire::Writer<radio::BulkAck>::make(*foreign, wire::topics::kBulkAck).value();
  bench->run(1s);
  ASSERT_FALSE(desks[0].heard.empty());
  for (int i = 0; i < 20; ++i) {
    const auto newest = static_cast<std::uint32_t>(desks[0].heard.size());
    const transfer::Receipt all{session, newest, {~std::uint64_t{0}, ~std::uint64_t{0}}};
    (void)writer.write(encode(contract::BulkAck{
        .station = op1->name, .station_id = op1->id, .start = 7, .receipts = {{"r1", all}}}));
    bench->run(100ms);
  }
  desks[0].heard.clear();
  bench->run(30s);
  EXPECT_GE(desks[0].heard.size(), 1u);
}

TEST_F(Found, AnInvalidFindingIsReported) {
  findings::Finding f;
  bench->agent().report(f);
  bench->run(1s);
  EXPECT_THAT(op1->notice_codes(), Contains("finding_refused"));
}

}  // namespace
}  // namespace adit::agent
