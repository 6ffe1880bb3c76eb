// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace adit::station {

/// The urgency of a notification for the operator.
enum class Priority : std::uint8_t {
  act,   ///< Motion or control is at stake: a banner that stays until it was seen.
  soon,  ///< A robot does nothing useful: a row of the attention queue.
  know,  ///< News: a line of the log, and a mark on the map.
  log,   ///< The rest.
};

/// The state of the robot with which an alert ends, beside a notification that closes it. The most dangerous
/// condition is first.
enum class Ends : std::uint8_t {
  heard,         ///< The robot is heard.
  stop_cleared,  ///< No software stop of another station is set.
  goes_on,       ///< The robot may move, has nothing to do, or does not move for another reason.
  healthy,       ///< No component of the robot is in trouble.
  understood,    ///< What its driver and its radio bring can be used.
  not_locked,    ///< The robot is not locked any more.
  seen,          ///< The state of the robot does not show it: when the operator has seen it.
};

/// The meaning of a notification code for an operator.
struct AlertRow {
  std::string_view code{};
  Priority priority{};
  Ends ends{Ends::seen};
  std::string_view closed_by{};  ///< Code of the notification that reports the end of the cause; empty: none.
  /// Only `act` while the robot is driven by hand; otherwise `soon`.
  bool by_hand{false};
  /// Code of the notification that says the same, and more urgently, when both come together; empty: none.
  std::string_view part_of{};
};

/// One row for each code of docs/operators.md. Within a priority, the rows are in the order of what the robot
/// risks: motion or control, then its place, then its task, then things that can wait.
std::span<const AlertRow> alert_table();
/// The row of that code; null for a code of another version.
const AlertRow* alert_row(std::string_view code);

}  // namespace adit::station
