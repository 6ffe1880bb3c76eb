// SPDX-License-Identifier: Apache-2.0
// A robot's findings on links that are thin, lossy, or shared with a map, and disks that fail.
#include "tests/findings/source_bench.hpp"

namespace adit::agent {
namespace {

using findings::some;
using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(FindingSourceTest, AStationThatCannotStoreDelaysNoOther) {
  run(1s);
  ops[0].disk->set_full(true);
  for (std::uint64_t id = 1; id <= 4; ++id) report(id);
  run(30s);
  EXPECT_EQ(ops[1].desk->all().size(), 4u);
  report(5);
  run(2s);
  EXPECT_EQ(ops[1].desk->all().size(), 5u);
}

TEST_F(FindingSourceTest, NothingIsLostOnALinkThatLosesEveryThirdPieceAndReceipt) {
  loss = 0.33;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id);
  run(60s);
  for (const Operator& op : ops) EXPECT_EQ(op.desk->all().size(), 8u);
  sent.clear();
  run(60s);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(FindingSourceTest, APieceIsAcknowledgedOnceAllOfItIsOnTheDisk) {
  ops[1].heard = false;
  run(1s);
  ops[0].disk->set_refused(findings::file_name({"r1", 2}), true);
  report(1);
  report(2);
  run(1s);
  EXPECT_EQ(source->missing(ops[0].id) + sender->in_flight(), 1u) << "both are on their way in one piece";
  run(20s);
  EXPECT_EQ(source->missing(ops[0].id), 1u) << "the first one was stored, and came alone";
  ops[0].disk->set_refused(findings::file_name({"r1", 2}), false);
  run(20s);
  EXPECT_EQ(source->missing(ops[0].id), 0u);
}

TEST_F(FindingSourceTest, TheLargestFindingPassesAThinLink) {
  const wire::LinkProfile thin{.name = "thin", .bandwidth = 100e3};
  link.link = &thin;
  findings::Finding f = some(1);
  f.kind = std::string(findings::Finding::kKind, 'k');
  f.text = std::string(findings::Finding::kText, 't');
  f.data.assign(findings::Finding::kData, 9);
  ASSERT_TRUE(source->report(f).ok());
  for (std::uint64_t id = 2; id <= 8; ++id) report(id);
  run(10s);
  for (const Operator& op : ops) {
    EXPECT_EQ(op.desk->all().size(), 8u);
    EXPECT_EQ(op.desk->all().at({"r1", 1}), f);
  }
  EXPECT_LE(largest, transfer::kMaxPieceBytes);
  EXPECT_GT(largest, 600u);
}

TEST_F(FindingSourceTest, AFindingPassesTheMapAndAFullSetLeavesTheMapEveryFourthPiece) {
  const wire::LinkProfile thin{.name = "thin", .bandwidth = 100e3};
  link.link = &thin;
  params.max_findings = 512;
  map = std::make_unique<EndlessMap>();
  start_robot();
  run(20s);
  EXPECT_GT(map->token, 80u);
  kinds.clear();
  report(1000, 9);
  run(1s);
  ASSERT_GE(kinds.size(), 2u);
  EXPECT_TRUE(kinds[0] == transfer::Kind::findings || kinds[1] == transfer::Kind::findings);
  kinds.clear();
  for (std::uint64_t id = 1; id <= 511; ++id) {
    findings::Finding f = some(id);
    f.data.assign(findings::Finding::kData, 9);
    ASSERT_TRUE(source->report(f).ok());
  }
  run(30s);
  const auto blocks = std::count(kinds.begin(), kinds.end(), transfer::Kind::map_blocks);
  EXPECT_LT(source->missing(ops[0].id), 511u);
  EXPECT_GT(source->missing(ops[0].id), 0u) << "it lasts longer than this test looks at it";
  EXPECT_GE(4 * blocks + 4, static_cast<long>(kinds.size()));
  EXPECT_LE(3 * blocks, static_cast<long>(kinds.size())) << "findings go first";
}

}  // namespace
}  // namespace adit::agent
