// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// The mode of a tick, and whether its source may pass.
struct Decision {
  const ModeRow* mode{};        ///< Never null.
  bool runs{};                  ///< Its source may pass; false: the mode stays, paused.
  Reason reason{Reason::none};  ///< The first condition of the requested mode that failed.
};

}  // namespace adit::agent
