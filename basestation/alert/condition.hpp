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
  std::string code{};  ///< The notification's for the same, or else the name of the reason.
  std::string text{};
  Reason reason{Reason::none};
  bool certain{true};  ///< False while a message may be missing that says otherwise.
  bool operator==(const Condition&) const = default;
};

/// Returns the conditions of a robot that the operator of `station` or no station holds, the most dangerous
/// first. A robot that is lost has that condition only, because the rest of its state is old. The operator's
/// own stop and a component that starts are no conditions.
std::vector<Condition> conditions_of(const Robot& robot, const std::string& station);

}  // namespace adit::station
