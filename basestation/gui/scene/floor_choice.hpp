// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "basestation/gui/scene/floors.hpp"

namespace adit::gui {

/// Which floor the map from above shows: that of the selected robot (automatic), one that the operator chose,
/// or all at once.
class FloorChoice {
 public:
  enum class Kind : std::uint8_t { automatic, chosen, all };

  explicit FloorChoice(Kind kind = Kind::automatic) : kind_(kind) {}

  /// Takes the floors and what is selected; without floors everything is shown.
  void update(const Floors& floors, const station::World& world, const std::vector<std::string>& selection);
  /// From automatic to all floors, and from anything else to automatic.
  void toggle() { kind_ = kind_ == Kind::automatic ? Kind::all : Kind::automatic; }
  /// Chooses the floor so many above the one that is shown; does nothing at the last one.
  void move(int steps, const Floors& floors);
  /// Chooses the floor of something at that height, m, unless it is shown.
  void show_height(double z, const Floors& floors);

  Kind kind() const { return kind_; }
  /// Index of the floor that is shown; nothing: all of them.
  std::optional<std::size_t> shown() const { return kind_ == Kind::all ? std::nullopt : shown_; }
  /// "floor -1, auto"; empty: there are not two floors.
  const std::string& label() const { return label_; }

 private:
  Kind kind_;
  std::optional<double> height_{};  ///< Of the floor that is shown: its index changes when others are found.
  std::optional<std::size_t> shown_{};
  std::string label_{};
};

}  // namespace adit::gui
