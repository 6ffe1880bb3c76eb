// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/gui/bridge/hearing.hpp"
#include "basestation/gui/scene/colours.hpp"
#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/stairs.hpp"
#include "basestation/model/world.hpp"

/// What the tabs of the window show, as texts.
namespace adit::gui {

/// A cell of the matrix of robots and components.
struct HealthCell {
  std::string robot{};
  std::string component{};  ///< Empty: the robot's name, at the begin of its row.
  std::string text{};       ///< "up", "FAILED", ...; empty: the robot has no such component.
  std::string hint{};       ///< "3 restarts".
  std::string shape{};      ///< Of the mark: disc, triangle, square or ring.
  Token token{Token::none};
  bool old{};  ///< The robot is lost.
  bool operator==(const HealthCell&) const = default;
};

struct HealthTable {
  std::vector<std::string> columns{};  ///< Names of components.
  std::vector<HealthCell> cells{};     ///< Row by row, each one with a cell for the robot's name before it.
};

/// The most columns: a robot that lies about its components cannot make the table endless.
inline constexpr std::size_t kMaxColumns = 24;

HealthTable health_table(const station::HealthReport& report, const station::World& world);

/// One component in sentences, and what may be done; all empty for a component that is not known.
struct HealthDetail {
  std::string title{};  ///< "r3 planner: FAILED".
  std::string text{};   ///< Why it failed, restarts, threads that it left behind.
  bool mine{};          ///< The operator holds the robot, and a command restarts the component.
  bool automatic{};
};
HealthDetail health_detail(const station::HealthReport& report, const station::World& world,
                           const std::string& robot, const std::string& component);

/// The link to an agent, or what this station sends itself.
struct NetworkRow {
  std::string agent{};
  std::string loss{};               ///< "lost 3 % from it, 1 % to it".
  std::string trip{};               ///< Round trip.
  std::string rates{};              ///< Bytes/s in the link's two directions.
  std::string queue{};              ///< Queued airtime and the rate of states.
  std::string budget{};             ///< "1.2 of 62.5 kB/s (mesh_500k)", or "unlimited".
  double share{-1.0};               ///< Of the budget that is used, [0, 1]; negative: no budget is known.
  std::vector<BudgetPart> parts{};  ///< Of that share, by traffic class.
  std::string dropped{};
  std::string shape{};  ///< Mark of its state.
  Token token{Token::none};
  bool operator==(const NetworkRow&) const = default;
};
std::vector<NetworkRow> network_rows(const station::NetworkReport& report, const std::string& own);

struct FoundRow {
  int number{};
  std::string importance{}, kind{}, robot{}, place{}, age{}, text{}, note{};
  std::string verdict{};  ///< "new", "confirmed", "rejected".
  std::string shape{};
  Token token{Token::none};
  bool withdrawn{};
  bool removable{};           ///< A mark of this station.
  std::string photo_state{};  ///< How much of its photo is here, in words; empty: it has none.
  bool operator==(const FoundRow&) const = default;
};
/// `own`: the name of this station.
std::vector<FoundRow> found_rows(const station::FoundReport& report, const std::string& own);
/// A finding below its photo, which is open over the window.
struct PhotoCaption {
  std::string title{};  ///< "2  person".
  std::string text{};   ///< Of the finding.
  std::string line{};   ///< Robot, place, age and id.
  std::string state{};  ///< Which part of the photo it is.
};
/// `item` has a photo.
PhotoCaption photo_caption(const station::FoundItem& item);
/// What robots still store: "r4 still stores 3 that are not here".
std::string found_missing(const station::FoundReport& report);
/// A staircase as a row of its tab.
struct StairsRow {
  int number{};
  std::string direction{};        ///< "90°".
  double turn{};                  ///< Of an arrow that points up, to point uphill, degrees clockwise.
  std::string steps{}, floors{};  ///< "6 steps", "0.0 to 1.2 m".
  std::string step{}, breadth{};  ///< "rise 0.20 m, run 0.30 m", "width 1.20 ± 0.05 m".
  std::string robots{};           ///< That have seen it.
  std::string verdict{};          ///< As in FoundRow.
  std::string climbers{};         ///< "r1, r3", "no robot".
  std::string others{};           ///< "r2 climbs no stairs".
  Token token{Token::none};
  bool operator==(const StairsRow&) const = default;
};
std::vector<StairsRow> stairs_rows(const station::StairsReport& report);

}  // namespace adit::gui
