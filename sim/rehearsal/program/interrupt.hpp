// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::sim {

/// From now on the first Ctrl-C (or SIGTERM) is only noted; a second one ends the program.
void note_interrupts();
/// Whether one came.
bool interrupted();

}  // namespace adit::sim
