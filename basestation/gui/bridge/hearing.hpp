// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/gui/scene/colours.hpp"
#include "basestation/model/network.hpp"

namespace adit::gui {

inline constexpr double kSilent = 10.0;  ///< Age of a silent link, s; on a full one reports come every 8 s.
inline constexpr double kLossy = 0.2;    ///< Share of lost heartbeats from which a link counts as bad.

/// A cell of the matrix of hearers and speakers: the loss of one link.
struct HearingCell {
  std::string hearer{};
  std::string speaker{};  ///< Empty: the hearer's name, at the begin of its row.
  std::string text{};     ///< Lost heartbeats, "3 %"; empty: the station does not know.
  std::string shape{};    ///< Of the mark: disc, triangle or square.
  Token token{Token::none};
  bool operator==(const HearingCell&) const = default;
};

/// The matrix of hearers and speakers, as far as the station knows: itself from heartbeats, others from their
/// reports.
struct HearingTable {
  std::vector<std::string> speakers{};  ///< Columns.
  std::vector<HearingCell> cells{};     ///< Row by row, each one with a cell for the hearer's name before it.
};

/// The most rows and columns, so that names that are made up cannot make the table endless.
inline constexpr std::size_t kMaxHearing = 24;

/// `own`: name of this station, which is first.
HearingTable hearing_table(const station::NetworkReport& report, const std::string& own);

/// A part of the bar of what an agent sends of its budget.
struct BudgetPart {
  std::string name{};  ///< Of the traffic class, or "other".
  double from{};       ///< Where it begins, share of the budget, [0, 1].
  double share{};      ///< Its length, share of the budget.
  bool operator==(const BudgetPart&) const = default;
};
/// The parts in the order of their priority on a full link. Empty: no budget is known.
/// `bandwidth`: of the link, bit/s.
std::vector<BudgetPart> budget_parts(const station::AgentTraffic& traffic, double bandwidth);

}  // namespace adit::gui
