// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/known_findings.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/store/pack.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

class KnownFindingsTest : public testing::Test {
 protected:
  std::unique_ptr<KnownFindings> make() {
    auto known = std::make_unique<KnownFindings>(disk, *strand, nullptr);
    known->load([](std::uint64_t id) { return id != 3; });
    return known;
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }
  static transfer::PeerId station(std::uint8_t number) { return {number}; }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
};

TEST_F(KnownFindingsTest, SurvivesARestartForFindingsThatStillExist) {
  auto known = make();
  for (const std::uint64_t id : {1, 2, 3}) known->add(id, 0, station(1));
  known->add(1, 0, station(2));
  known->tick(strand->now());
  run(1s);
  known = make();
  EXPECT_TRUE(known->revision(1, station(1)));
  EXPECT_TRUE(known->revision(1, station(2)));
  EXPECT_TRUE(known->revision(2, station(1)));
  EXPECT_FALSE(known->revision(2, station(2)));
  EXPECT_FALSE(known->has(3, 0));
}

TEST_F(KnownFindingsTest, HasTheNewestRevisionOfEachStation) {
  auto known = make();
  known->add(1, 4, station(1));
  known->add(1, 2, station(1));  // Its acknowledgement came late.
  known->add(1, 1, station(2));
  known->tick(strand->now());
  run(1s);
  for (int i = 0; i < 2; ++i, known = make()) {
    EXPECT_EQ(known->revision(1, station(1)), 4U);
    EXPECT_EQ(known->revision(1, station(2)), 1U);
    EXPECT_TRUE(known->has(1, 4));
    EXPECT_FALSE(known->has(1, 5));
  }
}

TEST_F(KnownFindingsTest, ItsFloorIsAboveWhatIsGone) {
  auto known = make();
  EXPECT_EQ(known->floor(), 0U);
  known->raise_above(6);
  known->raise_above(2);
  EXPECT_EQ(known->floor(), 7U);
  run(10ms);
  known = make();
  EXPECT_EQ(known->floor(), 7U) << "it is written at once";
  known->add(3, 8, station(1));  // It does not exist at the next start.
  known->tick(strand->now());
  run(1s);
  known = make();
  EXPECT_EQ(known->floor(), 9U);
  known->raise_above(UINT32_MAX);
  EXPECT_EQ(known->floor(), UINT32_MAX);
}

TEST_F(KnownFindingsTest, ReadsAFileOfVersion1) {
  store::Packer out;
  out.put(std::uint16_t{1}).put(std::uint64_t{5}).put(std::uint16_t{2}).put(station(1)).put(station(2));
  disk->plant("findings-known", store::encode_envelope({{'F', 'A', 'C', 'K'}, 1, 4096}, 1, out.bytes()));
  const auto known = make();
  EXPECT_EQ(known->revision(5, station(1)), 0U);
  EXPECT_EQ(known->revision(5, station(2)), 0U);
  EXPECT_FALSE(known->has(5, 1));
}

TEST_F(KnownFindingsTest, ForgetsTheOldestOfManyStations) {
  auto known = make();
  for (std::uint8_t i = 1; i <= KnownFindings::kStations + 1; ++i) known->add(1, 0, station(i));
  EXPECT_FALSE(known->revision(1, station(1)));
  EXPECT_TRUE(known->revision(1, station(2)));
  EXPECT_TRUE(known->revision(1, station(KnownFindings::kStations + 1)));
}

TEST_F(KnownFindingsTest, WritesEveryFiveSecondsAtMost) {
  auto known = make();
  run(10s);
  known->add(10, 0, station(1));
  known->tick(strand->now());
  run(1s);
  known->add(11, 0, station(1));
  known->tick(strand->now());
  run(1s);
  EXPECT_TRUE(make()->has(10, 0));
  EXPECT_FALSE(make()->has(11, 0)) << "it waits";
  run(4s);
  known->tick(strand->now());
  run(1s);
  EXPECT_TRUE(make()->has(11, 0));
}

TEST_F(KnownFindingsTest, ADamagedFileIsSetAsideAndNothingIsKnown) {
  disk->plant("findings-known", store::Bytes(30, 'x'));
  const auto known = make();
  EXPECT_FALSE(known->has(1, 0));
  EXPECT_FALSE(disk->read("findings-known").value());
  EXPECT_EQ(disk->list().value().size(), 1U) << "nothing is deleted";
}

}  // namespace
}  // namespace adit::agent
