// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/signal_grid.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

using Step = SignalGrid::Step;

TEST(SignalGrid, KeepsTheWorstOfEachSquareMetre) {
  SignalGrid grid;
  grid.add({2.1, -0.2}, {.signal = -60.0});
  grid.add({2.9, -0.9}, {.signal = -80.0});
  grid.add({2.5, -0.5}, {.signal = -70.0, .lost = 0.5});
  ASSERT_EQ(grid.cells().size(), 1U);
  const auto& [place, cell] = *grid.cells().begin();
  EXPECT_EQ(place, (std::pair{2, -1}));
  EXPECT_EQ(cell.signal, -80.0);
  EXPECT_EQ(cell.lost, 0.5);
  EXPECT_EQ(cell.step(), Step::weak) << "the signal counts where it is known";
}

TEST(SignalGrid, HasThreeStepsBySignalOrByLosses) {
  EXPECT_EQ((SignalGrid::Cell{.signal = -75.0}).step(), Step::good);
  EXPECT_EQ((SignalGrid::Cell{.signal = -85.0}).step(), Step::weak);
  EXPECT_EQ((SignalGrid::Cell{.signal = -85.1}).step(), Step::bad);
  EXPECT_EQ((SignalGrid::Cell{.lost = 0.04}).step(), Step::good);
  EXPECT_EQ((SignalGrid::Cell{.lost = 0.1}).step(), Step::weak);
  EXPECT_EQ((SignalGrid::Cell{.lost = 1.0}).step(), Step::bad);
}

TEST(SignalGrid, TakesRobotsWhereTheyAreAndNoOldLinks) {
  station::World world = ten_robots();
  station::NetworkReport report;
  report.links = {{.agent = "r1", .age = 0.2, .lost_from = 0.5},
                  {.agent = "r2", .age = 30.0, .lost_from = 0.5},
                  {.agent = "r5", .age = 0.1},
                  {.agent = "rx", .age = 0.1},
                  {.agent = "op2", .age = 0.1}};
  SignalGrid grid;
  grid.add(world, report);
  ASSERT_EQ(grid.cells().size(), 1U) << "r2's is old, r5 is lost, rx has no place, op2 is no robot";
  EXPECT_EQ(grid.cells().begin()->first, (std::pair{2, 0}));
  EXPECT_FALSE(grid.knows_signal());
}

TEST(SignalGrid, IsBoundedAndTakesNoNumberThatIsNone) {
  SignalGrid grid;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  grid.add({1e30, 0}, {.signal = -60.0});
  grid.add({kNan, 0}, {.signal = -60.0});
  grid.add({0, 0}, {.lost = kNan});
  grid.add({0, 0}, {.lost = 7.0});
  EXPECT_TRUE(grid.cells().empty());
  grid.add({0, 0}, {.signal = kNan, .lost = 0.1});
  EXPECT_FALSE(grid.knows_signal());
  for (int i = 0; i < 30'000; ++i) grid.add({i % 300 + 0.5, i / 300 + 0.5}, {.signal = -60.0});
  EXPECT_EQ(grid.cells().size(), SignalGrid::kMaxCells);
  EXPECT_FALSE(grid.cells().contains({0, 0})) << "the oldest ones are dropped";
  EXPECT_TRUE(grid.cells().contains({299, 99}));
}

}  // namespace
}  // namespace adit::gui
