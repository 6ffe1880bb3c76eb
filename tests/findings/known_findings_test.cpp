// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/known_findings.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"

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
  for (const std::uint64_t id : {1, 2, 3}) known->add(id, station(1));
  known->add(1, station(2));
  known->tick(strand->now());
  run(1s);
  known = make();
  EXPECT_TRUE(known->has(1, station(1)));
  EXPECT_TRUE(known->has(1, station(2)));
  EXPECT_TRUE(known->has(2, station(1)));
  EXPECT_FALSE(known->has(2, station(2)));
  EXPECT_FALSE(known->has(3));
}

TEST_F(KnownFindingsTest, ForgetsTheOldestOfManyStations) {
  auto known = make();
  for (std::uint8_t i = 1; i <= KnownFindings::kStations + 1; ++i) known->add(1, station(i));
  EXPECT_FALSE(known->has(1, station(1)));
  EXPECT_TRUE(known->has(1, station(2)));
  EXPECT_TRUE(known->has(1, station(KnownFindings::kStations + 1)));
}

TEST_F(KnownFindingsTest, WritesEveryFiveSecondsAtMost) {
  auto known = make();
  run(10s);
  known->add(10, station(1));
  known->tick(strand->now());
  run(1s);
  known->add(11, station(1));
  known->tick(strand->now());
  run(1s);
  EXPECT_TRUE(make()->has(10));
  EXPECT_FALSE(make()->has(11)) << "it waits";
  run(4s);
  known->tick(strand->now());
  run(1s);
  EXPECT_TRUE(make()->has(11));
}

TEST_F(KnownFindingsTest, ADamagedFileIsSetAsideAndNothingIsKnown) {
  disk->plant("findings-known", store::Bytes(30, 'x'));
  const auto known = make();
  EXPECT_FALSE(known->has(1));
  EXPECT_FALSE(disk->read("findings-known").value());
  EXPECT_EQ(disk->list().value().size(), 1U) << "nothing is deleted";
}

}  // namespace
}  // namespace adit::agent
