// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "adit/command.h"

namespace adit::wire {

/// A command to r1, distinguished from others by its number.
inline radio::Command numbered_command(std::uint64_t seq) {
  radio::Command c;
  c.robot("r1");
  c.station("op1");
  c.seq(seq);
  return c;
}

}  // namespace adit::wire
