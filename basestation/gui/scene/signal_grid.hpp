// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// The worst reception from robots in each square metre where they were.
class SignalGrid {
 public:
  static constexpr double kCell = 1.0;                  ///< Edge of a cell, m.
  static constexpr std::size_t kMaxCells = 20'000;      ///< Beyond it the oldest ones are dropped.
  static constexpr double kGood = -75.0, kBad = -85.0;  ///< dBm
  static constexpr double kGoodLoss = 0.05, kBadLoss = 0.2;
  static constexpr double kSilent = 10.0;  ///< Links that are older say nothing, s.

  enum class Step : std::uint8_t { good, weak, bad };

  /// The worst values of a cell.
  struct Cell {
    std::optional<double> signal{};  ///< dBm
    double lost{};                   ///< Fraction of heartbeats, [0, 1].
    /// By the signal, or by losses where none is known.
    Step step() const;
    bool operator==(const Cell&) const = default;
  };

  /// Takes what the links to robots give now, at the places where the robots are.
  void add(const station::World& world, const station::NetworkReport& report);
  void add(const Point& place, const Cell& measured);
  /// By the cell's lower corner, in cells from the map's origin.
  const std::map<std::pair<int, int>, Cell>& cells() const { return cells_; }
  bool knows_signal() const { return knows_signal_; }  ///< Otherwise all steps are by losses.

 private:
  std::map<std::pair<int, int>, Cell> cells_{};
  std::deque<std::pair<int, int>> order_{};  ///< The oldest cell first.
  bool knows_signal_{false};
};

}  // namespace adit::gui
