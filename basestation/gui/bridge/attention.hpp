// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/alert/queue.hpp"

namespace adit::gui {

/// Something that needs the operator, as the window shows it.
struct Need {
  std::string id{};  ///< Stays the same while it is shown.
  std::vector<std::string> robots{};
  std::string who{};                        ///< The robots, or "station".
  std::string short_who{};                  ///< The same without names: "robot 7", "4 robots".
  std::string text{};                       ///< What happened, with the count if it happened more than once.
  std::string short_text{};                 ///< The same in a few words.
  std::string since{};                      ///< Time since it began; empty: not known.
  std::string grant_label{}, grant_line{};  ///< Hands the robot to the operator who asked; empty: none did.
  bool urgent{};          ///< Motion or control is at stake, and the operator has not seen it yet.
  bool can_see{};         ///< It waits until the operator has seen it.
  bool can_wait{};        ///< The operator may put it off.
  std::uint64_t alert{};  ///< Of the queue.
  bool operator==(const Need&) const = default;
};

/// The alerts of the queue in the words of the window, in its order.
std::vector<Need> needs_of(const station::AlertQueue& queue, const station::World& world, double now);

}  // namespace adit::gui
