// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::station::cli {

/// Makes SIGINT, SIGTERM and SIGHUP only set a flag and interrupt blocking system calls.
void catch_interrupts();
/// Returns true once after such a signal.
bool interrupted();
/// Whether the terminal window changed its size since the last call; needs catch_interrupts().
bool resized();

}  // namespace adit::station::cli
