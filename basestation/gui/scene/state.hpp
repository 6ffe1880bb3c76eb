// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "basestation/gui/scene/colours.hpp"
#include "basestation/model/robot.hpp"

/// What cards and marks say of a robot alike.
namespace adit::gui {

enum class Contact : std::uint8_t { live, stale, lost };

/// @param silent time since the station's last snapshot, s: all values are as old, at least.
/// @param stale_after age at which the values count as stale, s.
inline Contact contact_of(const station::Robot& robot, double silent, double stale_after) {
  if (robot.lost) return Contact::lost;
  return robot.age + silent > stale_after || silent > 1.0 ? Contact::stale : Contact::live;
}

/// Whose it is.
inline Token owner_of(const station::Robot& robot) {
  if (robot.mine) return Token::mine;
  return robot.holder.empty() ? Token::none : Token::other;
}

}  // namespace adit::gui
