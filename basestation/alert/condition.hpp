// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/alert/table.hpp"
#include "basestation/model/robot.hpp"

namespace adit::station {

/// Something that the state of a robot shows and that needs its operator.
struct Condition {
  Ends ends{};         ///< What ends it: a value up to Ends::understood.
  std::string code{};  ///< As of a notification, or the name of the reason.
  std::string text{};
  Reason reason{Reason::none};
  bool operator==(const Condition&) const = default;
};

/// Returns the conditions of a robot of the operator of `station`, the most dangerous first. A robot that is
/// lost has that condition only: the rest of its state is old. What that operator did himself (his own stop)
/// is none, and neither is a component that starts.
std::vector<Condition> conditions_of(const Robot& robot, const std::string& station);

}  // namespace adit::station
