// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/stairs.hpp"

namespace adit::gui {

/// Which robot would take a staircase now.
struct StairsOffer {
  std::string robot{};  ///< Empty: none.
  std::string text{};   ///< That robot and the staircase, or why there is none.
  bool operator==(const StairsOffer&) const = default;
};

/// `picked`: the marked staircase; null: none. `selected`: the selection. `ready`: those of it that would
/// accept a goal now. `refusal`: why none of it would.
StairsOffer stairs_offer(const station::StairsItem* picked, const std::vector<std::string>& selected,
                         const std::vector<std::string>& ready, const std::string& refusal);

}  // namespace adit::gui
