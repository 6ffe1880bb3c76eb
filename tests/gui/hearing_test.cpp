// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/hearing.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace adit::gui {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

const HearingCell& cell(const HearingTable& table, const std::string& hearer, const std::string& speaker) {
  static const HearingCell none{.text = "no such cell"};
  for (const HearingCell& next : table.cells)
    if (next.hearer == hearer && next.speaker == speaker) return next;
  return none;
}

station::NetworkReport two_robots() {
  station::NetworkReport report;
  report.links = {{.agent = "r1", .age = 0.3, .lost_from = 0.03, .lost_to = 0.5},
                  {.agent = "r2", .age = 40.0, .lost_from = 0.0, .lost_to = 1.0}};
  report.agents = {{.agent = "r1", .hears = {{"op1", 0.5}, {"op2", 0.0}}},
                   {.agent = "r2", .age = 40.0, .hears = {{"op2", 0.0}}}};
  return report;
}

TEST(Hearing, HasWhatTheStationMeasuredAndWhatRobotsReport) {
  const HearingTable table = hearing_table(two_robots(), "op1");
  EXPECT_EQ(table.speakers, (std::vector<std::string>{"op1", "r1", "r2", "op2"}));
  EXPECT_EQ(table.cells.size(), 3U * 5U);
  EXPECT_EQ(table.cells[0].text, "op1");
  EXPECT_EQ(cell(table, "op1", "r1").text, "3 % lost");
  EXPECT_EQ(cell(table, "op1", "r1").shape, "disc");
  EXPECT_EQ(cell(table, "r1", "op1").shape, "triangle");
  EXPECT_EQ(cell(table, "r1", "op2").text, "0 % lost");
  EXPECT_EQ(cell(table, "op1", "r2").text, "nothing") << "it is silent";
  EXPECT_EQ(cell(table, "r2", "op1").token, Token::bad);
}

TEST(Hearing, LeavesBlankWhatNoneReports) {
  const HearingTable table = hearing_table(two_robots(), "op1");
  EXPECT_EQ(cell(table, "r1", "r2").text, "");
  EXPECT_EQ(cell(table, "r1", "r1").shape, "");
  EXPECT_EQ(cell(table, "r2", "op2").text, "") << "its report is old";
  EXPECT_TRUE(hearing_table({}, "op1").cells.empty());
}

TEST(Hearing, NumbersThatAreNoneAndManyNamesDoNoHarm) {
  station::NetworkReport report = two_robots();
  report.links[0].lost_from = kNotANumber;
  report.links[0].lost_to = 7.0;
  for (int i = 0; i < 500; ++i) report.agents[0].hears["s" + std::to_string(i)] = 0.1;
  const HearingTable table = hearing_table(report, "op1");
  EXPECT_EQ(table.speakers.size(), kMaxHearing);
  EXPECT_EQ(table.cells.size(), 3 * (kMaxHearing + 1));
  EXPECT_EQ(cell(table, "r1", "op1").text, "");
}

TEST(Budget, PartsFollowEachOtherByPriority) {
  const station::AgentTraffic traffic{
      .agent = "r1",
      .total_out = 1000,
      .classes_out = {{"bulk", 400.0}, {"discovery", 100.0}, {"state", 300.0}}};
  const auto parts = budget_parts(traffic, 16000.0);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0], (BudgetPart{"discovery", 0.0, 0.05}));
  EXPECT_EQ(parts[1].name, "state");
  EXPECT_NEAR(parts[1].from, 0.05, 1e-9);
  EXPECT_EQ(parts[2].name, "bulk");
  EXPECT_EQ(parts[3].name, "other") << "what no topic names";
  EXPECT_NEAR(parts[3].from + parts[3].share, 0.5, 1e-9);
}

TEST(Budget, NeverFillsMoreThanTheBar) {
  const station::AgentTraffic traffic{
      .total_out = 1e30F,
      .classes_out = {{"bulk", 1e9}, {"state", -5.0}, {"status", kNotANumber}, {"video", 1e9}}};
  for (const double bandwidth : {8000.0, 1e-9}) {
    double end = 0.0;
    for (const BudgetPart& part : budget_parts(traffic, bandwidth)) {
      EXPECT_NEAR(part.from, end, 1e-9);
      end = part.from + part.share;
    }
    EXPECT_NEAR(end, 1.0, 1e-9);
  }
  for (const double none : {0.0, -1.0, kNotANumber, std::numeric_limits<double>::infinity()})
    EXPECT_TRUE(budget_parts(traffic, none).empty());
}

}  // namespace
}  // namespace adit::gui
