// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "basestation/gui/scene/colours.hpp"
#include "basestation/gui/scene/state.hpp"
#include "basestation/model/robot.hpp"

namespace adit::gui {

/// The texts of a robot's card.
struct Card {
  int number{};  ///< As station::numbers_of(); the keys 1 to 9 select by it.
  std::string name{};
  std::string glyph{};  ///< One of wheels, tracks, legs, rotor, unknown.
  std::string platform{};
  std::string holder{};  ///< "mine", "op2", "no holder"; with "locked".
  Token owner{Token::none};
  std::string headline{};        ///< The mode, or STOP, BLOCKED, LOST.
  std::string short_headline{};  ///< What of it matters most: "WAITS".
  Token headline_token{Token::none};
  std::string shape{};         ///< Of the headline's mark: disc, triangle, square or ring.
  std::string detail{};        ///< Why it does not move, or where it drives to.
  std::string short_detail{};  ///< The same in a few words without names.
  std::string battery{};
  std::string speed{};
  std::string goal{};  ///< Distance to the goal.
  std::string age{};
  Contact contact{Contact::live};
  bool operator==(const Card&) const = default;
};

/// @param silent time since the station's last snapshot, s: all values are as old, at least.
/// @param stale_after age at which the values count as stale, s.
Card card_of(const station::Robot& robot, int number, double silent, double stale_after);

/// "0.4 s", "47 s", "3 min".
std::string age_text(double seconds);

}  // namespace adit::gui
